# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints stepped in time: same bits however they are driven, commands by muscle, changes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.rig.joint import one_muscle
from pam_ros.rig.rest import rest
from pam_ros.rig.rig import Rig
from support import joints
from support.joint_models import UNEQUAL, lever, pair, parallel

LAG = {'pressure_lag': {'fill': 0.05, 'vent': 0.1}}
DELAY = {'dead_time': {'delay': 0.0125}}
CREEP = {'creep': {'stiffness': 300.0, 'time': 0.5}}
MODELS = (
    pair(effects=(LAG, DELAY), load={'viscous_friction': {'coefficient': 0.1}}),
    one_muscle(effects=CREEP | LAG),
    parallel(50.0, effects=(CREEP, {})),
    lever(effects=(DELAY, LAG)),
)


def state(rig):
    return np.concatenate(
        [
            rig.position,
            rig.velocity,
            rig.pressure,
            rig.contraction,
            rig.outputs().ravel(),
            rig.joint_outputs().ravel(),
        ]
    )


def drive(split=(400,), look=False):
    rig = Rig(MODELS)
    for row in np.random.default_rng(4).uniform(0.0, 6e5, (4, 7)):
        rig.command(row)
        left = 100
        for piece in (*split, left):
            rig.advance(min(piece, left))
            left -= min(piece, left)
            if look:
                state(rig)
    return state(rig)


def test_same_inputs_give_same_bits():
    np.testing.assert_array_equal(drive(), drive())


@pytest.mark.slow
@pytest.mark.needs_numba
@settings(deadline=None, max_examples=20)
@given(st.lists(st.integers(0, 60), max_size=8))
def test_steps_may_be_split_into_any_calls_and_looked_at(split):
    np.testing.assert_array_equal(drive(split, look=True), drive())


def test_arrays_have_one_entry_a_joint_or_one_a_muscle():
    rig = Rig(MODELS)
    assert rig.position.shape == rig.velocity.shape == (4,)
    assert rig.pressure.shape == rig.contraction.shape == (7,)
    assert rig.outputs().shape == (7, 4)
    assert rig.joint_outputs().shape == (4, 3)


def test_what_was_read_stays_as_it_was():
    rig = Rig(MODELS)
    read = rig.position, rig.pressure, rig.contraction, rig.outputs(), rig.joint_outputs()
    before = [each.copy() for each in read]
    rig.command(5e5)
    rig.advance(20)
    for each, old in zip(read, before, strict=True):
        np.testing.assert_array_equal(each, old)
    assert not np.array_equal(rig.joint_outputs(), before[4])


def test_a_muscle_with_a_load_of_its_own_has_the_same_outputs_by_joint():
    rig = Rig([one_muscle(), one_muscle(effects=LAG)])
    rig.command([3e5, 5e5])
    rig.advance(50)
    out = rig.outputs()
    np.testing.assert_array_equal(rig.joint_outputs(), out[:, [0, 1, 3]])
    np.testing.assert_array_equal(rig.contraction, rig.position / 0.4)


def test_each_muscle_of_a_joint_hears_its_own_command_after_its_own_dead_time():
    late = pair(effects=({'dead_time': {'delay': 0.003}}, {'dead_time': {'delay': 0.005}}))
    rig = Rig([one_muscle(), late])
    rig.command([1e5, 2e5, 3e5])
    heard = []
    for _ in range(7):
        rig.advance()
        heard.append(rig.pressure)
    expected = np.zeros((7, 3))
    expected[:, 0], expected[3:, 1], expected[5:, 2] = 1e5, 2e5, 3e5
    np.testing.assert_array_equal(heard, expected)


def test_one_muscle_can_be_commanded_alone():
    rig = Rig([one_muscle(), pair()])
    rig.command([1e5, 2e5, 3e5])
    rig.advance()
    rig.command_one(2, 4e5)
    rig.advance()
    np.testing.assert_array_equal(rig.pressure, [1e5, 2e5, 4e5])
    rig.command_one(2, 5e5)
    rig.command_one(2, 6e5)  # the last one counts
    rig.advance()
    np.testing.assert_array_equal(rig.pressure, [1e5, 2e5, 6e5])


def test_reset_goes_to_any_state_and_forgets_the_commands_under_way():
    rig = Rig([pair(effects=(DELAY, LAG)), one_muscle()])
    rig.command(4e5)
    rig.advance(3)
    rig.reset([1e5, 2e5, 3e5], [0.2, 0.05], [1.0, -0.1])
    assert rig.time == 0.0
    np.testing.assert_array_equal(rig.position, [0.2, 0.05])
    np.testing.assert_array_equal(rig.velocity, [1.0, -0.1])
    kappa = [*np.divide(joints.ends(0.2, UNEQUAL), [s.l0 for s in UNEQUAL]), 0.125]
    np.testing.assert_allclose(rig.contraction, kappa, rtol=1e-14)
    rig.advance(50)
    np.testing.assert_array_equal(rig.pressure, [1e5, 2e5, 3e5])


def test_it_starts_at_rest_without_pressure():
    rig = Rig([pair(), one_muscle(), parallel(50.0)])
    before = rig.position
    np.testing.assert_allclose(before, [rest(m, 0.0) for m in rig.joints])
    rig.advance(300)
    np.testing.assert_allclose(rig.position, before, atol=1e-12)


def test_parameters_change_while_it_runs():
    """A third of a second of one joint, then of another from the same state."""
    heavy = pair(mass=2.5, contraction_1=0.1)
    rig, other = Rig([pair()]), Rig([heavy])
    rig.command([4e5, 3e5])
    rig.advance(330)
    rig.change([heavy])
    assert rig.contraction[0] == pytest.approx(0.1 + joints.R * rig.position[0] / 0.4)
    assert rig.time == 0.33
    other.reset(rig.pressure, rig.position, rig.velocity)
    np.testing.assert_array_equal(state(rig), state(other))
    rig.advance(500)
    other.advance(500)
    np.testing.assert_array_equal(state(rig), state(other))


def test_an_effect_that_appears_starts_from_the_present_state():
    rig = Rig([pair()])
    rig.command([4e5, 3e5])
    rig.advance(100)
    rig.change([pair(effects=(LAG, {}))])
    rig.advance()
    assert rig.pressure[0] == pytest.approx(4e5, rel=1e-12)
    rig.command([2e5, 3e5])
    rig.advance()
    assert rig.pressure[0] == pytest.approx(2e5 + 2e5 * np.exp(-1e-3 / 0.1))


def test_a_rig_that_runs_keeps_its_joints():
    rig = Rig([pair(), one_muscle()])
    rig.command(3e5)
    rig.advance(10)
    before = state(rig)
    for others in (
        [one_muscle(), pair()],
        [pair()],
        [parallel(50.0), one_muscle()],
        [lever(), one_muscle()],
        [pair(), one_muscle(library=())],
    ):
        with pytest.raises(ParameterError) as error:
            rig.change(others)
        assert str(error.value) == ('a rig that runs keeps its joints: make a new one for others')
    np.testing.assert_array_equal(state(rig), before)
