# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints stepped in time: same bits however they are driven, commands by muscle, changes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.effects import Creep, DeadTime, Leak, PressureLag, ViscousFriction
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.loads import Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints
from support.joint_models import UNEQUAL, lever, pair, parallel

# Effects with memory in the pressure path and in the force, and one that delays.
LAG = [PressureLag(fill=0.05, vent=0.1)]
DELAY = [DeadTime(delay=0.0125)]
CREEP = [Creep(stiffness=300.0, time=0.5)]
MODELS = (
    single_muscle_joint(),
    pair(effects=(LAG, DELAY), load=[ViscousFriction(coefficient=0.1)]),
    single_muscle_joint(Muscle(zeta=0.3), Mass(mass=5.0), LAG),
    single_muscle_joint(load=Mass(mount='horizontal'), effects=[*CREEP, *LAG]),
    parallel(50.0, effects=(CREEP, ())),
    single_muscle_joint(load=Mass(mass=8.0), effects=[*DELAY, *CREEP]),
    lever(effects=(DELAY, LAG)),
    pair(effects=(CREEP, [replace(LAG[0], onset=0.1505)])),
)
MUSCLES = sum(len(model.muscles) for model in MODELS)


def state(rig):
    return np.concatenate(
        [
            rig.position,
            rig.velocity,
            rig.pressure,
            rig.contraction,
            *rig.muscle_outputs(),
            *rig.joint_outputs(),
        ]
    )


def drive(split=(400,), look=False):
    """Run 0.4 s with new commands every 0.1 s, 100 steps made in the given pieces."""
    rig = Simulation(MODELS)
    for row in np.random.default_rng(4).uniform(0.0, 6e5, (4, MUSCLES)):
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
@given(st.lists(st.integers(0, 60), max_size=8), st.booleans())
def test_steps_may_be_split_into_any_calls_and_looked_at(split, look):
    np.testing.assert_array_equal(drive(split, look), drive())


def test_arrays_have_one_entry_a_joint_or_one_a_muscle():
    rig = Simulation(MODELS)
    assert rig.position.shape == rig.velocity.shape == (len(MODELS),)
    assert rig.pressure.shape == rig.contraction.shape == (MUSCLES,)
    assert {each.shape for each in rig.muscle_outputs()} == {(MUSCLES,)}
    assert {each.shape for each in rig.joint_outputs()} == {(len(MODELS),)}


def test_what_was_read_stays_as_it_was():
    rig = Simulation(MODELS)
    read = (
        *(rig.position, rig.velocity, rig.pressure, rig.contraction),
        *(*rig.muscle_outputs(), *rig.joint_outputs()),
    )
    before = [each.copy() for each in read]
    rig.command(5e5)
    rig.advance(20)
    for each, old in zip(read, before, strict=True):
        np.testing.assert_array_equal(each, old)
    assert not np.array_equal(rig.muscle_outputs().force, before[4])
    assert not np.array_equal(rig.joint_outputs().acceleration, before[-1])


def test_a_muscle_with_a_load_of_its_own_has_the_same_outputs_by_joint():
    rig = Simulation([single_muscle_joint(), single_muscle_joint(effects=LAG)])
    rig.command([3e5, 5e5])
    rig.advance(50)
    force, stiffness, _, acceleration = rig.muscle_outputs()
    np.testing.assert_array_equal(rig.joint_outputs(), (force, stiffness, acceleration))
    np.testing.assert_array_equal(rig.contraction, rig.position / 0.4)


def test_time_is_counted():
    rig = Simulation([single_muscle_joint()], step=1e-3)
    for _ in range(1000):
        rig.advance(7)
    assert rig.time == 7.0
    rig.reset([0.0], [0.0], [0.0])
    assert rig.time == 0.0


@pytest.mark.parametrize(('delay', 'late'), [(0.0, 0), (0.003, 3), (0.0031, 4), (1.0, 1000)])
def test_a_command_acts_when_its_dead_time_is_over(delay, late):
    """At the first step that starts at or after that moment."""
    rig = Simulation([single_muscle_joint(effects=[DeadTime(delay=delay)])])
    rig.advance(5)
    rig.command(4e5)
    rig.advance(late)
    assert rig.pressure[0] == 0.0
    rig.advance()
    assert rig.pressure[0] == 4e5


def test_each_muscle_of_a_joint_gets_its_own_command_after_its_own_dead_time():
    late = pair(effects=([DeadTime(delay=0.003)], [DeadTime(delay=0.005)]))
    rig = Simulation([single_muscle_joint(), late])
    rig.command([1e5, 2e5, 3e5])
    received = []
    for _ in range(7):
        rig.advance()
        received.append(rig.pressure)
    expected = np.zeros((7, 3))
    expected[:, 0], expected[3:, 1], expected[5:, 2] = 1e5, 2e5, 3e5
    np.testing.assert_array_equal(received, expected)


def test_all_commands_of_a_long_dead_time_arrive_in_order():
    """A second of delay with a command at each step: a thousand are under way."""
    rig = Simulation([single_muscle_joint(effects=[DeadTime(delay=1.0)])] * 2)
    received = []
    for k in range(2200):
        rig.command([100.0 * k, 50.0 * k])
        rig.advance()
        received.append(rig.pressure)
    received = np.array(received)
    expected = 100.0 * np.maximum(np.arange(2200) - 1000.0, 0.0)
    np.testing.assert_array_equal(received, np.stack([expected, 0.5 * expected], axis=1))


def test_the_last_of_several_commands_at_one_moment_counts():
    rig = Simulation([single_muscle_joint(effects=DELAY)])
    for p in range(5000):
        rig.command(float(p))
    rig.advance(14)
    assert rig.pressure[0] == 4999.0


def test_one_muscle_can_be_commanded_alone():
    rig = Simulation([single_muscle_joint(), pair()])
    rig.command([1e5, 2e5, 3e5])
    rig.advance()
    rig.command_one(2, 4e5)
    rig.advance()
    np.testing.assert_array_equal(rig.pressure, [1e5, 2e5, 4e5])
    rig.command_one(2, 5e5)
    rig.command_one(2, 6e5)  # the last one counts
    rig.advance()
    np.testing.assert_array_equal(rig.pressure, [1e5, 2e5, 6e5])


def test_reset_goes_to_any_state_and_forgets_the_delayed_commands():
    rig = Simulation([pair(effects=(DELAY, LAG)), single_muscle_joint()])
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
    rig = Simulation(MODELS)
    np.testing.assert_array_equal(rig.pressure, 0.0)
    before = rig.position
    np.testing.assert_allclose(before, [equilibrium(m, 0.0) for m in MODELS])
    rig.advance(300)
    np.testing.assert_allclose(rig.position, before, atol=1e-12)


@pytest.mark.parametrize(
    ('first', 'then'),
    [
        (single_muscle_joint(), single_muscle_joint(load=Mass(mass=35.0))),
        (pair(), pair(mass=2.5, contraction_1=0.1)),
    ],
    ids=['one muscle', 'pair'],
)
def test_parameters_change_while_it_runs(first, then):
    """A third of a second of one joint, then of another from the same state: as if begun there."""
    rig, other = Simulation([first]), Simulation([then])
    rig.command([4e5, 3e5][: len(first.muscles)])
    rig.advance(330)
    rig.change([then])
    assert rig.time == 0.33
    if first.is_revolute:
        assert rig.contraction[0] == pytest.approx(0.1 + joints.R * rig.position[0] / 0.4)
    other.reset(rig.pressure, rig.position, rig.velocity)
    np.testing.assert_array_equal(state(rig), state(other))
    rig.advance(500)
    other.advance(500)
    np.testing.assert_array_equal(state(rig), state(other))


@pytest.mark.parametrize(
    ('first', 'then', 'later'),
    [
        (
            single_muscle_joint(),
            single_muscle_joint(effects=[*LAG, *CREEP]),
            single_muscle_joint(load=Mass(mass=21.0), effects=[*LAG, *CREEP]),
        ),
        (pair(), pair(effects=(LAG, ())), pair(mass=1.6, effects=(LAG, ()))),
    ],
    ids=['one muscle', 'pair'],
)
def test_an_effect_that_appears_starts_from_the_present_state(first, then, later):
    """Without that, the lag would start from the pressure of the last reset."""
    rig = Simulation([first])
    rig.command(4e5)
    rig.advance(100)
    before = rig.position[0], rig.velocity[0]
    rig.change([then])
    rig.advance()
    assert rig.pressure[0] == pytest.approx(4e5, rel=1e-12)
    # 1e-4 m, or as much at the radius of the pulley.
    moved = 1e-4 / (joints.R if first.is_revolute else 1.0)
    assert rig.position[0] == pytest.approx(before[0] + 1e-3 * before[1], abs=moved)
    # Its memory is kept when other parameters change.
    rig.command(2e5)
    rig.advance(20)
    lagging = rig.pressure[0]
    assert lagging == pytest.approx(2e5 + 2e5 * np.exp(-20e-3 / 0.1))
    rig.change([later])
    rig.advance()
    assert rig.pressure[0] == pytest.approx(2e5 + (lagging - 2e5) * np.exp(-1e-3 / 0.1))


LATE = [Leak(rate=0.5, refill=0.1, onset=0.2)]


def test_an_onset_is_a_change_at_its_step():
    """To the bit, and again after a reset; without a jump of the pressure, which then sinks."""
    late, by_hand = Simulation([single_muscle_joint(effects=LATE)]), Simulation(
        [single_muscle_joint()]
    )  # fmt: skip
    for _ in range(2):
        late.reset(4e5, 0.03, 0.0)
        by_hand.reset(4e5, 0.03, 0.0)
        late.advance(200)
        by_hand.advance(200)
        np.testing.assert_array_equal(state(late), state(by_hand))
        by_hand.change([late.joints[0].stages[-1][1]])
        late.advance()
        by_hand.advance()
        assert 3.99e5 < late.pressure[0] < 4e5
        late.advance(99)
        by_hand.advance(99)
        np.testing.assert_array_equal(state(late), state(by_hand))
        by_hand.change([single_muscle_joint()])


@pytest.mark.parametrize(('at', 'begins'), [(100, 200), (200, 200), (300, 300)])
def test_an_onset_that_is_set_while_it_runs(at, begins):
    """One to come is waited for, one in the past begins at once."""
    rig, other = Simulation([single_muscle_joint()]), Simulation([single_muscle_joint()])
    for each in (rig, other):
        each.reset(4e5, 0.03, 0.0)
    rig.advance(at)
    rig.change([single_muscle_joint(effects=LATE)])
    rig.advance(500 - at)
    other.advance(begins)
    other.change([single_muscle_joint(effects=[Leak(rate=0.5, refill=0.1)])])
    other.advance(500 - begins)
    np.testing.assert_array_equal(state(rig), state(other))


def test_an_onset_that_is_moved_ahead_ends_the_effect_until_then():
    rig = Simulation([single_muscle_joint(effects=LATE)])
    rig.reset(4e5, 0.03, 0.0)
    rig.advance(300)
    leaking = rig.pressure[0]
    rig.change([single_muscle_joint(effects=[replace(LATE[0], onset=0.4)])])
    rig.advance(50)
    assert leaking < rig.pressure[0] == 4e5
    rig.advance(100)
    assert rig.pressure[0] < 4e5


def test_a_change_that_is_refused_leaves_the_rig_as_it_was():
    rig, other = Simulation([single_muscle_joint()]), Simulation([single_muscle_joint()])
    for each in (rig, other):
        each.command(3e5)
        each.advance(50)
    with pytest.raises(ParameterError, match='physics step of 1 ms does not resolve a mass of'):
        rig.change([single_muscle_joint(load=Mass(mass=0.01))])
    for each in (rig, other):
        each.advance(50)
    np.testing.assert_array_equal(state(rig), state(other))


def test_a_simulation_keeps_the_kinds_of_its_joints():
    rig = Simulation([pair(), single_muscle_joint()])
    rig.command(3e5)
    rig.advance(10)
    before = state(rig)
    for others in (
        [single_muscle_joint(), pair()],
        [pair()],
        [parallel(50.0), single_muscle_joint()],
        [lever(), single_muscle_joint()],
        [pair(), single_muscle_joint(library=())],
    ):
        with pytest.raises(ParameterError) as error:
            rig.change(others)
        assert str(error.value) == (
            'a simulation keeps the kinds of its joints: make a new Simulation for others'
        )
    np.testing.assert_array_equal(state(rig), before)
