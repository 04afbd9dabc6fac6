# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Lists of recordings: each with its own load, its own columns, and its own way to be read."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.settings.nominal import nominal_joint
from pam_ros.settings.recording_list import read_recordings, recording_files

ROWS = ''.join(
    f'{0.01 * k:.2f},{200 + 100 * np.sin(0.1 * k):.3f},{60 + 5 * np.sin(0.1 * k - 0.3):.4f}\n'
    for k in range(1500)
)
JOINT = nominal_joint('dmsp_20_400n', ['mass=20']).joint


@pytest.fixture
def folder(tmp_path):
    """Return a folder with a file of usual columns and one without names."""
    (tmp_path / 'light.csv').write_text('t_s,pressure_command_kPa,position_mm\n' + ROWS)
    (tmp_path / 'heavy.csv').write_text(ROWS)
    return tmp_path


def listed(folder, text):
    path = folder / 'recordings.yaml'
    path.write_text(text)
    return path


def test_each_recording_has_what_the_list_says_of_it(folder):
    path = listed(
        folder,
        """
recordings:
  - file: light.csv
    set: {mass: 10}
    columns: {position_mm: position_mm-3}
    note: 21 degrees
  - file: heavy.csv
    names: t_s,pressure_command_kPa,position_mm
""",
    )
    light, heavy = read_recordings(path, JOINT)
    assert (light.name, light.numbers, light.note) == ('light.csv', {'mass': 10.0}, '21 degrees')
    assert (heavy.name, heavy.numbers, heavy.note) == ('heavy.csv', {}, '')
    np.testing.assert_allclose(light.position, heavy.position - 3e-3, atol=1e-12)


def test_numbers_for_all_are_those_of_recordings_without_their_own(folder):
    path = listed(folder, 'recordings: [{file: a, set: {mass: 10}}, {file: b}]')
    files, params = recording_files(path, {'mass': 7.0})
    assert params is None
    assert [one.numbers for one in files] == [{'mass': 10.0}, {'mass': 7.0}]
    assert [one.path for one in files] == [folder / 'a', folder / 'b']


@pytest.mark.parametrize('is_file', [True, False])
def test_a_list_names_its_rig_by_a_file_beside_it_or_by_a_muscle(folder, is_file):
    if is_file:
        (folder / 'mas10').touch()
    path = listed(folder, 'params: mas10\nrecordings: [{file: a}]')
    _, params = recording_files(path)
    assert params == (str(folder / 'mas10') if is_file else 'mas10')


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('recordings: [{file: light.csv}]\nset: {mass: 3}', "'set' is not known: give recordings"),
        ('recordings: [{file: light.csv}]\nparams: [a]', "params = ['a'] is not allowed"),
        ('columns: {}', "has no list 'recordings'"),
        ('recordings: []', "has no list 'recordings'"),
        ('recordings: [light.csv]', "recording 1 has no 'file'"),
        ('recordings: [{file: light.csv, mass: 3}]', "recording 1: 'mass' is not known"),
        ('recordings: [{file: light.csv, note: 3}]', 'note = 3 is not allowed'),
        ('recordings: [{file: light.csv, set: {mass: heavy}}]', "set = {'mass': 'heavy'}"),
        ('recordings: [{file: light.csv, set: {mass: yes}}]', "set = {'mass': True}"),
        ('recordings: [{file: light.csv, set: {mass: -1}}]', 'light.csv: mass = -1.0'),
        ('recordings: [{file: light.csv, set: {a2: 1}}]', 'a2 cannot differ between recordings'),
        ('recordings: [{file: light.csv, columns: [x]}]', "columns = ['x'] is not allowed"),
        ('recordings: [{file: light.csv, kind: hanging}]', "kind = 'hanging' is not known"),
        ('recordings: [{file: absent.csv}]', 'absent.csv does not exist'),
        ('recordings: [{file: light.csv', 'list of recordings'),
    ],
)
def test_a_list_that_cannot_be_used_is_one_sentence(folder, text, words):
    with pytest.raises(RecordingError) as caught:
        read_recordings(listed(folder, text), JOINT)
    assert words in str(caught.value)
    assert '\n' not in str(caught.value)
