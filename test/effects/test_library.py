# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What all effects share: absent they change nothing, and any of them work together."""

import re
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from pam_ros import effects as effects_room
from pam_ros.compiled import HAVE_NUMBA
from pam_ros.effects import EFFECTS, EndStop, Payload
from pam_ros.effects.base import PLACES, Compensation
from pam_ros.rig.bind import bind
from pam_ros.rig.changes import acting_commands
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.layout import delays_of
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.start import start_state
from pam_ros.rig.step_limit import longest_step
from support import bench

NAMES = [effect.name for effect in EFFECTS]
T = np.linspace(0.0, 2.0, 201)
AT = np.array([0.0, 0.1, 0.6, 1.1003, 1.5])
U = np.array([2e5, 3.3e5, 1.6e5, 2.6e5, 2.0e5])
STARTS = [(e, start) for e in EFFECTS for start in e.fit_starts()]
# Every other effect: kernels in which an effect lacks the neighbours that it has in the library.
HALVES = (EFFECTS[::2], EFFECTS[1::2])
BY_EFFECT = pytest.mark.parametrize('effect', EFFECTS, ids=lambda e: e.name)


def free(effects, step=1e-3):
    return simulate(bench.hanging(*effects), T, U, AT, step=step)


def held(effects, step=1e-3):
    p = np.interp(T, AT, U)
    y = 0.03 + 0.02 * np.sin(3.0 * T)
    return simulate_held(bench.hanging(*effects), T, p, y, step=step)


def run_bound(active, effects, step=1e-3, mass=bench.MASS):
    """Run the free rig on the kernel into which only *active* are bound."""
    joint = bench.hanging(*effects, mass=mass)
    layout, q = joint.layout, joint.parameters()
    x = start_state(layout, q, U[:1], equilibrium(joint, U[0]), 0.0)
    out = np.empty((T.size, layout.run_columns))
    acts = [AT + delay for delay in delays_of(layout, q)]
    at, u = acting_commands(acts, U[:, None])
    bind(layout, active).simulate(x, layout.scratch(), q, T, at, u, step, out, True)
    return out


def test_every_file_of_an_effect_is_in_the_library_once():
    """A file of its own has one dataclass; both are named as the effect is."""
    files = {
        path.stem
        for path in Path(effects_room.__file__).parent.glob('*.py')
        if re.search(r'^class \w+\(Effect\):', path.read_text(encoding='utf-8'), re.MULTILINE)
    }
    assert files == set(NAMES)
    assert len(EFFECTS) == len(files)
    for effect in EFFECTS:
        assert effect.__module__ == f'{effects_room.__name__}.{effect.name}'
        assert effect.__name__ == effect.name.title().replace('_', '')
        assert getattr(effects_room, effect.__name__) is effect


@BY_EFFECT
def test_rows_are_named_by_the_fields(effect):
    """The equations read q[j + LEVEL], where level is the field."""
    names = vars(import_module(effect.__module__))
    assert [names[p.name.upper()] for p in effect.parameters()] == [
        *range(len(effect.parameters()))
    ]


@BY_EFFECT
def test_effect_declares_everything_that_is_required(effect):
    for text in (effect.text, effect.source, effect.signature, effect.experiment):
        assert len(text) > 10
    assert set(effect.rivals) <= set(NAMES) - {effect.name}
    assert set(effect.contains) <= set(NAMES) - {effect.name}
    own = {p.name for p in effect.parameters()}
    for simple, names in effect.contains.items():
        of_simple = {p.name for p in EFFECTS[NAMES.index(simple)].parameters()}
        assert set(names) <= of_simple
        assert set(names.values()) <= own
    assert effect.fit_starts()
    for start in effect.fit_starts():
        assert effect(**start).is_present
    assert effect.example().is_present
    assert not effect().is_present
    for p in effect.parameters():
        assert p.text
        assert p.low <= p.default <= p.high
        assert 0.0 < p.scale < p.high
        assert p.sign in (-1, 0, 1)
        if p.strength:
            assert p.default == 0.0
    assert (effect.equations.start is not None) == bool(effect.states)
    if effect.equations.start is not None:
        assert len(effect.equations.start(np.ones(50), 8, 2e5, 0.1, 0.04)) == len(effect.states)
    assert len({state.name for state in effect.states}) == len(effect.states)


# What is left to the feedback needs nothing.
COMPENSATED = [
    effect
    for effect in EFFECTS
    if effect.compensation is not Compensation.FEEDBACK or effect.equations.chamber is not None
]


@pytest.mark.parametrize('effect', COMPENSATED, ids=lambda effect: effect.name)
def test_the_compensation_that_an_effect_names_is_one_that_the_controller_has(effect):
    """It inverts what has no memory, or a lag; it feeds forward what acts on forces."""
    by_pressure = effect.equations.delay is not None or effect.equations.pressure is not None
    if effect.compensation is Compensation.PATH:
        assert by_pressure
        assert effect.equations.chamber is not None or not effect.states
    elif effect.compensation is Compensation.MODEL:
        assert not effect.states
        assert effect.equations.pressure is None
    elif effect.compensation is Compensation.FEED_FORWARD:
        assert effect.equations.force is not None or effect.equations.outside is not None
    if effect.equations.chamber is not None:
        layout = single_muscle_joint().layout
        q = single_muscle_joint(effects=[effect.example()]).parameters()[1]
        fill, vent, zone = effect.equations.chamber(q, layout.parameter_at[effect.name])
        assert min(fill, vent) > 0.0
        assert zone >= 0.0


@pytest.mark.slow
@pytest.mark.parametrize('active', [EFFECTS, *HALVES], ids=['all', 'even', 'odd'])
def test_absent_effects_are_absent_to_the_bit(active):
    np.testing.assert_array_equal(run_bound(active, ()), run_bound((), ()))


@BY_EFFECT
def test_effect_alone_is_the_same_in_either_kernel(effect):
    """In the one that has all effects, and in that which has every other of them."""
    effects = [effect.example()]
    half = next(half for half in HALVES if effect in half)
    among_half, among_all = run_bound(half, effects), run_bound(EFFECTS, effects)
    np.testing.assert_allclose(among_half, among_all, rtol=1e-12, atol=1e-12)
    assert np.max(np.abs(among_half - run_bound((), ()))[:, 0]) > 1e-5


@pytest.mark.needs_numba
@BY_EFFECT
def test_rig_at_rest_stays_at_rest(effect):
    if effect.moves_by_itself:
        pytest.skip('with it a load never rests')
    model = bench.hanging(effect.example())
    end = simulate(model, [0.0, 30.0], [3e5], [0.0])
    again = simulate(model, [0.0, 5.0], [3e5], [0.0], position=end.position[1])
    assert abs(again.position[1] - again.position[0]) < 1e-7
    assert abs(again.velocity[1]) < 1e-7


@pytest.mark.needs_numba
@BY_EFFECT
def test_only_what_moves_by_itself_keeps_a_load_moving(effect):
    end = simulate(
        bench.hanging(effect.example()), [0.0, *np.linspace(30.0, 31.0, 101)], [3e5], [0.0]
    )
    moving = np.ptp(end.position[1:])
    assert bool(moving > 1e-5) is effect.moves_by_itself


@pytest.mark.needs_numba
@BY_EFFECT
def test_answer_converges_as_the_step_shrinks(effect):
    effects = [effect.example()]
    exact = free(effects, 1e-3 / 32).position
    coarse, usual, fine = (
        np.abs(free(effects, h).position - exact).max() for h in (4e-3, 1e-3, 2.5e-4)
    )
    assert coarse < 1e-4
    assert usual < 2e-5
    assert fine < 0.5 * coarse or coarse < 1e-7


@BY_EFFECT
def test_held_answer_converges_as_the_step_shrinks(effect):
    effects = [effect.example()]
    exact = held(effects, 1e-3 / 16)
    errors = [np.abs(held(effects, h).force - exact.force).max() for h in (1e-2, 1e-3)]
    assert errors[1] < 3.0
    assert errors[1] < 0.5 * errors[0] or errors[0] < 1e-6


@pytest.mark.parametrize(('effect', 'start'), STARTS, ids=lambda a: getattr(a, 'name', ''))
@pytest.mark.parametrize('step', [1e-3, 1e-2])
def test_start_of_a_fit_simulates(effect, start, step):
    effects = [effect(**start)]
    out = run_bound(EFFECTS, effects, step, mass=20.0)
    assert np.all(np.isfinite(out))
    assert np.all(np.abs(out[:, 0]) < 0.5 * bench.L0)
    assert np.all(np.isfinite(held(effects, step).force))


@st.composite
def subsets(draw):
    """Draw any effects with any values that are allowed and that a rig may have."""
    chosen = draw(st.lists(st.sampled_from(EFFECTS), unique=True, min_size=1))
    effects = []
    for effect in chosen:
        if draw(st.booleans()):
            effects.append(effect(**draw(st.sampled_from(effect.fit_starts()))))
            continue
        values = {}
        usual = {p.name: p.default for p in effect.parameters()}
        bounds = effect.fit_bounds(
            usual, usual, bench.MASS, 60.0
        )  # what a joint may have together
        for p in effect.parameters():
            least, most = bounds.get(p.name, (p.low, p.high))
            low, high = (
                max(p.low, least, p.default - 20.0 * p.scale),
                min(p.high, most, p.default + 20.0 * p.scale),
            )
            values[p.name] = draw(st.floats(low, high))
        effects.append(effect(**values))
    return effects


LIGHT_BETWEEN_PADS = [
    Payload(mass=-8.0),
    EndStop(upper=1e-6, stiffness=450138.0, lower=0.0, lower_stiffness=293795.0, damping=42.0),
]


@pytest.mark.slow
@settings(max_examples=150 if HAVE_NUMBA else 15)
@given(effects=subsets())
@example(effects=LIGHT_BETWEEN_PADS)
def test_any_subset_works_together(effects):
    assume(longest_step(bench.hanging(*effects)) >= 1e-3)
    first, second = free(effects), free(effects)
    for a, b in zip(vars(first).values(), vars(second).values(), strict=True):
        np.testing.assert_array_equal(a, b)
        assert np.all(np.isfinite(a))
    assert np.all(np.abs(first.velocity) < 1e3)
    cell = held(effects)
    assert np.all(np.isfinite(cell.force))


@settings(max_examples=30 if HAVE_NUMBA else 10)
@given(effects=subsets())
def test_those_left_out_change_nothing(effects):
    found = {type(effect): effect for effect in effects}
    active = tuple(e for e in EFFECTS if e in found and found[e].is_present)
    spelled = [found.get(e, e()) for e in EFFECTS]
    model, bare = bench.hanging(*spelled), bench.hanging(*effects)
    assume(longest_step(bare) >= 1e-3)
    assert model.all_present == bare.all_present == active
    np.testing.assert_array_equal(
        simulate(model, T, U, AT).position, simulate(bare, T, U, AT).position
    )


@pytest.mark.parametrize('name', ['hysteresis', 'viscous_friction', 'coulomb_friction'])
def test_dissipation_never_adds_to_the_energy(name):
    # At constant pressure the muscle is a spring: kinetic and potential energy only fall,
    # but for what a hidden spring lends and returns.
    (effect,) = (effect for effect in EFFECTS if effect.name == name)
    model = bench.hanging(effect.example())
    p, y0 = 3e5, bench.rest(3e5) + 0.025
    t = np.linspace(0.0, 4.0, 4001)
    run = simulate(model, t, [p], [0.0], position=y0)
    grid = np.linspace(run.position.min() - 1e-3, run.position.max() + 1e-3, 20001)
    net = np.array([bench.pull(p, y) for y in grid]) - bench.MASS * bench.G
    work = np.concatenate([[0.0], np.cumsum(0.5 * (net[1:] + net[:-1]) * np.diff(grid))])
    energy = 0.5 * bench.MASS * run.velocity**2 - np.interp(run.position, grid, work)
    turns = np.flatnonzero(np.diff(np.sign(run.velocity)) != 0)
    assert turns.size > 3
    assert np.all(energy[turns][2:] - energy[turns][:-2] < 1e-6)
    assert energy[-1] < 0.1 * energy[0]


def test_every_place_of_the_kernel_is_taken():
    assert {place for effect in EFFECTS for place in effect.equations.places} == set(PLACES)
