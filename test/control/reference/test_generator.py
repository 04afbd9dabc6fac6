# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""References for programs: targets within bounds, trajectories exactly, and refused input."""

import numpy as np
import pytest

from pam_ros import (
    Arm,
    Limits,
    Mass,
    Muscle,
    PamError,
    ReferenceGenerator,
    Shape,
    SlidingMode,
    antagonistic_joint,
    single_muscle_joint,
)

DT = 2e-3
LIFT = single_muscle_joint(Muscle(), Mass(20.0))
ELBOW = antagonistic_joint(Muscle(), radius=0.04, load=Arm(1.0, 0.25), contraction=0.1)


def generator(joint=LIFT, **shape):
    made = ReferenceGenerator(joint, Shape.for_joint(joint, **shape))
    made.start(0.03)
    return made


def path(reference, seconds):
    """Return rows of position, velocity, acceleration and jerk."""
    return np.array([reference.update(DT) for _ in range(round(seconds / DT))])


@pytest.mark.parametrize('joint', [LIFT, ELBOW])
@pytest.mark.parametrize('before', [0.0, 1.0])
def test_a_target_is_approached_within_the_bounds(joint, before):
    reference = generator(joint, max_velocity=0.05, max_acceleration=0.3, max_jerk=5.0)
    path(reference, before)
    reference.set_target(0.08)
    rows = path(reference, 3.0)
    for column, bound in ((1, 0.05), (2, 0.3), (3, 5.0)):
        assert 0.99 * bound < np.max(np.abs(rows[:, column])) <= bound * (1.0 + 1e-9)
    np.testing.assert_allclose(np.diff(rows[:, 0]), DT * rows[1:, 1], atol=DT**2 * 0.3)
    assert rows[-1].tolist() == [0.08, 0.0, 0.0, 0.0]


def test_it_begins_in_the_middle_of_the_reach_of_the_law():
    for joint in (LIFT, ELBOW):
        reference = ReferenceGenerator(joint)
        assert reference.reach == SlidingMode(joint).allocation.reach
        assert reference.update(DT).position == pytest.approx(np.mean(reference.reach))


def test_limits_of_pressure_reduce_the_reach():
    limits = Limits(pressure_high=300e3)
    assert ReferenceGenerator(LIFT, limits=limits).reach[1] < ReferenceGenerator(LIFT).reach[1]


def test_a_trajectory_with_derivatives_is_followed_exactly():
    reference = generator()
    t = np.linspace(0.0, 1.0, 11)
    w = 2.0 * np.pi
    reference.set_trajectory(
        t,
        0.03 + 0.01 * (1.0 - np.cos(w * t)),
        0.01 * w * np.sin(w * t),
        0.01 * w * w * np.cos(w * t),
    )
    rows = path(reference, 1.0)[99:-1]  # from 0.2 s on the first acceleration is reached
    now = DT * (1.0 + np.arange(99, 99 + len(rows)))
    np.testing.assert_allclose(rows[:, 0], 0.03 + 0.01 * (1.0 - np.cos(w * now)), atol=1e-6)
    np.testing.assert_allclose(rows[:, 1], 0.01 * w * np.sin(w * now), atol=2e-5)


def test_positions_alone_are_a_spline_that_rests_at_the_end():
    reference = generator()
    reference.set_trajectory([0.5, 1.0], [0.08, 0.05])
    rows = path(reference, 1.5)
    assert rows[249, 0] == pytest.approx(0.08)
    assert rows[-1] == pytest.approx([0.05, 0.0, 0.0, 0.0])


def test_what_is_refused_leaves_the_former_target():
    reference = generator()
    reference.set_target(0.06)
    for name, arguments, said in (
        ('set_target', [1.0], 'reference 1 m is out of reach'),
        ('set_target', [float('nan')], 'position = nan is not allowed'),
        ('set_target', ['far'], "position = 'far' is not allowed"),
        ('start', [None], 'position = None is not allowed'),
        ('start', [30.0], 'position = 30 m is not possible with a muscle of 0.4 m'),  # mm
        ('start', [3.0], 'position = 3 m is not possible with a muscle of 0.4 m'),
        ('update', [0.0], 'dt = 0.0 is not allowed'),
        ('set_trajectory', [[1.0, 1.0], [0.05, 0.06]], 'no two of them equal'),
        ('set_trajectory', [[1.0], [0.05, 0.06]], 'position has the shape'),
        ('set_trajectory', [[1.0], [1.0]], 'position 1 m of point 0 of the trajectory is out of'),
        ('set_trajectory', [[1.0, 1.2], [0.09, 0.05]], 'between its start and point 0, is out of'),
        ('set_trajectory', [[-1.0], [0.05]], 'times must begin at 0 or later'),
        ('set_trajectory', [[1.0], [0.05], None, [0.0]], 'velocity = None is not allowed'),
    ):
        with pytest.raises(PamError, match=said):
            getattr(reference, name)(*arguments)
    assert path(reference, 3.0)[-1, 0] == 0.06


def test_parts_of_another_kind_are_refused():
    for arguments, said in (
        (('elbow',), 'give a Joint'),
        ((ELBOW, Shape()), 'make it with Shape.for_joint'),
        ((LIFT, 0.1), 'give a Shape'),
        ((LIFT, None, 5e5), 'give Limits'),
    ):
        with pytest.raises(PamError, match=said):
            ReferenceGenerator(*arguments)


@pytest.mark.parametrize('joint', [LIFT, ELBOW])
def test_it_begins_wherever_a_law_begins(joint):
    low, high = ReferenceGenerator(joint).reach
    for position in (low - 0.02, high + 0.02):
        reference, law = ReferenceGenerator(joint), SlidingMode(joint)
        reference.start(position)
        law.start(position)
        assert reference.update(DT).position == law.terms.position == position
    for start in (ReferenceGenerator(joint).start, SlidingMode(joint).start):
        with pytest.raises(PamError, match=r'position = 57 .* is not possible with'):
            start(57.0)
