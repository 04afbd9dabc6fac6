# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Loads: inertia, gravity and its slope, what is refused."""

from math import pi, sin

import numpy as np
import pytest

from pam_ros.effects import Payload
from pam_ros.errors import ParameterError
from pam_ros.rig import statics
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Joint
from pam_ros.rig.loads import GRAVITY, Arm, Mass
from support import joints, paper
from support.joint_models import BOTH_LONG, actuators, pair

EACH = pytest.mark.parametrize('load', [Mass(mass=12.0), Arm(hanging_at=0.3)], ids=['mass', 'arm'])


@EACH
def test_it_has_the_number_of_parameters_that_it_declares(load):
    assert len(load.numbers) == load.equations.numbers


@EACH
def test_the_slope_of_the_fall_is_that(load):
    q, h, m = np.array([9.0, *load.numbers]), 1e-6, 11.0
    equations = load.equations
    inertia = equations.inertia(m, q, 1)
    for s in (-0.3, 0.0, 0.7):
        above, below = (equations.fall(s + way, m, inertia, q, 1) for way in (h, -h))
        slope = equations.fall_slope(s, m, inertia, q, 1)
        assert slope == pytest.approx((above - below) / (2.0 * h), rel=1e-8, abs=1e-9)


def test_gravity_is_what_the_paper_takes():
    assert Mass().gravity == Arm().gravity == GRAVITY == paper.G


def test_a_mass_may_slide_without_gravity():
    muscles = actuators(BOTH_LONG, (0.0, 0.0))
    joint = Joint(muscles, Mass(mass=5.0, mount='horizontal'))
    assert statics.weight(joint, 0.01) == 0.0
    at_rest = equilibrium(joint, 3e5)
    assert joints.LONG.force(3.0, at_rest) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize('hanging_at', [0.0, -pi / 2.0, 2.0])
def test_gravity_pulls_towards_the_angle_at_which_it_hangs(hanging_at):
    joint = pair(hanging_at=hanging_at)
    assert statics.weight(joint, hanging_at) == pytest.approx(0.0, abs=1e-15)
    torque = 1.5 * GRAVITY * 0.2
    assert statics.weight(joint, hanging_at + pi / 2.0) == pytest.approx(torque)
    assert statics.weight(joint, 0.4) == pytest.approx(torque * sin(0.4 - hanging_at))
    assert statics.weight(pair(hanging_at=hanging_at, plane='horizontal'), 0.4) == 0.0


def test_the_mass_on_an_arm_adds_its_moment_of_inertia():
    assert pair().inertia == pytest.approx(0.01 + 1.5 * 0.2**2)
    assert pair(mass=0.0).inertia == 0.01
    assert pair(inertia=0.0).inertia == pytest.approx(1.5 * 0.2**2)


def test_a_payload_is_at_the_end_of_the_arm():
    joint = pair(load=[Payload(mass=0.5)])
    assert joint.inertia == pytest.approx(0.01 + 2.0 * 0.2**2)
    assert statics.weight(joint, 0.4) == pytest.approx(
        2.0 * GRAVITY * 0.2 * sin(0.4 - joints.HANGING_AT)
    )


@pytest.mark.parametrize(
    ('load', 'fields', 'sentence'),
    [
        (Mass, {'mass': 0.0}, 'mass = 0.0 is not allowed: give above 0 and at most 10000 kg'),
        (
            Mass,
            {'mount': 'tilted'},
            "mount = 'tilted' is not allowed: give one of vertical, horizontal",
        ),
        (
            Arm,
            {'plane': 'sloping'},
            "plane = 'sloping' is not allowed: give one of vertical, horizontal",
        ),
        (
            Arm,
            {'inertia': 0.0, 'mass': 0.0},
            'inertia = 0 kg m^2 and no mass on the arm leave nothing to move: give inertia above '
            '0, or mass and arm',
        ),
        (
            Arm,
            {'inertia': 0.0, 'arm': 0.0},
            'inertia = 0 kg m^2 and no mass on the arm leave nothing to move: give inertia above '
            '0, or mass and arm',
        ),
    ],
)
def test_what_makes_no_load_is_refused_with_a_sentence(load, fields, sentence):
    with pytest.raises(ParameterError) as error:
        load(**fields)
    assert str(error.value) == sentence
