# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What goes into each law: measurements that fail, and arguments that make no step."""

import re
from math import inf, nan

import numpy as np
import pytest

from pam_ros.control.pid import Pid
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.errors import ParameterError
from pam_ros.rig.standard_joints import single_muscle_joint
from support.joint_models import pair

DT = 2e-3
GOAL = Reference(0.06)
BEGIN = 0.055


EACH_LAW = pytest.mark.parametrize('law', [SlidingMode, Pid])
EACH_JOINT = pytest.mark.parametrize(
    'joint', [single_muscle_joint(), pair()], ids=['one muscle', 'pair']
)


def twins(law, joint):
    """Return two equal laws in the middle of a motion."""
    found = law(joint), law(joint)
    for one in found:
        one.start(BEGIN)
        for n in range(20):
            one.update(DT, GOAL, BEGIN + 1e-5 * n, 5e-3)
    return found


def goes_on_alike(law, twin):
    """Whether both command the same from now on, while the load moves."""
    measured = [BEGIN + 1e-5 * n for n in range(20, 60)]
    return all(law.update(DT, GOAL, s, 5e-3) == twin.update(DT, GOAL, s, 5e-3) for s in measured)


@EACH_LAW
@EACH_JOINT
@pytest.mark.parametrize('failed', [nan, inf, -inf])
def test_a_measurement_that_is_not_finite_is_none(law, joint, failed):
    one, twin = twins(law, joint)
    assert one.update(DT, GOAL, failed, failed) == twin.update(DT, GOAL, None)
    assert goes_on_alike(one, twin)


@EACH_LAW
@EACH_JOINT
@pytest.mark.parametrize(
    ('name', 'arguments'),
    [
        ('dt = 0.0', (0.0, GOAL, BEGIN)),
        ('dt = -0.002', (-DT, GOAL, BEGIN)),
        ('dt = nan', (nan, GOAL, BEGIN)),
        ('dt = inf', (inf, GOAL, BEGIN)),
        ('dt = 2', (2, GOAL, BEGIN)),  # ms
        ('reference = ', (DT, Reference(nan), BEGIN)),
        ('reference = ', (DT, Reference(0.06, inf), BEGIN)),
        ('age = nan', (DT, GOAL, BEGIN, None, nan)),
        ('age = 4', (DT, GOAL, BEGIN, None, 4)),  # ms
        ('age = -4 is not allowed: give a time in s, -1 to 1 s', (DT, GOAL, BEGIN, None, -4)),
        ("dt = '2'", ('2', GOAL, BEGIN)),
        ('reference = 0.06', (DT, 0.06, BEGIN)),
        ('reference = ', (DT, (0.06, 0.0, 0.0, 0.0), BEGIN)),
        ("reference.position = 'a'", (DT, Reference('a'), BEGIN)),
        ('reference.velocity = ', (DT, Reference(0.06, [0.0]), BEGIN)),
        ('position = ', (DT, GOAL, np.array([BEGIN, BEGIN]))),
        ("velocity = '0'", (DT, GOAL, BEGIN, '0')),
        ('age = ', (DT, GOAL, BEGIN, None, [0.0])),
    ],
)
def test_an_impossible_step_is_refused_and_changes_nothing(law, joint, name, arguments):
    one, twin = twins(law, joint)
    with pytest.raises(ParameterError, match=f'^{name}') as refused:
        one.update(*arguments)
    assert ' is not allowed: give ' in str(refused.value)
    assert goes_on_alike(one, twin)


@EACH_LAW
@EACH_JOINT
@pytest.mark.parametrize('position', [57.0, -57.0, 1e30])
def test_a_position_that_no_muscle_can_have_is_refused_and_changes_nothing(law, joint, position):
    """In mm or degrees, for example."""
    one, twin = twins(law, joint)
    for name, call in (
        ('position', lambda: one.update(DT, GOAL, position)),
        ('reference.position', lambda: one.update(DT, Reference(position), BEGIN)),
        ('position', lambda: one.start(position)),
    ):
        sentence = re.escape(f'{name} = {position:g} ')
        with pytest.raises(ParameterError, match=f'^{sentence}.* is not possible with'):
            call()
    assert goes_on_alike(one, twin)


@EACH_LAW
@EACH_JOINT
@pytest.mark.parametrize('side', [0, 1])
def test_a_goal_where_muscles_can_be_but_not_go_gives_a_limit_of_the_pressure(law, joint, side):
    one, _ = twins(law, joint)
    goal, muscle = joint.position_range[side], joint.muscles[0]
    assert not one.allocation.reach[0] <= goal <= one.allocation.reach[1]
    for n in range(500):
        pressures = one.update(DT, Reference(goal), BEGIN + 1e-6 * n)
        assert all(muscle.p_min <= p <= muscle.p_max for p in pressures)
    assert one.terms.saturated


@EACH_LAW
@EACH_JOINT
def test_an_impossible_start_is_refused_and_changes_nothing(law, joint):
    one, twin = twins(law, joint)
    muscles = len(one.terms.pressures)
    with pytest.raises(ParameterError, match=r'^position = nan is not allowed'):
        one.start(nan)
    with pytest.raises(ParameterError, match=r'^pressures\[0\] = nan is not allowed'):
        one.start(BEGIN, (nan,) * muscles)
    with pytest.raises(ParameterError, match=rf'^pressures has the shape \({muscles + 1},\)'):
        one.start(BEGIN, (1e5,) * (muscles + 1))
    assert goes_on_alike(one, twin)
