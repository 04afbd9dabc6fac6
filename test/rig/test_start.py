# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""States after a long rest, and hidden states that begin away from it."""

import numpy as np
import pytest

from pam_ros.effects import (
    EFFECTS,
    CoulombFriction,
    Creep,
    Hysteresis,
    PressureHysteresis,
    PressureLag,
    PressureOffset,
    ViscousFriction,
)
from pam_ros.errors import ParameterError
from pam_ros.rig import layout as at
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.start import (
    begin_effects,
    disturb,
    fill_chambers,
    start_joint,
    start_muscle,
    start_state,
)
from support import bench, joints
from support.joint_models import UNEQUAL, lever, pair

LAG = [PressureLag(fill=0.1, vent=0.2)]
T = np.linspace(0.0, 1.0, 101)


def test_a_start_is_a_long_rest():
    """A lagging chamber is full, and what is downstream of an offset has got it."""
    joint = single_muscle_joint(effects=[*LAG, PressureOffset(offset=5e3)])
    x = start_state(joint.layout, joint.parameters(), [2e5], 0.03, 0.1)
    assert list(x[at.JOINT, [at.S, at.V]]) == [0.03, 0.1]
    assert x[at.MUSCLE, at.P] == 2.05e5
    assert x[at.MUSCLE, joint.layout.state_at['pressure_lag']] == 2.05e5


def test_effects_that_are_not_there_need_no_start():
    """What is known to be there begins as ever, and what is not leaves the run as it is."""
    effects = [*LAG, Creep(force=0.03), ViscousFriction(coefficient=20.0)]
    joint = single_muscle_joint(effects=effects)
    layout, q = joint.layout, joint.parameters()
    present = tuple(type(effect) for effect in effects)
    x = start_state(layout, q, [2e5], 0.03, 0.1)
    some = start_state(layout, q, [2e5], 0.03, 0.1, present)
    assert some[at.MUSCLE, at.P] == x[at.MUSCLE, at.P]
    for effect in present:
        row = at.JOINT if effect.acts_on_joint() else at.MUSCLE
        i = layout.state_at[effect.name]
        own = slice(i, i + len(effect.states))
        np.testing.assert_array_equal(some[row, own], x[row, own])


def test_one_effect_can_be_started_alone():
    joint = single_muscle_joint(effects=LAG)
    layout, q = joint.layout, joint.parameters()
    x = start_state(layout, q, [2e5], 0.03, 0.1)
    before = x.copy()
    lag = next(e for e in joint.library if e.name == 'pressure_lag')
    start_muscle(layout, q, x, 0, 4e5, (lag,))
    i = layout.state_at['pressure_lag']
    assert x[at.MUSCLE, i] == x[at.MUSCLE, at.P] == 4e5
    x[at.MUSCLE, [i, at.P]] = before[at.MUSCLE, [i, at.P]]
    np.testing.assert_array_equal(x, before)
    start_joint(layout, q, x, (lag,))  # it is none of the joint's
    np.testing.assert_array_equal(x, before)


MEMORIES = [Hysteresis(slip=3.0), PressureHysteresis(slip=3e3)]


@pytest.mark.parametrize(
    ('joint', 'ends'),
    [
        (pair(effects=((), MEMORIES)), joints.ends(0.3, UNEQUAL)),
        (
            lever(effects=((), MEMORIES)),
            [
                kappa * strand.l0 + joints.drawn(0.3, i)
                for i, (kappa, strand) in enumerate(
                    zip((joints.KAPPA_1, joints.KAPPA_2), UNEQUAL, strict=True)
                )
            ],
        ),
    ],
    ids=['pair', 'lever'],
)
def test_each_muscle_starts_at_its_own_place_and_pressure(joint, ends):
    """Hysteresis remembers the contraction, or the pressure, that it was left at."""
    layout = joint.layout
    x = start_state(layout, joint.parameters(), [2e5, 3e5], 0.3, 0.0)
    over_kappa, over_p = (layout.state_at[effect.name] for effect in MEMORIES)
    expected = [y / strand.l0 for y, strand in zip(ends, UNEQUAL, strict=True)]
    np.testing.assert_allclose(x[at.MUSCLE :, over_kappa + 1], expected, rtol=1e-13)
    np.testing.assert_array_equal(x[at.MUSCLE :, over_p], [2e5, 3e5])


# Away from rest -------------------------------------------------------------------------------


def test_a_chamber_that_begins_away_from_the_command_comes_to_it_with_its_time_constant():
    """From above with that of venting, from below with that of filling."""
    for away, tau in ((4e4, 0.2), (-4e4, 0.1)):
        hidden = {'pressure_lag': {'pressure': away}}
        run = simulate(single_muscle_joint(effects=LAG), T, [3e5], [0.0], hidden=hidden)
        np.testing.assert_allclose(run.pressure, 3e5 + away * np.exp(-T / tau), rtol=1e-12)
        # The force is that of the pressure, at the first sample, too.
        muscle = single_muscle_joint().muscle
        pull = muscle.force(run.pressure[0], run.position[0] / muscle.l0)
        assert run.force[0] == pytest.approx(float(pull), rel=1e-12)


def test_the_coordinate_begins_at_rest_under_the_command():
    joint = single_muscle_joint(effects=LAG)
    run = simulate(joint, T, [3e5], [0.0], hidden={'pressure_lag': {'pressure': -4e4}})
    assert run.position[0] == equilibrium(joint, 3e5)
    assert np.ptp(run.position) > 1e-3


@pytest.mark.slow
def test_all_muscles_of_a_joint_begin_alike_away_from_rest():
    joint = lever(effects=(LAG, LAG))
    run = simulate(joint, T, [[3e5, 2e5]], [0.0], hidden={'pressure_lag': {'pressure': 3e4}})
    falls = 3e4 * np.exp(-T / 0.2)
    np.testing.assert_allclose(run.pressure, np.stack([3e5 + falls, 2e5 + falls], 1), rtol=1e-12)


def test_what_creeps_begins_unrelaxed_and_relaxes():
    """What follows the contraction begins 0.01 below it: the stiffness of so much is there."""
    away = {'creep': {'fast contraction': -0.01, 'slow contraction': -0.01}}
    t = np.linspace(0.0, 2.0, 101)
    held_at = 0.05
    joint = bench.cart(Creep(stiffness=5.0, time=0.5), mass=1e4)
    run = simulate(joint, t, [0.0], [0.0], position=held_at, hidden=away)
    # A cart of ten tons hardly moves: 5 N of 0.01 pull it back, and exp(-t/0.5) of them are left.
    np.testing.assert_allclose(run.force, -0.05 * np.exp(-t / 0.5), atol=5e-5)


def test_without_a_start_nothing_is_moved():
    joint = single_muscle_joint(effects=LAG)
    bare, said = (simulate(joint, T, [3e5], [0.0], hidden=hidden) for hidden in (None, {}))
    for one, other in zip(vars(bare).values(), vars(said).values(), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(
    ('hidden', 'sentence'),
    [
        (
            {'payload': {'mass': 1.0}},
            'effect payload has no hidden states: give one of '
            + ', '.join(effect.name for effect in EFFECTS if effect.states),
        ),
        (
            {'creep': {'slow contraction': 1e-3}},
            'effect creep is absent from this joint: hidden may be of pressure_lag',
        ),
        ({'magic': {}}, 'effect magic has no hidden states: give one of '),
        (
            {'pressure_lag': {'preasure': 1.0}},
            'effect pressure_lag has no hidden state preasure: give one of pressure',
        ),
    ],
)
def test_a_name_that_nothing_has_is_refused_with_a_sentence(hidden, sentence):
    with pytest.raises(ParameterError) as error:
        simulate(single_muscle_joint(effects=LAG), T, [3e5], [0.0], hidden=hidden)
    assert str(error.value).startswith(sentence)


WITH_SPREAD = [e for e in EFFECTS if any(state.spread > 0.0 for state in e.states)]


@pytest.mark.needs_numba
@pytest.mark.parametrize('sign', [2.0, -2.0])
@pytest.mark.parametrize('effect', WITH_SPREAD, ids=lambda effect: effect.name)
def test_a_run_may_begin_with_every_hidden_state_two_spreads_away(effect, sign):
    """It stays finite, and comes to move with the run that began at rest, or stays near it."""
    hidden = {effect.name: {state.name: sign * state.spread for state in effect.states}}
    joint = bench.hanging(effect.example())
    t = np.linspace(0.0, 5.0, 501)
    commands = [3e5, 2e5, 4e5], [0.0, 1.0, 2.5]
    moved, still = (simulate(joint, t, *commands, hidden=h) for h in (hidden, None))
    for values in (moved.position, moved.velocity, moved.pressure, moved.force):
        assert np.all(np.isfinite(values))
    away = np.abs(moved.position - still.position)
    assert np.max(away) > 1e-7
    assert np.max(away) < 0.2 * bench.L0
    assert away[-1] < 0.5 * np.max(away)


def test_states_that_are_not_known_beforehand_have_spreads():
    """Names of one effect's states differ; a spread of 0 says that a state is always known."""
    for effect in EFFECTS:
        names = [state.name for state in effect.states]
        assert len(set(names)) == len(names)
        assert all(state.spread >= 0.0 for state in effect.states)


def test_effects_that_begin_leave_the_joint_where_it_is():
    """Memories are those of a rest at the pressures that the chambers have, in each muscle."""
    each = [*LAG, Creep(force=0.03)]
    joint = pair(effects=(each, each), load=[CoulombFriction(level=1.0)])
    layout = joint.layout
    without = pair().parameters()
    x = start_state(layout, without, [2e5, 3e5], 0.2, 0.5)
    before = x.copy()
    x[:, at.JOINT_HIDDEN :] = -7.0  # what nothing has read until now
    begun = [e for e in joint.library if e.name in ('pressure_lag', 'coulomb_friction')]
    lag, friction_effect = begun
    begin_effects(layout, without, x, [[friction_effect], [lag], [lag]])
    assert np.array_equal(x[at.JOINT, :2], before[at.JOINT, :2])
    assert list(x[at.MUSCLE :, at.P]) == [2e5, 3e5]
    assert list(x[at.MUSCLE :, layout.state_at['pressure_lag']]) == [2e5, 3e5]
    friction = layout.state_at['coulomb_friction']
    assert list(x[at.JOINT, friction : friction + 2]) == [0.0, 0.2]
    # One muscle alone.
    x[at.MUSCLE :, at.HIDDEN :] = -7.0
    begin_effects(layout, without, x, [[], [], [lag]])
    assert list(x[at.MUSCLE :, layout.state_at['pressure_lag']]) == [-7.0, 3e5]
    # An effect that does not begin keeps its states.
    creep = next(e for e in joint.library if e.name == 'creep')
    k = layout.state_at['creep']
    assert set(x[at.MUSCLE :, k : k + len(creep.states)].ravel()) == {-7.0}


# Those whose equations run in Python before a run, where a function such as log raises an error
# instead of returning NaN.
BEFORE_A_RUN = [
    effect
    for effect in EFFECTS
    if effect.equations.start or effect.equations.pressure or effect.equations.reservoir
]


def some_value(p, rng):
    """Return a value of the parameter p: an end of its range, a usual one, or any in between."""
    usual = np.clip(p.scale * 10.0 ** rng.integers(-2, 3), p.low, p.high)
    return float(rng.choice([p.low, p.high, usual, rng.uniform(p.low, p.high)]))


@pytest.mark.parametrize('effect', BEFORE_A_RUN, ids=lambda effect: effect.name)
def test_any_values_that_a_fit_may_try_have_a_start(effect):
    """Pressures may be far below 0, and hidden states many spreads away from rest."""
    rng = np.random.default_rng(1)
    tried = 0
    while tried < 300:
        values = {p.name: some_value(p, rng) for p in effect.parameters()}
        pressure = rng.choice([0.0, -5e4, -3e6, 3e6, rng.uniform(-1e6, 1e6)])
        away = {state.name: 4.0 * state.spread * rng.normal() for state in effect.states}
        try:
            joint = bench.hanging(effect(**values))
        except ParameterError:  # values that exclude each other, which no fit tries
            continue
        layout, q, here = joint.layout, joint.parameters(), [effect]
        x = start_state(layout, q, [pressure], rng.uniform(-0.1, 0.1), 0.1, here)
        assert np.all(np.isfinite(x)), values
        disturb(layout, q, x, [pressure], {effect.name: away} if away else {}, here)
        fill_chambers(layout, q, x, [pressure], here)
        assert np.all(np.isfinite(x)), values
        tried += 1
