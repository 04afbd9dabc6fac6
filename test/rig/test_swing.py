# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How short a joint's steps must be: against falls stepped by hand, and random joints."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint_model import Actuator, JointModel
from pam_ros.rig.joints.antagonistic_pair import PulleyArm
from pam_ros.rig.joints.parallel import ParallelLoad
from pam_ros.rig.rig import Rig
from support import joints, paper
from support.joint_models import BOTH_LONG, UNEQUAL, pair, parallel


def stiffest(p, angle, pulls_only):
    """Let the pair go at an angle; return its greatest stiffness until it turns."""
    rate, h, k = 0.0, 1e-4, 0.0
    start = np.sign(joints.torque(p, angle, UNEQUAL) - joints.gravity(angle))
    while start * rate >= 0.0:
        y = joints.ends(angle, UNEQUAL)
        forces = [s.force(*each) for s, *each in zip(UNEQUAL, p, y, strict=True)]
        if pulls_only:
            forces = [max(f, 0.0) for f in forces]
        tau = joints.R * (forces[0] - forces[1]) - joints.gravity(angle)
        rate += h * tau / joints.J
        angle += h * rate
        most = [s.stiffness(6.0, each) for s, each in zip(UNEQUAL, y, strict=True)]
        k = max(k, joints.R**2 * sum(most))
    return k


def test_the_longest_step_is_a_radian_of_the_stiffest_place_that_is_reached():
    """Let go at either end of the travel, at any extreme of the pressures, with slack or not."""
    model = pair()
    ends = model.travel
    k = max(
        stiffest((p1, p2), angle, pulls_only)
        for angle in ends
        for p1 in (0.0, 6.0)
        for p2 in (0.0, 6.0)
        for pulls_only in (False, True)
    )
    # A joint may also be let go where it has most energy, between the ends: no less than this.
    expected = np.sqrt(joints.J / k)
    assert model.longest_step <= 1.01 * expected
    assert model.longest_step > 0.7 * expected


def test_drag_shortens_the_step():
    """J s'' = -c s' - K s: the fast root is c/2J + sqrt((c/2J)^2 - K/J)."""
    free = pair().longest_step
    decay = 0.5 * 30.0 / joints.J + joints.ZETA / free
    expected = decay + np.sqrt(decay**2 - 1.0 / free**2)
    slow = pair(load={'viscous_friction': {'coefficient': 30.0}})
    assert slow.longest_step == pytest.approx(1.0 / expected)
    by_pressure = {'pressure_dependent_damping': {'inflating': 0.08, 'deflating': 0.01}}
    decay = 0.5 * 0.08 * 6e5 * joints.R**2 / joints.J + joints.ZETA / free
    expected = decay + np.sqrt(decay**2 - 1.0 / free**2)
    assert pair(effects=(by_pressure, {})).longest_step == pytest.approx(1.0 / expected)


def test_two_equal_muscles_need_the_step_of_one_with_half_the_mass():
    """Nearly: the energy of the fall is the same, the place that it is let go from is."""
    from pam_ros.rig.model import Load, RigModel

    one = RigModel(load=Load(mass=15.0)).longest_step
    assert parallel(30.0, BOTH_LONG).longest_step == pytest.approx(one, rel=0.15)


commands = st.lists(
    st.tuples(st.floats(0.0, 6e5), st.floats(0.0, 6e5), st.integers(1, 300)),
    min_size=1,
    max_size=5,
)


@settings(deadline=None, max_examples=100)
@given(
    st.floats(0.01, 0.1),
    st.floats(1e-3, 1.0),
    st.floats(0.0, 5.0),
    st.floats(0.0, 0.5),
    st.floats(-3.0, 3.0),
    st.floats(0.05, 0.2),
    st.floats(0.1, 2.0),
    commands,
)
def test_no_pair_that_is_accepted_gives_nan(
    radius, inertia, mass, arm, hanging_at, contraction, zeta, commanded
):
    load = PulleyArm(
        radius=radius,
        inertia=inertia,
        mass=mass,
        arm=arm,
        hanging_at=hanging_at,
        contraction_1=contraction,
        contraction_2=contraction,
    )
    drive(load, zeta, commanded)


@settings(deadline=None, max_examples=50)
@given(st.floats(0.05, 200.0), st.floats(0.1, 2.0), commands)
def test_nor_does_a_mass_on_two_muscles(mass, zeta, commanded):
    drive(ParallelLoad(mass=mass), zeta, commanded)


def drive(load, zeta, commanded):
    try:
        model = JointModel(load, (Actuator(Muscle(zeta=zeta)), Actuator(Muscle(zeta=zeta))))
    except ParameterError:
        return
    rig = Rig([model], model.longest_step)
    for *p, steps in commanded:
        rig.command(p)
        rig.advance(steps)
        assert np.all(np.isfinite(rig.position))
        assert np.all(np.isfinite(rig.outputs()))
        assert np.all(np.abs(rig.contraction) < 1.0)


def test_gravity_is_what_the_paper_takes():
    assert pair().load.gravity == paper.G
