# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Muscles stepped in time: same bits however they are driven, commands, changes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import one_muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.rest import rest
from pam_ros.rig.rig import Rig
from pam_ros.rig.run import simulate
from pam_ros.rig.step_limit import longest_step

# Effects with memory in the pressure path and in the force, and one that delays.
LAG = {'pressure_lag': {'fill': 0.05, 'vent': 0.1}}
DELAY = {'dead_time': {'delay': 0.0125}}
CREEP = {'creep': {'stiffness': 300.0, 'time': 0.5}}
MODELS = (
    one_muscle(),
    one_muscle(Muscle(zeta=0.3), Mass(mass=5.0), LAG),
    one_muscle(load=Mass(mount='horizontal'), effects=CREEP | LAG),
    one_muscle(load=Mass(mass=8.0), effects=DELAY | CREEP),
)


def state(rig):
    return np.stack([rig.position, rig.velocity, rig.pressure, *rig.outputs().T])


def drive(models, split=(400,)):
    """Run 0.4 s with new commands every 0.1 s, 100 steps made in the given pieces."""
    rig = Rig(models)
    rng = np.random.default_rng(4)
    commands = rng.uniform(0.0, 6e5, (4, 4))
    for row in commands:
        rig.command(row[: len(models)])
        left = 100
        for piece in split:
            rig.advance(min(piece, left))
            left -= min(piece, left)
        rig.advance(left)
    return state(rig)


def test_same_inputs_give_same_bits():
    np.testing.assert_array_equal(drive(MODELS), drive(MODELS))


@pytest.mark.needs_numba
@settings(deadline=None, max_examples=30)
@given(st.lists(st.integers(0, 60), max_size=8))
def test_steps_may_be_split_into_any_calls(split):
    np.testing.assert_array_equal(drive(MODELS, split), drive(MODELS))


def test_looking_at_the_outputs_changes_nothing():
    rig, watched = Rig(MODELS), Rig(MODELS)
    for each in (rig, watched):
        each.command(4e5)
    for _ in range(50):
        rig.advance(4)
        watched.advance(4)
        watched.outputs()
    np.testing.assert_array_equal(state(rig), state(watched))


def test_what_was_read_stays_as_it_was():
    rig = Rig(MODELS)
    read = rig.position, rig.velocity, rig.pressure, rig.outputs()
    before = [each.copy() for each in read]
    rig.command(5e5)
    rig.advance(20)
    for each, old in zip(read, before, strict=True):
        np.testing.assert_array_equal(each, old)
    assert not np.array_equal(rig.outputs(), before[3])


@pytest.mark.parametrize('which', [(0, 0), (1, 2), (3, 1)])
def test_each_muscle_is_what_it_is_alone(which):
    """Two muscles with effects, or without any: to the bit what each is in a rig of its own."""
    together = Rig([MODELS[i] for i in which])
    alone = [Rig([MODELS[i]]) for i in which]
    for k in range(20):
        commands = [2e5 + 1e4 * k, 5e5 - 1e4 * k]
        together.command(commands)
        together.advance(13)
        for rig, p in zip(alone, commands, strict=True):
            rig.command(p)
            rig.advance(13)
    found = np.concatenate([state(rig) for rig in alone], axis=1)
    np.testing.assert_array_equal(state(together), found)


def test_a_plain_muscle_beside_one_with_effects_is_the_same_muscle():
    """With effects bound but absent, it is what it is without them."""
    together, alone = Rig(MODELS), Rig(MODELS[:1])
    for rig in (together, alone):
        rig.command(4e5)
        rig.advance(500)
    np.testing.assert_allclose(state(together)[:, 0], state(alone)[:, 0], rtol=1e-12)


def test_it_is_what_simulate_gives():
    """The dead time is a whole number of steps: commands act at the same moments in both."""
    model = one_muscle(load=Mass(mass=8.0), effects={'dead_time': {'delay': 0.012}} | CREEP)
    command = {0: 1e5, 100: 4e5, 250: 2e5}
    t = np.arange(401) * 1e-3
    found = simulate(model, t, t[list(command)], list(command.values()), position=0.03)
    rig = Rig([model])
    rig.reset([1e5], [0.03], [0.0])
    for k in range(400):
        if k in command:
            rig.command(command[k])
        rig.advance()
    assert rig.position[0] == pytest.approx(found.position[-1], abs=1e-12)
    assert rig.velocity[0] == pytest.approx(found.velocity[-1], abs=1e-11)
    assert np.ptp(found.position) > 0.01


def test_time_is_counted():
    rig = Rig([one_muscle()], step=1e-3)
    for _ in range(1000):
        rig.advance(7)
    assert rig.time == 7.0
    rig.reset([0.0], [0.0], [0.0])
    assert rig.time == 0.0


@pytest.mark.parametrize(('delay', 'late'), [(0.0, 0), (0.003, 3), (0.0031, 4), (1.0, 1000)])
def test_a_command_acts_when_its_dead_time_is_over(delay, late):
    """At the first step that starts at or after that moment."""
    rig = Rig([one_muscle(effects={'dead_time': {'delay': delay}})])
    rig.advance(5)
    rig.command(4e5)
    rig.advance(late)
    assert rig.pressure[0] == 0.0
    rig.advance()
    assert rig.pressure[0] == 4e5


def test_all_commands_of_a_long_dead_time_arrive_in_order():
    """A second of delay with a command at each step: a thousand are under way."""
    rig = Rig([one_muscle(effects={'dead_time': {'delay': 1.0}})] * 2)
    heard = []
    for k in range(2200):
        rig.command([100.0 * k, 50.0 * k])
        rig.advance()
        heard.append(rig.pressure)
    heard = np.array(heard)
    expected = 100.0 * np.maximum(np.arange(2200) - 1000.0, 0.0)
    np.testing.assert_array_equal(heard, np.stack([expected, 0.5 * expected], axis=1))


def test_the_last_of_several_commands_at_one_moment_counts():
    rig = Rig([one_muscle(effects=DELAY)])
    for p in range(5000):
        rig.command(float(p))
    rig.advance(14)
    assert rig.pressure[0] == 4999.0


def test_reset_forgets_the_commands_under_way():
    rig = Rig([one_muscle(effects=DELAY)])
    rig.command(4e5)
    rig.advance(3)
    rig.reset([1e5], [0.02], [0.0])
    rig.advance(100)
    assert rig.pressure[0] == 1e5


def test_it_starts_at_rest_without_pressure():
    rig = Rig(MODELS)
    np.testing.assert_array_equal(rig.pressure, 0.0)
    np.testing.assert_allclose(rig.position, [rest(m, 0.0) for m in MODELS])
    before = rig.position
    rig.advance(200)
    np.testing.assert_allclose(rig.position, before, atol=1e-12)


def test_parameters_change_while_it_runs():
    """Half a second of one rig, then of another from the same state: as if started there."""
    heavy = one_muscle(load=Mass(mass=35.0))
    rig, other = Rig([one_muscle()]), Rig([heavy])
    rig.command(4e5)
    rig.advance(130)
    other.reset(rig.pressure, rig.position, rig.velocity)
    rig.change([heavy])
    assert rig.time == 0.13
    rig.advance(500)
    other.advance(500)
    np.testing.assert_array_equal(state(rig), state(other))


def test_an_effect_that_appears_starts_from_the_present_state():
    """Without that, the lag would start from the pressure of the last reset."""
    rig = Rig([one_muscle()])
    rig.command(4e5)
    rig.advance(100)
    before = rig.position[0], rig.velocity[0]
    with_lag = one_muscle(effects=LAG | CREEP)
    rig.change([with_lag])
    rig.advance()
    assert rig.pressure[0] == pytest.approx(4e5)
    assert rig.position[0] == pytest.approx(before[0] + 1e-3 * before[1], abs=1e-4)
    # Its memory is kept when other parameters change.
    rig.command(2e5)
    rig.advance(20)
    lagging = rig.pressure[0]
    assert 2e5 < lagging < 4e5
    rig.change([one_muscle(load=Mass(mass=21.0), effects=LAG | CREEP)])
    rig.advance()
    assert rig.pressure[0] == pytest.approx(2e5 + (lagging - 2e5) * np.exp(-1e-3 / 0.1))


def test_a_change_that_is_refused_leaves_the_rig_as_it_was():
    rig, other = Rig([one_muscle()]), Rig([one_muscle()])
    for each in (rig, other):
        each.command(3e5)
        each.advance(50)
    with pytest.raises(ParameterError, match='physics step of 1 ms does not resolve a mass of'):
        rig.change([one_muscle(load=Mass(mass=0.01))])
    for each in (rig, other):
        each.advance(50)
    np.testing.assert_array_equal(state(rig), state(other))


@pytest.mark.parametrize(
    ('step', 'sentence'),
    [
        (0.0, 'a physics step of 0 s is not allowed: give more than 0'),
        (-1e-3, 'a physics step of -0.001 s is not allowed: give more than 0'),
        (float('nan'), 'step = nan is not allowed: give a finite number'),
        (0.02, 'a physics step of 20 ms does not resolve a mass of 20 kg on this muscle: give at'),
    ],
)
def test_a_step_that_resolves_nothing_is_refused(step, sentence):
    with pytest.raises(ParameterError) as error:
        Rig([one_muscle()], step)
    assert str(error.value).startswith(sentence)


constants = st.tuples(
    st.floats(-8.0, 4.0),
    st.floats(100.0, 500.0),
    st.floats(-0.6, -0.1),
    st.floats(-14.0, -2.0),
    st.floats(80.0, 500.0),
    st.floats(-500.0, 100.0),
)


@settings(deadline=None, max_examples=150)
@given(
    constants,
    st.floats(0.1, 5.0),
    st.floats(0.03, 3.0),
    st.floats(0.01, 100.0),
    st.sampled_from(['vertical', 'horizontal']),
    st.lists(st.tuples(st.floats(0.0, 6e5), st.integers(1, 300)), min_size=1, max_size=6),
    st.floats(0.0, 6e5),
)
def test_no_rig_that_is_accepted_gives_nan(a, zeta, l0, mass, mount, commands, start):
    names = ('a1', 'a2', 'a3', 'a4', 'a5', 'a6')
    try:
        muscle = Muscle(**dict(zip(names, a, strict=True)), zeta=zeta, l0=l0)
        model = one_muscle(muscle, Mass(mass=mass, mount=mount))
    except ParameterError:
        return
    rig = Rig([model], longest_step(model))
    rig.reset([start], [rest(model, start)], [0.0])
    for p, steps in commands:
        rig.command(p)
        rig.advance(steps)
        assert np.all(np.isfinite(state(rig)))
        assert abs(rig.position[0]) < l0


@settings(deadline=None, max_examples=50)
@given(st.floats(0.0, 6e5), st.floats(0.0, 6e5), st.floats(0.01, 100.0), st.floats(0.03, 3.0))
def test_nor_does_one_without_damping_after_a_step(p0, p1, mass, l0):
    try:
        model = one_muscle(Muscle(zeta=0.0, l0=l0), Mass(mass=mass))
    except ParameterError:
        return
    rig = Rig([model], longest_step(model))
    rig.reset([p0], [rest(model, p0)], [0.0])
    rig.command(p1)
    rig.advance(2000)
    assert np.all(np.isfinite(state(rig)))
    assert abs(rig.position[0]) < l0
