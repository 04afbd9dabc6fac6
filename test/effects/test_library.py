# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What all effects share: absent they change nothing, and any of them work together."""

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from pam_ros.rig.model import start_row

from pam_ros.effects import EFFECTS
from pam_ros.effects.base import PLACES
from pam_ros.rig.bind import bind
from pam_ros.rig.layout import layout_of
from pam_ros.rig.run import simulate, simulate_held
from support import bench

NAMES = {
    'slack',
    'hysteresis',
    'coulomb_friction',
    'viscous_friction',
    'creep',
    'softening',
    'pressure_lag',
    'dead_time',
    'pressure_offset',
    'payload',
    'pressure_dependent_damping',
    'end_stop',
    'leak',
    'periodic_disturbance',
    'length_offset',
}
# Each clearly there, on the rig of ``bench.hanging`` between 150 and 350 kPa.
CLEAR = {
    'dead_time': {'delay': 0.0153},
    'pressure_offset': {'offset': 6e3, 'gain': -0.03},
    'pressure_lag': {'fill': 0.05, 'vent': 0.09},
    'leak': {'rate': 0.1},
    'length_offset': {'offset': 0.015},
    'softening': {'limit': 0.06, 'per_pressure': 5e-7, 'per_second': 0.05},
    'creep': {'force': -0.03, 'stiffness': 600.0, 'time': 0.8, 'spread': 2.0},
    'hysteresis': {'amplitude': 9.0, 'slip': 5.0, 'pressure': 4e3},
    'slack': {'share': 1.0, 'toe': 20.0},
    'pressure_dependent_damping': {'inflating': 3e-4, 'deflating': 1e-4},
    'periodic_disturbance': {'force_sin': 3.0, 'pressure_cos': 2e3, 'frequency': 2.3},
    'payload': {'mass': 1.5},
    'viscous_friction': {'coefficient': 30.0},
    'coulomb_friction': {'level': 4.0, 'breakaway': 5.0},
    'end_stop': {'upper': 0.2, 'stiffness': 3e4},
}
T = np.linspace(0.0, 2.0, 201)
AT = np.array([0.0, 0.1, 0.6, 1.1003, 1.5])
U = np.array([2e5, 3.3e5, 1.6e5, 2.6e5, 2.0e5])
STARTS = [(e, start) for e in EFFECTS for start in e.fit_starts]
BY_EFFECT = pytest.mark.parametrize('effect', EFFECTS, ids=lambda e: e.name)


def free(effects, step=1e-3):
    return simulate(bench.hanging(**effects), T, AT, U, step=step)


def held(effects, step=1e-3):
    p = np.interp(T, AT, U)
    y = 0.03 + 0.02 * np.sin(3.0 * T)
    return simulate_held(bench.hanging(**effects), T, p, y, step=step)


def run_bound(active, effects, step=1e-3, mass=bench.MASS):
    """Run the free rig on the kernel into which only *active* are bound."""
    model = bench.hanging(mass, **effects)
    q = model.row()
    x = start_row(model.layout, q, U[0], model.rest(U[0]), 0.0)
    out = np.empty((T.size, 4))
    kernel = bind(layout_of(EFFECTS), active)
    kernel.simulate(x, np.empty_like(x), q, T, AT, U, step, out, True)
    return out


def test_library_is_complete():
    assert {effect.name for effect in EFFECTS} == NAMES
    assert len(EFFECTS) == len(NAMES)
    assert set(CLEAR) == NAMES


@BY_EFFECT
def test_effect_says_all_that_is_asked_of_it(effect):
    for text in (effect.text, effect.source, effect.signature, effect.experiment):
        assert len(text) > 10
    assert set(effect.rivals) <= NAMES - {effect.name}
    assert effect.fit_starts
    for start in effect.fit_starts:
        effect.values(start)
        assert effect.is_present(start)
    assert not effect.is_present({})
    for p in effect.parameters:
        assert p.text
        assert p.low <= p.default <= p.high
        assert 0.0 < p.scale < p.high
        assert p.sign in (-1, 0, 1)
        if p.strength:
            assert p.default == 0.0
    assert (effect.start is not None) == bool(effect.states)


@BY_EFFECT
def test_absent_effect_is_absent_to_the_bit(effect):
    bare = run_bound((), {})
    np.testing.assert_array_equal(run_bound((effect,), {}), bare)


def test_all_absent_are_absent_to_the_bit():
    np.testing.assert_array_equal(run_bound(EFFECTS, {}), run_bound((), {}))


@BY_EFFECT
def test_effect_alone_is_the_same_in_either_kernel(effect):
    effects = {effect.name: CLEAR[effect.name]}
    alone, among_all = run_bound((effect,), effects), run_bound(EFFECTS, effects)
    np.testing.assert_allclose(alone, among_all, rtol=1e-12, atol=1e-12)
    assert np.max(np.abs(alone - run_bound((), {}))[:, 0]) > 1e-5


@pytest.mark.parametrize('name', sorted(NAMES - {'periodic_disturbance'}))
def test_rig_at_rest_stays_at_rest(name):
    # With the valve open, and softened by cycles: else there is no rest.
    rest = {'leak': {'refill': 0.2}, 'softening': {'per_second': 0.0}}
    model = bench.hanging(**{name: {**CLEAR[name], **rest.get(name, {})}})
    end = simulate(model, [0.0, 30.0], [0.0], [3e5])
    again = simulate(model, [0.0, 5.0], [0.0], [3e5], position=end.position[1])
    assert abs(again.position[1] - again.position[0]) < 1e-7
    assert abs(again.velocity[1]) < 1e-7


@pytest.mark.needs_numba
@BY_EFFECT
def test_answer_converges_as_the_step_shrinks(effect):
    effects = {effect.name: CLEAR[effect.name]}
    exact = free(effects, 1e-3 / 32).position
    coarse, usual, fine = (
        np.abs(free(effects, h).position - exact).max() for h in (4e-3, 1e-3, 2.5e-4)
    )
    assert coarse < 1e-4
    assert usual < 2e-5
    assert fine < 0.5 * coarse or coarse < 1e-7


@BY_EFFECT
def test_held_answer_converges_as_the_step_shrinks(effect):
    effects = {effect.name: CLEAR[effect.name]}
    exact = held(effects, 1e-3 / 16)
    errors = [np.abs(held(effects, h).force - exact.force).max() for h in (1e-2, 1e-3)]
    assert errors[1] < 3.0
    assert errors[1] < 0.5 * errors[0] or errors[0] < 1e-6


@pytest.mark.parametrize(('effect', 'start'), STARTS, ids=lambda a: getattr(a, 'name', ''))
@pytest.mark.parametrize('step', [1e-3, 1e-2])
def test_start_of_a_fit_simulates(effect, start, step):
    effects = {effect.name: start}
    out = run_bound(EFFECTS, effects, step, mass=20.0)
    assert np.all(np.isfinite(out))
    assert np.all(np.abs(out[:, 0]) < 0.5 * bench.L0)
    assert np.all(np.isfinite(held(effects, step).force))


@st.composite
def subsets(draw):
    """Draw any effects with any values that are allowed and that a rig may have."""
    chosen = draw(st.lists(st.sampled_from(EFFECTS), unique=True, min_size=1))
    effects = {}
    for effect in chosen:
        if draw(st.booleans()):
            effects[effect.name] = draw(st.sampled_from(effect.fit_starts))
            continue
        values = {}
        for p in effect.parameters:
            low, high = (
                max(p.low, p.default - 20.0 * p.scale),
                min(p.high, p.default + 20.0 * p.scale),
            )
            values[p.name] = draw(st.floats(low, high))
        effects[effect.name] = values
    return effects


LIGHT_BETWEEN_PADS = {
    'payload': {'mass': -8.0},
    'end_stop': {
        'upper': 0.0,
        'stiffness': 450138.0,
        'lower': 0.0,
        'lower_stiffness': 293795.0,
        'damping': 42.0,
    },
}


@settings(max_examples=150)
@given(effects=subsets())
@example(effects=LIGHT_BETWEEN_PADS)
def test_any_subset_works_together(effects):
    assume(bench.hanging(**effects).longest_step >= 1e-3)
    first, second = free(effects), free(effects)
    for a, b in zip(vars(first).values(), vars(second).values(), strict=True):
        np.testing.assert_array_equal(a, b)
        assert np.all(np.isfinite(a))
    assert np.all(np.abs(first.velocity) < 1e3)
    cell = held(effects)
    assert np.all(np.isfinite(cell.force))


@settings(max_examples=30)
@given(effects=subsets())
def test_those_left_out_change_nothing(effects):
    active = tuple(e for e in EFFECTS if e.is_present(effects.get(e.name, {})))
    spelled = {
        e.name: effects.get(e.name, {p.name: 0.0 for p in e.parameters if p.strength})
        for e in EFFECTS
    }
    model, bare = bench.hanging(**spelled), bench.hanging(**effects)
    assume(bare.longest_step >= 1e-3)
    assert model.present == bare.present == active
    np.testing.assert_array_equal(
        simulate(model, T, AT, U).position, simulate(bare, T, AT, U).position
    )


@pytest.mark.parametrize('name', ['hysteresis', 'viscous_friction', 'coulomb_friction'])
def test_dissipation_never_adds_to_the_energy(name):
    # At constant pressure the muscle is a spring: kinetic and potential energy only fall,
    # but for what a hidden spring lends and returns.
    values = dict(CLEAR[name])
    model = bench.hanging(**{name: values})
    p, y0 = 3e5, bench.rest(3e5) + 0.025
    t = np.linspace(0.0, 4.0, 4001)
    run = simulate(model, t, [0.0], [p], position=y0)
    grid = np.linspace(run.position.min() - 1e-3, run.position.max() + 1e-3, 20001)
    net = np.array([bench.pull(p, y) for y in grid]) - bench.MASS * bench.G
    work = np.concatenate([[0.0], np.cumsum(0.5 * (net[1:] + net[:-1]) * np.diff(grid))])
    energy = 0.5 * bench.MASS * run.velocity**2 - np.interp(run.position, grid, work)
    turns = np.flatnonzero(np.diff(np.sign(run.velocity)) != 0)
    assert turns.size > 3
    assert np.all(energy[turns][2:] - energy[turns][:-2] < 1e-6)
    assert energy[-1] < 0.1 * energy[0]


def test_every_place_of_the_kernel_is_taken():
    assert {place for e in EFFECTS for place in PLACES if getattr(e, place)} == set(PLACES)
