# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Identifications of a load that moves, with measured pressures: which signal shows what."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.identify import identify
from pam_ros.report.numbers import numbers
from pam_ros.report.provenance import provenance_of_program
from pam_ros.report.runs import runs_of
from support import bench_truth
from truth import effect

pytestmark = [pytest.mark.needs_numba, pytest.mark.slow]
NOISE, OF_PRESSURE = 20e-6, 300.0  # m, and Pa of the sensor of the truth plant
OFF = [0.01, -0.015, 0.005, 0.01, -0.01, 0.015]
LAG = effect('pressure_lag', 'two_times', fill_s=0.05, vent_s=0.07)
LATE = effect('dead_time', dead_time_s=0.02)
FRICTION = effect('coulomb_friction', coulomb_n=12.0, static_n=14.0, stribeck_m_s=5e-3)


def names(found):
    return {one.name for one in found.effects}


def test_the_pressures_show_the_path_and_the_motion_what_is_behind_it():
    recording = bench_truth.with_pressures(LAG, LATE, FRICTION, seed=1)
    found = identify(bench_truth.nominal(off=OFF), recording)
    assert found.verdict == 'effect_found'
    assert names(found) == {'pressure_lag', 'dead_time', 'coulomb_friction'}
    there = {name: one.value for each in found.effects for name, one in each.parameters.items()}
    for name, value in {'fill': 0.05, 'vent': 0.07, 'delay': 0.02, 'level': 12.0}.items():
        assert there[name] == pytest.approx(value, rel=0.05)
    assert found.stages[2].held_error < 4.0 * NOISE < 0.1 * found.stages[1].held_error
    (lag,) = (one for one in found.effects if one.name == 'pressure_lag')
    assert lag.reason.startswith('in the measured pressures lowers the score by')
    assert not any('not used' in warning for warning in found.warnings)
    (row,) = numbers(found, runs_of(found), provenance_of_program(found))['pressures']
    assert row['noise_floor'] == pytest.approx(OF_PRESSURE, rel=0.15)
    assert row['augmented'] < 1.2 * OF_PRESSURE < 0.1 * row['declared']


def test_a_slow_pressure_sensor_is_no_effect_of_the_rig():
    recording = bench_truth.with_pressures(FRICTION, seed=1)
    late = np.interp(recording.t - 0.03, recording.t, recording.pressure)
    found = identify(bench_truth.nominal(off=OFF), replace(recording, pressure=late))
    assert names(found) == {'coulomb_friction'}


def of_another_sensor(recording):
    rng = np.random.default_rng(1)
    other = 2e5 + 2e3 * np.cumsum(rng.standard_normal(recording.t.size))
    return replace(recording, pressure=other)


def of_no_sensor(recording):
    at = np.searchsorted(recording.command_t, recording.t, side='right') - 1
    # The pressure of the air was added and subtracted.
    return replace(recording, pressure=recording.command[at] + 101325.0 - 101325.0)


def of_a_dead_sensor(recording):
    return replace(recording, pressure=np.zeros_like(recording.pressure))


def of_absolute_pressures(recording):
    return replace(recording, pressure=recording.pressure + 101325.0)


def in_kilopascal(recording):
    return replace(recording, pressure=1e-3 * recording.pressure)


@pytest.mark.parametrize(
    ('spoiled', 'words'),
    [
        (of_another_sensor, 'they differ from what the commands give by'),
        (of_a_dead_sensor, 'they are constant while the commands change'),
        (of_no_sensor, 'they equal the commands in all samples'),
        (of_absolute_pressures, 'are they absolute?'),
        (in_kilopascal, 'in another unit?'),
    ],
)
def test_a_pressure_that_cannot_be_right_is_named_and_not_used(spoiled, words):
    recording = bench_truth.with_pressures(LAG, seed=4)
    found = identify(bench_truth.nominal(off=OFF), spoiled(recording))
    (warning,) = (one for one in found.warnings if 'measured pressures are not used' in one)
    assert words in warning
    # All is as if it had not been measured.
    plain = identify(bench_truth.nominal(off=OFF), replace(recording, pressure=None))
    assert found.sentence == plain.sentence
    assert names(found) == {'pressure_lag'}
