# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Forces from outside in a scenario: which there are, and how far they move the load."""

import numpy as np
import pytest
import yaml

from pam_ros.bench.forces import Force, forces_of, left_alone, response
from pam_ros.bench.scenario import read_scenario

AMPLITUDE, FREQUENCY, MASS = 1.0, 3.0, 20.0  # N, Hz, kg


def setups_of(folder, changes, duration=20.0):
    path = folder / 'forces.yaml'
    content = {
        'about': 'Forces.',
        'duration': duration,
        'declared': {'muscle': 'dmsp_20_400n', 'mass': MASS},
        'undeclared': {'initial.pressure': 300e3},
        'reference': {'kind': 'hold'},
        'changes': changes,
    }
    path.write_text(yaml.safe_dump(content), encoding='utf-8')
    return read_scenario(path).setups(0, 'lockstep')


def force(time, **values):
    return {'time': time, **{f'effects.periodic_disturbance.{k}': v for k, v in values.items()}}


def test_forces_are_those_of_the_changes(tmp_path):
    changes = [
        force(2.0, force_sin=3.0, force_cos=-4.0, frequency=1.0),
        {'time': 9.0, 'effects.payload.mass': 1.0},
        force(12.0, frequency=2.0),
        force(15.0, frequency=0.0),  # a constant push
        force(16.0, frequency=0.5),  # too slow for the time that is left
    ]
    found = forces_of(setups_of(tmp_path, changes), 20.0)
    assert found == [Force(2.0, 12.0, 1.0, 5.0), Force(12.0, 15.0, 2.0, 5.0)]


def test_the_response_is_that_at_the_frequency_of_the_force():
    t = np.arange(5000) / 500.0
    sine = np.sin(2.0 * np.pi * FREQUENCY * t + 0.7)
    other = np.random.default_rng(0).normal(0.0, 1e-5, t.size) + 2e-4 * (t - 5.0)
    settling = np.where(t < 5.5, 1e-3, 0.0)
    found = response(t, 1e-4 * sine + other + settling, Force(1.0, 10.0, FREQUENCY, 1.0))
    assert found == pytest.approx(1e-4, rel=0.01)


@pytest.mark.needs_numba
def test_a_rig_left_alone_moves_as_its_stiffness_damping_and_mass_say(tmp_path):
    setups = setups_of(tmp_path, [force(0.5, force_sin=AMPLITUDE, frequency=FREQUENCY)])
    position = left_alone(setups, 5000)
    t = np.arange(5000) / 500.0
    found = response(t, position, Force(0.5, 10.0, FREQUENCY, AMPLITUDE))
    (muscle,) = setups[0][1].muscles
    stiffness = muscle.stiffness(300e3, muscle.equilibrium(300e3, MASS * 9.80665))
    damping = 2.0 * muscle.zeta * np.sqrt(stiffness * MASS)
    w = 2.0 * np.pi * FREQUENCY
    expected = AMPLITUDE / abs(stiffness - MASS * w * w + 1j * w * damping)
    assert found == pytest.approx(expected, rel=0.02)
