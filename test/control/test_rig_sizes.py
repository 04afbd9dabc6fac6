# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One rig in many sizes: the law learns what it lacks, and follows as well in each of them."""

from dataclasses import replace
from functools import cache
from math import pi, radians, sin

import numpy as np
import pytest

from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import CoulombFriction, Payload
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.transmissions import Pulley, Straight
from support.joint_loop import close_joint
from support.scaled import scaled_muscle

MUSCLE = Muscle(zeta=0.15)


def single(force, pressure, length):
    """Return 20 kg that hang on a muscle."""
    return Joint(
        (Actuator(scaled_muscle(MUSCLE, force, pressure, length)),),
        Mass(mass=20.0 * force),
        Straight(),
    )


def pair(force, pressure, length):
    """Return an arm whose torques are in proportion to those of its muscles, and so its speed."""
    torque = force * length
    actuator = Actuator(scaled_muscle(MUSCLE, force, pressure, length), contraction=0.1)
    load = Arm(inertia=0.02 * torque, mass=torque)
    return Joint((actuator, actuator), load, Pulley(radius=0.04 * length))


@cache
def followed(make, force, pressure, length):
    """Return the error of a sine in the last 4 s, mm or mrad, and what was learned, in 1.

    The plant has friction and a payload that are not configured, in proportion to the muscles.
    """
    nominal = make(force, pressure, length)
    effort = force * length if nominal.is_revolute else force
    level, mass = (0.6, 0.2) if nominal.is_revolute else (15.0, 5.0)
    friction = CoulombFriction(level=level * effort, breakaway=1.2 * level * effort)
    plant = replace(nominal, effects=(friction, Payload(mass=mass * effort)))
    law = SlidingMode(nominal)
    middle = 0.5 * sum(law.allocation.reach)
    swing, noise = (radians(15.0), 3e-4) if nominal.is_revolute else (0.01, 20e-6)

    def target(t):
        return middle + swing * sin(pi * t)

    run = close_joint(law, plant, target, 8.0, begin=middle, noise=noise)
    late = run.last(4.0)
    wanted = np.array([target(t) for t in run.t[late]])
    error = 1e3 * np.sqrt(np.mean((wanted - run.coordinate[late]) ** 2))
    learned = law.learned
    return error, learned.friction / effort, learned.missing / effort, learned.weight


@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('make', 'force', 'pressure', 'length'),
    [
        (single, 0.001, 1.0, 1.0),
        (single, 0.03, 1.0, 1.0),
        (single, 0.1, 0.013, 1.0),
        (single, 10.0, 8.0, 1.0),
        (single, 50.0, 1.0, 1.0),
        (single, 1.0, 0.013, 1.0),
        (pair, 0.01, 8.0, 1.0),
        (pair, 0.03, 0.1, 0.2),
        (pair, 1.0, 1.0, 0.1),
        (pair, 20.0, 1.0, 10.0),
        (pair, 10.0, 5.0, 5.0),
    ],
)
def test_a_rig_of_any_size_is_controlled_as_well(make, force, pressure, length):
    error, *learned = followed(make, force, pressure, length)
    reference, *expected = followed(make, 1.0, 1.0, 1.0)
    assert error < 1.05 * reference
    assert learned == pytest.approx(expected, rel=0.1)
    assert learned[-1] > 0.9
