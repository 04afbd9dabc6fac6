# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Identifications of the pressure path alone: commands and pressures of the truth plant."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.identification.data.checked import checked
from pam_ros.identification.identify import identify
from pam_ros.recording.read import read_recording
from pam_ros.recording.recording import Recording
from pam_ros.report.save import save_report
from pam_ros.rig.run import simulate_pressure
from pam_ros.settings.load import load_joint
from pam_ros.settings.nominal import nominal_joint, package_muscles
from support import bench_truth
from support.joint_models import pair
from truth import effect

pytestmark = [pytest.mark.needs_numba, pytest.mark.slow]
ROOT = Path(__file__).parents[2]
NOISE = 300.0  # Pa, of the sensor of the truth plant
LAG = effect('pressure_lag', 'two_times', fill_s=0.05, vent_s=0.07)
LATE = effect('dead_time', dead_time_s=0.03)


def test_a_lag_and_a_dead_time_are_told_apart_whatever_muscle_the_regulator_feeds(tmp_path):
    jsonschema = pytest.importorskip('jsonschema')
    recording = bench_truth.of_pressures(LATE, LAG, seed=4)
    found = identify(bench_truth.nominal(), recording)
    assert found.verdict == 'effect_found'
    assert {one.name for one in found.effects} == {'pressure_lag', 'dead_time'}
    numbers = {name: one for each in found.effects for name, one in each.parameters.items()}
    for name, value in {'fill': 0.05, 'vent': 0.07, 'delay': 0.03}.items():
        assert numbers[name].low <= value <= numbers[name].high
        assert numbers[name].value == pytest.approx(value, rel=0.03)
    assert (found.quantity, found.unit) == ('pressure', 'Pa')
    assert found.noise.sigma == pytest.approx(NOISE, rel=0.15)
    assert found.stages[2].held_error < 1.1 * NOISE
    # The identified joint gives the pressures that were measured.
    run = found.simulate(recording)
    assert np.sqrt(np.mean((run.pressure - recording.pressure) ** 2)) < 1.1 * NOISE
    assert np.isnan(run.position).all()
    save_report(found, tmp_path / 'report')
    report = json.loads((tmp_path / 'report' / 'report.json').read_text(encoding='utf-8'))
    schema = json.loads((ROOT / 'docs' / 'report.schema.json').read_text(encoding='utf-8'))
    assert [*jsonschema.Draft202012Validator(schema).iter_errors(report)] == []
    joint = load_joint(tmp_path / 'report' / 'identified.yaml')
    same = simulate_pressure(joint, recording.t, recording.command)
    np.testing.assert_allclose(same, run.pressure, atol=1.0)
    # Neither muscle nor load has an influence.
    other = identify(nominal_joint('dmsp_10').joint, recording)
    assert other.stages[2].parameters == found.stages[2].parameters


def test_noise_alone_is_no_effect():
    found = identify(bench_truth.nominal(), bench_truth.of_pressures(seed=5))
    assert found.verdict == 'no_missing_effect'
    assert found.effects == ()


def test_the_muscle_whose_valve_is_slow_is_named():
    slow = bench_truth.of_pressures(LAG, seed=4)
    quick = bench_truth.of_pressures(seed=6)
    both = Recording(
        'pair.csv',
        slow.t,
        slow.t,
        np.stack([quick.command, slow.command], axis=1),
        pressure=np.stack([quick.pressure, slow.pressure], axis=1),
        kind='pressure',
        muscles=('agonist', 'antagonist'),
    )
    found = identify(pair(), both)
    assert [one.name for one in found.effects] == ['antagonist.pressure_lag']
    assert [one.name for one in found.segments] == ['pair.csv (agonist)', 'pair.csv (antagonist)']
    assert found.effects[0].parameters['fill'].value == pytest.approx(0.05, rel=0.03)


def test_a_muscle_that_is_not_moved_may_have_a_constant_pressure():
    one = bench_truth.of_pressures(LAG, seed=4)
    still = np.full_like(one.command, 2e5)
    both = replace(
        one,
        command=np.stack([one.command, still], axis=1),
        pressure=np.stack([one.pressure, still], axis=1),
        muscles=('agonist', 'antagonist'),
    )
    assert not any('was the sensor read' in warning for warning in checked(both, pair()).warnings)
    with pytest.raises(RecordingError, match=r'agonist\.pressure is constant while agonist'):
        checked(replace(both, pressure=both.pressure[:1] + 0.0 * both.pressure), pair())


def test_commands_in_another_unit_are_noticed():
    recording = bench_truth.of_pressures(seed=4)
    # They are in psi, and were read as kPa.
    spoiled = replace(recording, command=recording.command / 6.894757)
    found = identify(bench_truth.nominal(), spoiled, muscles=package_muscles())
    assert found.verdict == 'insufficient_data'
    assert 'the command is 6.895 times as large' in found.sentence


def test_an_absolute_pressure_is_asked_about():
    recording = bench_truth.of_pressures(LAG, seed=4)
    absolute = replace(recording, pressure=recording.pressure + 101325.0)
    found = identify(bench_truth.nominal(), absolute)
    assert any("'NAME=pressure_Pa-101325'" in warning for warning in found.warnings)


def test_a_recording_without_a_pressure_is_refused():
    recording = bench_truth.of_pressures(seed=4)
    with pytest.raises(RecordingError, match='no pressure was recorded'):
        identify(bench_truth.nominal(), replace(recording, pressure=None))


@pytest.mark.release
def test_the_measured_regulator_has_a_dead_time_and_a_lag(shared_data):
    files = sorted((shared_data / 'veab_regulator').glob('*.csv'))
    found = identify(bench_truth.nominal(), [read_recording(file) for file in files])
    assert {one.name for one in found.effects} == {'pressure_lag', 'dead_time'}
    # 2 % of the range of the commands, -80 to 80 kPa.
    assert found.stages[2].held_error < 3.2e3
    assert found.stages[0].held_error > 7e3
