# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Transmissions: functions that hang together, geometry written once more, units."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.rig import statics
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.transmissions import DEAD_CENTRE, Lever, Pulley, Straight
from support import joints
from support.joint_models import UNEQUAL, lever, pair, parallel

EACH = pytest.mark.parametrize(
    'transmission',
    [Straight(), Pulley(), Lever(), Lever(*joints.GEOMETRY), Lever(crank=0.3, anchor=0.3)],
    ids=['straight', 'pulley', 'lever', 'short lever', 'isosceles'],
)
PLACES = (-0.9, -0.3, 0.0, 0.4, 0.7)


def functions(transmission):
    """Return travel, arm, arm_slope and coordinate of (s, i), of rows with the numbers in front.

    They stand at some place in the row, not at its beginning.
    """
    q = np.array([-7.0, *transmission.numbers])
    equations = transmission.equations
    each = equations.travel, equations.arm, equations.arm_slope, equations.coordinate
    return [lambda s, i, f=f: f(s, i, q, 1) for f in each]


@EACH
def test_it_has_the_number_of_parameters_that_it_declares(transmission):
    assert len(transmission.numbers) == transmission.equations.numbers


@EACH
@pytest.mark.parametrize('i', [0, 1, 2])
def test_the_arm_is_the_slope_of_the_travel_and_never_nothing(transmission, i):
    travel, arm, _, _ = functions(transmission)
    h = 1e-6
    assert travel(0.0, i) == pytest.approx(0.0, abs=1e-16)
    for s in PLACES:
        slope = (travel(s + h, i) - travel(s - h, i)) / (2.0 * h)
        assert arm(s, i) == pytest.approx(slope, rel=1e-8)
        assert arm(s, i) != 0.0


@EACH
@pytest.mark.parametrize('i', [0, 1])
def test_the_slope_of_the_arm_is_that(transmission, i):
    _, arm, arm_slope, _ = functions(transmission)
    h = 1e-6
    for s in PLACES:
        slope = (arm(s + h, i) - arm(s - h, i)) / (2.0 * h)
        assert arm_slope(s, i) == pytest.approx(slope, rel=1e-7, abs=1e-10)


@EACH
@pytest.mark.parametrize('i', [0, 1])
def test_the_coordinate_is_the_inverse_of_the_travel(transmission, i):
    travel, _, _, coordinate = functions(transmission)
    for s in PLACES:
        assert coordinate(travel(s, i), i) == pytest.approx(s, abs=1e-12)


def test_units_of_what_turns_and_of_what_slides():
    assert (Pulley.equations.unit, Pulley.equations.effort_unit) == ('rad', 'N m')
    assert (Lever.equations.unit, Lever.equations.effort_unit) == ('rad', 'N m')
    assert (Straight.equations.unit, Straight.equations.effort_unit) == ('m', 'N')


# Straight and pulley ----------------------------------------------------------------------------


def test_position_0_is_where_the_muscles_have_their_stated_contractions():
    joint = parallel(50.0, offsets=(0.05, -0.02))
    for i, (offset, l0) in enumerate(((0.05, 0.4), (-0.02, 0.2))):
        assert statics.contraction(joint, i, 0.0) == pytest.approx(offset)
        assert statics.contraction(joint, i, 0.03) == pytest.approx(offset + 0.03 / l0)


def test_a_positive_angle_shortens_the_first_muscle_and_lengthens_the_second():
    joint = pair(contraction_1=0.1, contraction_2=0.05)
    for i, expected in enumerate((0.1 + 0.03 * 0.2 / 0.4, 0.05 - 0.03 * 0.2 / 0.2)):
        assert statics.contraction(joint, i, 0.2) == pytest.approx(expected)


def test_pressure_in_the_first_muscle_turns_it_to_positive_angles():
    for joint in (pair(), lever()):
        p = [4e5, 2e5], [3e5, 3e5], [2e5, 4e5]
        assert equilibrium(joint, p[0]) > equilibrium(joint, p[1]) > equilibrium(joint, p[2])


def test_co_contraction_stiffens_it():
    """And moves it, for unequal muscles: less than a tenth of a radian here."""
    for joint in (pair(), lever()):
        soft, stiff = (statics.stiffness(joint, p, equilibrium(joint, p)) for p in (2e5, 5e5))
        assert stiff > 1.5 * soft


# Lever ----------------------------------------------------------------------------------------


@pytest.mark.parametrize('angle', [-0.8, -0.2, 0.0, 0.5, 1.1])
def test_a_lever_draws_its_muscles_as_points_in_a_plane_say(angle):
    joint = lever()
    for i, (strand, kappa) in enumerate(
        zip(UNEQUAL, (joints.KAPPA_1, joints.KAPPA_2), strict=True)
    ):
        y = kappa * strand.l0 + joints.drawn(angle, i)
        assert statics.position(joint, i, angle) == pytest.approx(y, abs=1e-15)
        # The arm is the distance of the pivot from the muscle's line.
        expected = joints.lever_arm(angle, i)
        assert statics.arm(joint, i, angle) == pytest.approx(expected, rel=1e-12)
    first, second = (statics.arm(joint, i, angle) for i in (0, 1))
    assert first > 0.0 > second


@given(
    st.floats(0.005, 0.5),
    st.floats(0.005, 5.0),
    st.floats(0.2, 2.9),
    st.floats(0.02, 0.98),
    st.integers(0, 1),
)
def test_any_lever_finds_back_from_the_travel(crank, anchor, angle, share, i):
    travel, arm, _, coordinate = functions(Lever(crank, anchor, angle))
    # Anywhere between the dead centres, where crank and anchor are in line.
    edge = math.acos(DEAD_CENTRE)
    phi = edge + share * (math.pi - 2.0 * edge)
    s = (angle - phi) * (1 - 2 * i)
    assert coordinate(travel(s, i), i) == pytest.approx(s, abs=1e-7)
    assert arm(s, i) * (1 - 2 * i) > 0.0


def test_beyond_a_dead_centre_the_coordinate_stays_short_of_it():
    _, _, _, coordinate = functions(Lever(0.04, 0.45, 0.5 * math.pi))
    edge = math.acos(DEAD_CENTRE)
    assert coordinate(1.0, 0) == pytest.approx(0.5 * math.pi - edge)
    assert coordinate(-1.0, 0) == pytest.approx(edge - 0.5 * math.pi)
    assert coordinate(1.0, 1) == pytest.approx(edge - 0.5 * math.pi)


def test_a_lever_with_a_far_anchor_is_a_pulley_for_small_angles():
    """Square to its muscle and long compared with its crank, its arm is the crank."""
    travel, arm, arm_slope, _ = functions(Lever(0.04, 20.0, 0.5 * math.pi))
    assert arm(0.0, 0) == pytest.approx(0.04, rel=1e-5)
    assert arm(0.0, 1) == pytest.approx(-0.04, rel=1e-5)
    assert arm_slope(0.0, 0) == pytest.approx(0.0, abs=1e-4)
    assert travel(0.1, 0) == pytest.approx(0.04 * math.sin(0.1), rel=2e-3)


# What is refused ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ('transmission', 'fields', 'sentence'),
    [
        (Pulley, {'radius': 0.0}, 'radius = 0.0 is not allowed: give 0.0001 to 1 m'),
        (Lever, {'crank': 0.0}, 'crank = 0.0 is not allowed: give 0.0001 to 1 m'),
        (Lever, {'anchor': -0.1}, 'anchor = -0.1 is not allowed: give 0.0001 to 20 m'),
        (Lever, {'angle': 0.0}, 'angle = 0.0 is not allowed: give 0.1 to 3 rad'),
        (Lever, {'angle': math.nan}, 'angle = nan is not allowed: give 0.1 to 3 rad'),
    ],
)
def test_what_makes_no_transmission_is_refused_with_a_sentence(transmission, fields, sentence):
    with pytest.raises(ParameterError) as error:
        transmission(**fields)
    assert str(error.value) == sentence
