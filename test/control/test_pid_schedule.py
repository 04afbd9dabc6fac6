# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Shares of PID gains along the reach: all of them on the rigs of the defaults, else less."""

import numpy as np
import pytest

from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.pid_schedule import Schedule, plant_at
from pam_ros.errors import ParameterError, RangeError
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.transmissions import Pulley
from support import pair_loop
from support.bench import cart
from support.closed_loop import shared
from support.joint_grid import nominal
from support.joint_loop import close_joint

GAINS = (49.1e3, 1.91e6, 9.09e3, 326.0)


def schedule(joint, gains=GAINS):
    allocation = shared(joint)
    return Schedule(allocation, gains, CoContraction().wanted(allocation)), allocation


@pytest.mark.parametrize(
    'joint', [single_muscle_joint(), pair_loop.nominal()], ids=['one', 'pair']
)
def test_the_rigs_of_the_defaults_have_all_of_the_gains_at_all_places(joint):
    law = Pid(joint)
    low, high = law.allocation.reach
    for s in np.linspace(low, high, 41):
        assert law._schedule.at(float(s), law._stiffness) == (1.0, 1.0)


def test_a_softer_pair_has_less_of_the_integral_gain():
    found, allocation = schedule(pair_loop.nominal())
    wanted = CoContraction().wanted(allocation)
    shares = [found.at(0.0, k).integral for k in (wanted, 0.7 * wanted, 0.0)]
    assert shares == sorted(shares, reverse=True)
    assert shares[-1] < 0.8


def test_between_the_places_it_is_interpolated_and_beyond_them_that_of_the_end():
    found, allocation = schedule(nominal('crank'))
    low, high = allocation.reach
    shares = np.array([found.at(float(s), 0.0) for s in np.linspace(low - 1.0, high + 1.0, 4001)])
    assert np.max(np.abs(np.diff(shares, axis=0))) < 0.01
    assert tuple(shares[0]) == found.at(low, 0.0)
    assert tuple(shares[-1]) == found.at(high, 0.0)


def test_the_stiffness_of_gravity_counts():
    joint = nominal('crank', 3.0)
    allocation = shared(joint)
    plant = plant_at(allocation, 0.3, 0.0)
    muscles = allocation.model.stiffness(
        allocation.split(allocation.model.gravity(0.3), 0.0, 0.3)[0], 0.3
    )
    assert plant.stiffness == pytest.approx(muscles + 3.0 * 9.80665 * 0.25 * np.cos(0.3))


def standing(mass):
    """Return a pair with an arm that stands up, as far as its softness leaves it standing."""
    muscle = Actuator(contraction=0.1)
    return Joint((muscle, muscle), Arm(mass=mass, hanging_at=np.pi), Pulley())


def test_what_no_share_makes_stable_is_refused_with_a_sentence():
    joint = standing(14.0)
    with pytest.raises(ParameterError, match=r'no share of these PID gains is stable at .* rad'):
        schedule(joint, (0.0, 1.91e6, 9.09e3, 326.0))


def test_a_stiffness_that_leaves_no_share_stable_is_refused():
    found, allocation = schedule(standing(7.0), (1e3, 1.91e6, 9.09e3, 326.0))
    wanted = CoContraction().wanted(allocation)
    for stiffness in (wanted, 1.2 * wanted, 0.95 * wanted):
        found.refuse_stiffness(stiffness)
    assert found.at(0.0, 0.95 * wanted).integral < 0.5
    with pytest.raises(RangeError, match='co-contraction 3 N m/rad leaves no share'):
        found.refuse_stiffness(3.0)


def test_a_load_without_a_muscle_has_one_share_everywhere():
    found, _ = schedule(cart(), (1e5, 1e5, 1e5, 282.0))
    assert found.at(-3.0, 0.0) == found.at(7.0, 0.0)


def test_unbounded_gains_are_used_as_they_are():
    joint = nominal('crank')
    law = Pid(joint, PidGains.for_joint(joint, bounded=False))
    # Which a crank does not bear: it turns until its position is none that this crank can have.
    with pytest.raises(ParameterError, match=r'^position = .* rad is not possible'):
        close_joint(law, joint, lambda t: 0.175 if t > 0.5 else 0.0, 6.0, begin=0.0)
