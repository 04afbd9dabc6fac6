# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pulley and its arm: directions, inertia, gravity, what is refused."""

from math import pi, sin

import pytest

from pam_ros.errors import ParameterError
from pam_ros.rig import statics
from pam_ros.rig.joints.antagonistic_pair import JOINT, PulleyArm
from pam_ros.rig.model import GRAVITY
from support.joint_models import pair


def test_a_positive_angle_shortens_the_first_muscle_and_lengthens_the_second():
    model = pair(contraction_1=0.1, contraction_2=0.05)
    for i, expected in enumerate((0.1 + 0.03 * 0.2 / 0.4, 0.05 - 0.03 * 0.2 / 0.2)):
        assert statics.contraction(model, i, 0.2) == pytest.approx(expected)


def test_pressure_in_the_first_muscle_turns_it_to_positive_angles():
    model = pair()
    assert model.rest([4e5, 2e5]) > model.rest([3e5, 3e5]) > model.rest([2e5, 4e5])


def test_co_contraction_stiffens_it():
    """And moves it, for unequal muscles: less than a tenth of a radian here."""
    model = pair()
    soft, stiff = (statics.stiffness(model, p, model.rest(p)) for p in (2e5, 5e5))
    assert stiff > 1.5 * soft


@pytest.mark.parametrize('hanging_at', [0.0, -pi / 2.0, 2.0])
def test_gravity_pulls_towards_the_angle_at_which_it_hangs(hanging_at):
    model = pair(hanging_at=hanging_at)
    assert statics.weight(model, hanging_at) == pytest.approx(0.0, abs=1e-15)
    torque = 1.5 * GRAVITY * 0.2
    assert statics.weight(model, hanging_at + pi / 2.0) == pytest.approx(torque)
    assert statics.weight(model, 0.4) == pytest.approx(torque * sin(0.4 - hanging_at))
    assert statics.weight(pair(hanging_at=hanging_at, plane='horizontal'), 0.4) == 0.0


def test_the_load_adds_its_moment_of_inertia():
    assert pair().inertia == pytest.approx(0.01 + 1.5 * 0.2**2)
    assert pair(mass=0.0).inertia == 0.01
    assert pair(inertia=0.0).inertia == pytest.approx(1.5 * 0.2**2)
    assert JOINT.revolute


@pytest.mark.parametrize(
    ('fields', 'sentence'),
    [
        ({'radius': 0.0}, 'radius = 0.0 is not allowed: give above 0 and at most 1 m'),
        (
            {'plane': 'sloping'},
            "plane = 'sloping' is not allowed: give one of vertical, horizonta",
        ),
        (
            {'inertia': 0.0, 'mass': 0.0},
            'inertia = 0 kg m^2 and no mass on the arm leave nothing to move: give inertia above '
            '0, or mass and arm',
        ),
        ({'inertia': 0.0, 'arm': 0.0}, 'inertia = 0 kg m^2 and no mass on the arm leave nothing'),
    ],
)
def test_what_makes_no_pulley_is_refused_with_a_sentence(fields, sentence):
    with pytest.raises(ParameterError) as error:
        PulleyArm(**fields)
    assert str(error.value).startswith(sentence)
