# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recording in a DataFrame of pandas is that of the CSV file with the same columns."""

import dataclasses

import numpy as np
import pytest

from pam_ros.errors import ParameterError, RecordingError
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.mapping import read_mapping
from pam_ros.recording.read import read_recording
from pam_ros.recording.recording import Recording
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint

pd = pytest.importorskip('pandas')
JOINT = single_muscle_joint(Muscle(), Mass(mass=20.0))
T = 0.01 * np.arange(1500)
COLUMNS = {
    't_s': T,
    'pressure_command_kPa': 300.0 + 100.0 * np.sin(T),
    'position_mm': 60.0 + 20.0 * np.sin(T) + 0.1 * np.sin(40.0 * T),
    'valve': np.arange(T.size) % 3,
}


def frame(**changes):
    return pd.DataFrame({**COLUMNS, **changes})


def assert_same(one, other):
    for field in dataclasses.fields(Recording):
        if field.name in ('name', 'digest'):
            continue
        a, b = getattr(one, field.name), getattr(other, field.name)
        if isinstance(a, np.ndarray):
            np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-12)
        else:
            assert a == b, field.name


@pytest.mark.parametrize('gap', [False, True])
def test_it_is_the_recording_of_the_file_that_pandas_writes(tmp_path, gap):
    given = frame()
    if gap:  # a command of its own rate, and a stretch without rows
        given.loc[given.index % 2 == 1, 'position_mm'] = np.nan
        given = given.drop(index=range(499, 702))
    given.to_csv(tmp_path / 'rig.csv', index=False)
    expected = read_recording(tmp_path / 'rig.csv', JOINT)
    found = Recording.from_dataframe(given, JOINT)
    assert_same(found, expected)
    assert bool(found.gaps) is gap
    assert 'columns not used: valve' in found.warnings
    assert found.name == 'dataframe'


def test_an_index_with_the_name_of_a_column_is_one(tmp_path):
    expected = Recording.from_dataframe(frame())
    assert_same(Recording.from_dataframe(frame().set_index('t_s')), expected)


@pytest.mark.parametrize('zone', [None, 'Europe/Berlin'])
def test_an_index_of_dates_is_the_time(zone):
    dates = pd.Timestamp('2026-03-01 12:00', tz=zone) + pd.to_timedelta(T, unit='s')
    given = frame().drop(columns='t_s').set_index(dates)
    found = Recording.from_dataframe(given, name='monday')
    np.testing.assert_allclose(found.t, T, atol=1e-9)
    assert found.name == 'monday'


def test_muscles_have_columns_of_their_own():
    given = pd.DataFrame(
        {
            't_s': T,
            'flexor.pressure_command_kPa': COLUMNS['pressure_command_kPa'],
            'extensor.pressure_command_kPa': 500.0 - COLUMNS['pressure_command_kPa'],
            'position_rad': 0.3 * np.sin(T),
        }
    )
    found = Recording.from_dataframe(given, muscles=('extensor', 'flexor'))
    assert found.muscles == ('extensor', 'flexor')
    np.testing.assert_allclose(found.command[:, 1], 1e3 * COLUMNS['pressure_command_kPa'])


def test_other_names_are_mapped():
    given = frame().rename(columns={'position_mm': 'stroke'})
    with pytest.raises(RecordingError, match='dataframe has no position'):
        Recording.from_dataframe(given)
    found = Recording.from_dataframe(given, mapping=read_mapping(['stroke=position_mm']))
    assert_same(found, Recording.from_dataframe(frame()))


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        (lambda: frame(position_mm='high'), 'column position_mm has values that are not numbers'),
        (lambda: frame().drop(columns='t_s'), "has no time axis: name a column 't_s'"),
        (lambda: frame(t_s=np.where(T == 0.5, np.nan, T)), 'row 50: a row without a time'),
        (lambda: frame(t_s=T[::-1]), 'dataframe: t_s'),
        (lambda: frame(pressure_command_kPa=1e3), 'pressure_command .*1e\\+06 Pa'),
        (lambda: frame().iloc[:50], 'has 50 usable samples'),
        (
            lambda: pd.concat([frame(), frame()[['valve']]], axis=1),
            'has several columns of one name',
        ),
    ],
    ids=['text', 'no time', 'NaN', 'backwards', 'pressure', 'short', 'names'],
)
def test_what_cannot_be_used_is_refused(given, sentence):
    with pytest.raises(RecordingError, match=sentence):
        Recording.from_dataframe(given(), JOINT)


@pytest.mark.parametrize('value', [None, 3.0, [1.0], {'t_s': T}])
def test_what_is_no_dataframe_is_refused(value):
    with pytest.raises(ParameterError, match=r'frame = .* is not allowed: give a DataFrame'):
        Recording.from_dataframe(value)


@pytest.mark.parametrize('kind', ['Float64', 'Int64'])
def test_a_missing_value_of_a_type_with_a_mask_is_an_empty_cell(kind):
    whole = np.round(1e3 * COLUMNS['position_mm']).astype(int)
    cells = pd.array([None if k == 700 else int(one) for k, one in enumerate(whole)], dtype=kind)
    given = frame(position_um=cells).drop(columns='position_mm')
    found = Recording.from_dataframe(given, JOINT)
    kept = np.delete(np.arange(T.size), 700)
    np.testing.assert_allclose(found.t, T[kept])
    np.testing.assert_allclose(found.position, 1e-6 * whole[kept])
