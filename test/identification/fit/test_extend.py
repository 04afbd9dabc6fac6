# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Problems grow and shrink by effects, and nothing else of them changes."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.extend import (
    belongs,
    bounded,
    finer_starts,
    hidden_start,
    in_common,
    plainer_sets,
    started,
    with_effect,
    with_parameters,
    without_effect,
)
from pam_ros.identification.fit.places import places_of
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.unknowns import MemoryStart, nominal_unknowns, run_unknowns
from pam_ros.identification.source_units import with_row
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.loads import Arm
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import antagonistic_joint
from support import bench_truth

MODEL = bench_truth.nominal()
SEGMENTS = tuple(segments_of([bench_truth.free(duration=2.5, programme='steps')]))
EFFECT = {effect.name: effect for effect in EFFECTS}
PLACES = places_of(MODEL)
START = {'stiffness': 500.0, 'time': 3.0}


@pytest.fixture
def problem():
    unknowns = (*nominal_unknowns(MODEL), *run_unknowns(SEGMENTS, 1e-5))
    return Problem(SEGMENTS, MODEL.layout, (), MODEL.parameters().ravel(), unknowns, 0.01)


def extended(problem, place, start, model=MODEL):
    """Return a problem with an effect more, and its u where that begins."""
    new, added = with_effect(problem, model, place, start)
    return new, np.concatenate([np.zeros(len(problem.unknowns)), added])


def test_an_effect_comes_with_its_parameters_and_where_its_memory_began(problem):
    new, u = extended(problem, PLACES['creep'], START)
    names = [one.name for one in new.unknowns[len(problem.unknowns) :]]
    assert names[:2] == ['effects.creep.stiffness', 'effects.creep.time']
    assert len(names) == u.size - len(problem.unknowns) == 2 + 6
    assert 'creep: slow contraction[0]' in names
    row = new.row_at(u)
    for k, p in enumerate(EFFECT['creep'].parameters()):
        expected = START.get(p.name, p.default)
        assert row[MODEL.layout.index(EFFECT['creep'], k)] == pytest.approx(expected)
    assert all(np.isfinite(one.prior) for one in new.unknowns[len(problem.unknowns) :])


def test_a_strength_of_zero_changes_nothing(problem):
    new, _ = with_effect(problem, MODEL, PLACES['viscous_friction'], {'coefficient': 50.0})
    u = np.zeros(len(problem.unknowns))
    same = new.residuals(np.append(u, 0.0))
    np.testing.assert_allclose(same, problem.residuals(u), atol=1e-12)
    assert np.ptp(new.residuals(np.append(u, 1.0)) - same) > 1e-6


def test_more_of_an_effect_leaves_what_it_has(problem):
    new, u = extended(problem, PLACES['creep'], START)
    wider, more = with_effect(new, MODEL, PLACES['creep'], {'spread': 4.0})
    assert [one.name for one in wider.unknowns[len(new.unknowns) :]] == ['effects.creep.spread']
    row, before = wider.row_at(np.append(u, more)), new.row_at(u)
    changed = np.flatnonzero(row != before)
    names = [p.name for p in EFFECT['creep'].parameters()]
    assert list(changed) == [MODEL.layout.index(EFFECT['creep'], names.index('spread'))]
    assert row[changed[0]] == pytest.approx(4.0)


@pytest.mark.parametrize('level', [20.0, 0.0])
def test_strengths_in_one_unit_begin_at_the_mean_that_one_alone_had(problem, level):
    place = PLACES['coulomb_friction']
    new, u = extended(problem, place, {'level': level})
    options = finer_starts(new.unknowns, new.row_at(u), MODEL, place)
    assert options[0] == {
        p.name: p.default for p in place.parameters if p.name != 'level'
    }  # all others, from where they are
    assert {'asymmetry': 0.0} in options
    both = [one for one in options[1:] if 'breakaway' in one]
    assert [one['stribeck_speed'] for one in both] == [0.01, 0.02]
    if level == 0.0:  # no ratio to keep
        assert [one['breakaway'] for one in both] == [8.0, 13.0]
        assert not any('level' in one for one in both)
        return
    for one, ratio in zip(both, (8.0 / 5.0, 13.0 / 10.0), strict=True):
        assert one['breakaway'] / one['level'] == pytest.approx(ratio)
        assert one['breakaway'] * one['level'] == pytest.approx(level**2)
    moved = started(new, u, place, both[0])
    changed = np.flatnonzero(moved != u)
    assert [new.unknowns[k].name for k in changed] == ['effects.coulomb_friction.level']
    wider, more = with_effect(new, MODEL, place, both[0])
    names = [one.name for one in wider.unknowns[len(new.unknowns) :]]
    assert names == [
        'effects.coulomb_friction.breakaway',
        'effects.coulomb_friction.stribeck_speed',
    ]
    row = wider.row_at(np.append(moved, more))
    for k, p in enumerate(place.parameters):
        expected = both[0].get(p.name, p.default)
        assert row[place.indices(MODEL.layout, k)[0]] == pytest.approx(expected)


def test_what_long_steps_hide_begins_with_its_typical_size(problem):
    place = PLACES['coulomb_friction']
    new, _ = with_effect(problem, MODEL, place, {'level': 20.0})
    (hidden,) = [p for p in place.parameters if p.needs_fine_steps]
    assert hidden_start(new.unknowns, place) == {'presliding': hidden.scale}
    wider, _ = with_effect(new, MODEL, place, {'presliding': 2e-5})
    assert hidden_start(wider.unknowns, place) == {}
    assert hidden_start(new.unknowns, PLACES['creep']) == {}


def test_an_effect_goes_with_all_that_is_its_own(problem):
    new, _ = with_effect(problem, MODEL, PLACES['pressure_lag'], {'fill': 0.1, 'vent': 0.1})
    both, _ = with_effect(new, MODEL, PLACES['creep'], START)
    less, keep = without_effect(both, MODEL, PLACES['creep'])
    assert less.unknowns == new.unknowns
    assert keep == list(range(len(new.unknowns)))
    np.testing.assert_array_equal(less.row, new.row)
    none, keep = without_effect(less, MODEL, PLACES['pressure_lag'])
    assert none.unknowns == problem.unknowns
    assert not any(belongs(one, 'pressure_lag') for one in none.unknowns)


def test_parameters_of_an_effect_go_back_to_their_defaults(problem):
    friction = EFFECT['coulomb_friction']
    start = {'level': 10.0, 'breakaway': 13.0, 'stribeck_speed': 0.02, 'asymmetry': 0.1}
    with_lag, _ = with_effect(problem, MODEL, PLACES['pressure_lag'], {'fill': 0.1, 'vent': 0.1})
    new, added = with_effect(with_lag, MODEL, PLACES['coulomb_friction'], start)
    sets = plainer_sets(new.unknowns, PLACES['coulomb_friction'])
    assert sets == [{'level'}, {'level', 'asymmetry'}, {'level', 'breakaway', 'stribeck_speed'}]
    assert plainer_sets(new.unknowns, PLACES['pressure_lag']) == []
    less, keep = with_parameters(new, MODEL, PLACES['coulomb_friction'], {'level', 'asymmetry'})
    gone = {one.name for one in new.unknowns} - {one.name for one in less.unknowns}
    assert gone == {
        'effects.coulomb_friction.breakaway',
        'effects.coulomb_friction.stribeck_speed',
    }
    u = np.concatenate([np.zeros(len(with_lag.unknowns)), added])
    row = less.row_at(u[keep])
    for k, p in enumerate(friction.parameters()):
        kept = p.name in ('level', 'asymmetry')
        expected = start[p.name] if kept else p.default
        assert row[MODEL.layout.index(friction, k)] == pytest.approx(expected)
    others = [k for k, one in enumerate(new.unknowns) if 'friction' not in one.name]
    assert set(others) <= set(keep)


STOPS = {'upper': 0.1, 'stiffness': 3e4, 'lower': 0.02, 'lower_stiffness': 3e4}


@pytest.mark.parametrize(
    ('effect', 'start'), [('payload', {'mass': -1.0}), ('end_stop', STOPS), ('creep', START)]
)
@pytest.mark.parametrize('end', [-1e9, 1e9])
def test_what_a_fit_ends_with_is_a_joint(problem, effect, start, end):
    """Also where each of its unknowns is at a bound, to the last digit."""
    place = PLACES[effect]
    new, u = extended(problem, place, start)
    now = bounded(new, u, MODEL, place)
    assert np.all(np.clip(u, *now.bounds) == u)
    own = len(problem.unknowns)
    u[own:] = np.clip(np.full(u.size, end), *now.bounds)[own:]
    row = now.row_at(u)
    found, _ = with_row(MODEL, row, SEGMENTS, [place], {})
    np.testing.assert_allclose(found.parameters().ravel(), row, rtol=1e-12)
    assert (now.unknowns != new.unknowns) is (effect != 'creep')


def test_a_disturbance_is_periodic_within_a_recording_and_its_runs_are_parts_of_it(problem):
    """Below, it would describe any slow error. The recording has 7.5 s in two runs."""
    (one,) = problem.segments
    later = replace(one, t=one.t + 5.0)
    other = replace(one, recording=1)
    runs = replace(problem, segments=(one, later, other))
    place = PLACES['periodic_disturbance']
    new, u = extended(runs, place, {'force_sin': 2.0, 'force_cos': 2.0, 'frequency': 1.0})
    (low,) = (k.low for k in bounded(new, u, MODEL, place).unknowns if 'frequency' in k.name)
    assert low == pytest.approx(3.0 / 7.5, rel=1e-2)


def test_what_a_broader_effect_has_in_common_with_a_simpler_one(problem):
    """Its unknown parameters alone, with their present values, by the names of the simpler one."""
    place = PLACES['leak']
    start = {'rate': 0.03, 'refill': 0.1}
    new, u = extended(problem, place, start)
    assert in_common(new, u, MODEL, place, 'pressure_lag') == pytest.approx({'fill': 0.1})
    more, last = with_effect(new, MODEL, place, {**start, 'vent': 0.05, 'supply': 1e6})
    both = np.concatenate([u, last])
    assert in_common(more, both, MODEL, place, 'pressure_lag') == pytest.approx(
        {'fill': 0.1, 'vent': 0.05, 'fastest': 1e6}
    )
    none, u = extended(problem, place, {'rate': 0.03})
    assert in_common(none, u, MODEL, place, 'pressure_lag') == {}


# Joints of two muscles ---------------------------------------------------------------------------


NAMES = ('flexor', 'extensor')
ELBOW = antagonistic_joint(load=Arm(mass=1.0))
PLACES_OF_PAIR = places_of(ELBOW, NAMES)
T = np.arange(0.0, 3.0, 0.01)
COMMAND = 1e3 * np.stack([250.0 + 90.0 * np.sin(4.0 * T), 260.0 - 70.0 * np.cos(3.0 * T)], axis=1)
LAG = {'fill': 0.06, 'vent': 0.09}


def run_of(joint):
    return simulate(joint, T, COMMAND, position=0.1).position


@pytest.fixture
def of_pair():
    recording = Recording('elbow', T, T, COMMAND, run_of(ELBOW), muscles=NAMES, unit='rad')
    segments = tuple(segments_of([recording]))
    unknowns = (*nominal_unknowns(ELBOW, NAMES), *run_unknowns(segments, 1e-4))
    row = ELBOW.parameters().ravel()
    return Problem(segments, ELBOW.layout, ELBOW.library, row, unknowns)


@pytest.mark.parametrize('name', ['pressure_lag', 'flexor.pressure_lag', 'extensor.pressure_lag'])
def test_an_effect_acts_where_its_place_is(of_pair, name):
    """The run of the problem is that of a joint that was configured with the effect."""
    place = PLACES_OF_PAIR[name]
    new, u = extended(of_pair, place, LAG, ELBOW)
    model, _ = with_row(ELBOW, new.row_at(u), of_pair.segments, [place], {})
    has = [bool(actuator.effects) for actuator in model.actuators]
    assert has == [at.MUSCLE + i in place.rows for i in (0, 1)]
    u[[k.name for k in of_pair.unknowns].index('y0[0]')] = 0.0
    s = of_pair.segments[0]
    expected = simulate(model, T, COMMAND, position=s.y0, velocity=s.v0).position
    np.testing.assert_allclose(new.predict(u)[0], expected, atol=1e-9)
    assert np.max(np.abs(expected - run_of(ELBOW))) > 0.01
    less, keep = without_effect(new, ELBOW, place)
    assert less.unknowns == of_pair.unknowns
    np.testing.assert_array_equal(less.row, of_pair.row)
    assert keep == list(range(len(of_pair.unknowns)))


def test_memories_begin_in_each_muscle_where_it_was(of_pair):
    new, added = with_effect(
        of_pair, ELBOW, PLACES_OF_PAIR['creep'], {'stiffness': 300.0, 'time': 2.0}
    )
    memories = [k.of for k in new.unknowns if isinstance(k.of, MemoryStart)]
    assert {of.row for of in memories} == {at.MUSCLE, at.MUSCLE + 1}
    assert len(added) == 2 + len(memories)
    assert len({of.name for of in memories}) == len(memories)


def test_each_muscle_has_constants_of_its_own(of_pair):
    names = [k.name for k in of_pair.unknowns]
    u = np.zeros(len(names))
    u[names.index('extensor.a5')] = 1.0
    model, _ = with_row(ELBOW, of_pair.row_at(u), of_pair.segments, [], {})
    first, second = model.muscles
    assert first.a5 == pytest.approx(ELBOW.muscles[0].a5, rel=1e-12)
    assert second.a5 == pytest.approx(1.03 * ELBOW.muscles[1].a5, rel=1e-6)
