# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pressures in the chambers alone: those of a joint that moves, and closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import DeadTime, PressureLag, Supply
from pam_ros.errors import ParameterError
from pam_ros.rig.run import simulate, simulate_pressure
from pam_ros.rig.standard_joints import single_muscle_joint
from support.joint_models import pair

JOINT = single_muscle_joint()
T = np.arange(0.0, 4.0, 0.005)
AT = np.array([0.0, 0.311, 0.9, 1.602, 1.61, 2.4, 3.3])
U = 1e5 * np.array([2.0, 4.5, 1.0, 3.0, 2.2, 5.0, 0.5])
CHOKED = PressureLag(fill=0.05, vent=0.08, fastest=2e6, fastest_vent=3e6, choking=0.8)


def with_effects(joint, *effects):
    actuators = [
        replace(one, effects=tuple(e for e in effects if not e.acts_on_joint()))
        for one in joint.actuators
    ]
    on_joint = tuple(effect for effect in effects if effect.acts_on_joint())
    return replace(joint, actuators=tuple(actuators), effects=on_joint)


IN_PATH = [effect.example() for effect in JOINT.library if effect.acts_on_pressure()]


@pytest.mark.parametrize('effect', [*IN_PATH, CHOKED], ids=lambda one: one.name)
def test_the_chambers_have_the_pressures_of_a_joint_that_moves(effect):
    joint = with_effects(JOINT, effect)
    # Only a choked flow is not exact over a step: it is of second order.
    most = 1.0 if effect is CHOKED else 1e-6
    found = simulate_pressure(joint, T, U, AT)
    np.testing.assert_allclose(found, simulate(joint, T, U, AT).pressure, atol=most)


def test_two_chambers_share_a_reservoir():
    joint = with_effects(
        pair(), Supply(share=0.3, level=3.5e5, recovery=0.5), PressureLag(fill=0.04)
    )
    commands = np.stack([U, U[::-1]], axis=1)
    found = simulate_pressure(joint, T, commands, AT)
    np.testing.assert_allclose(found, simulate(joint, T, commands, AT).pressure, atol=1.0)
    assert found.max() < 3.6e5


def test_a_lag_after_a_dead_time_is_an_exponential_from_its_moment_on():
    joint = with_effects(JOINT, DeadTime(delay=0.03), PressureLag(fill=0.1, vent=0.2))
    found = simulate_pressure(joint, T, [1e5, 3e5], [0.0, 1.0])
    late = np.maximum(T - 1.03, 0.0)
    np.testing.assert_allclose(found, 3e5 - 2e5 * np.exp(-late / 0.1), rtol=1e-9)


@pytest.mark.parametrize(
    ('step', 'effect', 'words'),
    [(0.0, DeadTime(), 'step'), (1e-3, DeadTime(delay=0.01, onset=2.0), 'dead_time.onset')],
)
def test_what_cannot_be_simulated_is_refused(step, effect, words):
    with pytest.raises(ParameterError, match=words):
        simulate_pressure(with_effects(JOINT, effect), T, U, AT, step=step)
