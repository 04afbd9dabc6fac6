# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of a joint's muscles in a problem: alike in all, or in one."""

import numpy as np
import pytest

from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.extend import with_effect, without_effect
from pam_ros.identification.fit.places import places_of
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.unknowns import MemoryStart, nominal_unknowns, run_unknowns
from pam_ros.identification.source_units import with_row
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.loads import Arm
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import antagonistic_joint

NAMES = ('flexor', 'extensor')
ELBOW = antagonistic_joint(load=Arm(mass=1.0))
PLACES = places_of(ELBOW, NAMES)
T = np.arange(0.0, 3.0, 0.01)
COMMAND = 1e3 * np.stack([250.0 + 90.0 * np.sin(4.0 * T), 260.0 - 70.0 * np.cos(3.0 * T)], axis=1)
LAG = {'fill': 0.06, 'vent': 0.09}


def run(joint):
    return simulate(joint, T, COMMAND, position=0.1).position


@pytest.fixture
def problem():
    recording = Recording('elbow', T, T, COMMAND, run(ELBOW), muscles=NAMES, unit='rad')
    segments = tuple(segments_of([recording]))
    unknowns = (*nominal_unknowns(ELBOW, NAMES), *run_unknowns(segments, 1e-4))
    row = ELBOW.parameters().ravel()
    return Problem(segments, ELBOW.layout, ELBOW.library, row, unknowns)


def at_start(problem, added):
    return np.concatenate([np.zeros(len(problem.unknowns)), added])


@pytest.mark.parametrize('name', ['pressure_lag', 'flexor.pressure_lag', 'extensor.pressure_lag'])
def test_an_effect_acts_where_its_place_is(problem, name):
    """The run of the problem is that of a joint that was configured with the effect."""
    place = PLACES[name]
    new, added = with_effect(problem, ELBOW, place, LAG)
    u = at_start(problem, added)
    model, _ = with_row(ELBOW, new.row_at(u), problem.segments, [place], {})
    has = [bool(actuator.effects) for actuator in model.actuators]
    assert has == [at.MUSCLE + i in place.rows for i in (0, 1)]
    u[[k.name for k in problem.unknowns].index('y0[0]')] = 0.0
    s = problem.segments[0]
    expected = simulate(model, T, COMMAND, position=s.y0, velocity=s.v0).position
    np.testing.assert_allclose(new.predict(u)[0], expected, atol=1e-9)
    assert np.max(np.abs(expected - run(ELBOW))) > 0.01
    less, keep = without_effect(new, ELBOW, place)
    assert less.unknowns == problem.unknowns
    np.testing.assert_array_equal(less.row, problem.row)
    assert keep == list(range(len(problem.unknowns)))


def test_memories_begin_in_each_muscle_where_it_was(problem):
    new, added = with_effect(problem, ELBOW, PLACES['creep'], {'stiffness': 300.0, 'time': 2.0})
    memories = [k.of for k in new.unknowns if isinstance(k.of, MemoryStart)]
    assert {of.row for of in memories} == {at.MUSCLE, at.MUSCLE + 1}
    assert len(added) == 2 + len(memories)
    assert len({of.name for of in memories}) == len(memories)


def test_each_muscle_has_constants_of_its_own(problem):
    names = [k.name for k in problem.unknowns]
    u = np.zeros(len(names))
    u[names.index('extensor.a5')] = 1.0
    model, _ = with_row(ELBOW, problem.row_at(u), problem.segments, [], {})
    first, second = model.muscles
    assert first.a5 == pytest.approx(ELBOW.muscles[0].a5, rel=1e-12)
    assert second.a5 == pytest.approx(1.03 * ELBOW.muscles[1].a5, rel=1e-6)
