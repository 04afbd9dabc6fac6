# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What makes a position law, checked against each other."""

from dataclasses import replace

import pytest

from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.gains import Gains
from pam_ros.control.limits import Limits
from pam_ros.control.loop import WAITING, Measurement
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.setup import LawSetup
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import DeadBand, PressureLag, PressureOffset
from pam_ros.errors import ParameterError
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from support.paper import spring


def setup_of(**given):
    common = {
        'controller': 'sliding_mode',
        'joint': single_muscle_joint(),
        'gains': Gains(),
        'pid': PidGains(),
        'limits': Limits(),
        'shape': Shape(),
        'co_contraction': CoContraction(),
        'period': 0.002,
    }
    return LawSetup(**{**common, **given})


def of_pair(**given):
    revolute = {
        'joint': antagonistic_joint(),
        'gains': Gains.revolute(),
        'pid': PidGains.revolute(),
        'shape': Shape.revolute(),
    }
    return setup_of(**{**revolute, **given})


def test_the_reach_is_where_the_muscle_holds_the_load():
    now, weight = setup_of(), 20.0 * 9.80665
    low, high = now.reach
    assert low < high <= 0.25 * 0.4
    for position in (low, high):
        # The pressure of the paper's static equation is within the limits.
        assert spring(0.0, position)[0] <= weight * (1.0 + 1e-6)
        assert spring(600e3, position)[0] >= weight * (1.0 - 1e-6)
    assert (now.unit, now.can_stiffen) == ('m', False)
    assert (of_pair().unit, of_pair().can_stiffen) == ('rad', True)


@pytest.mark.parametrize('make', [setup_of, of_pair])
def test_each_law_gives_pressures_for_the_middle_of_its_reach(make):
    for controller, kind in (('sliding_mode', SlidingMode), ('pid', Pid)):
        now = make(controller=controller)
        law = now.make_law()
        assert type(law) is kind
        middle = 0.5 * sum(now.reach)
        law.start(middle)
        pressures = law.update(now.period, Reference(middle), middle)
        assert all(0.0 <= pressure <= 600e3 for pressure in pressures)


def test_the_commands_at_which_chambers_stay_are_those_of_the_pressure_path():
    effects = [PressureOffset(offset=-5e3), PressureLag(fill=0.1, vent=0.1)]
    now = setup_of(joint=single_muscle_joint(effects=effects))
    assert now.command_at([200e3]) == pytest.approx((205e3,))
    banded = setup_of(joint=single_muscle_joint(effects=[DeadBand(band=50e3)]))
    assert banded.command_at([200e3]) == pytest.approx((250e3,))
    assert of_pair().command_at([100e3, 300e3]) == pytest.approx((100e3, 300e3))


@pytest.mark.parametrize(
    ('change', 'needs'),
    [
        ({'gains': Gains(bandwidth=10.0)}, False),
        ({'shape': Shape(max_velocity=0.05)}, False),
        ({'period': 0.004}, False),
        ({'joint': single_muscle_joint(load=Mass(mass=10.0))}, True),
        ({'limits': Limits(pressure_high=4e5)}, True),
        ({'pid': PidGains(integral=1e5)}, True),
        ({'controller': 'pid'}, True),
    ],
)
def test_only_another_joint_law_or_other_limits_need_a_new_law(change, needs):
    assert replace(setup_of(), **change).needs_new_law(setup_of()) is needs


def test_a_running_law_takes_over_gains_and_stiffness():
    before = of_pair()
    now = replace(
        before,
        gains=replace(before.gains, bandwidth=20.0),
        co_contraction=CoContraction(co_contraction=33.0),
    )
    law = before.make_law()
    now.take_over(law, before)
    assert law.gains.bandwidth == 20.0
    assert now.needs_new_law(before) is False
    assert replace(now, controller='pid').needs_new_law(replace(before, controller='pid'))


def test_a_law_without_a_finite_command_is_refused():
    with pytest.raises(ParameterError, match='gives no finite pressure with these parameters'):
        setup_of(joint=single_muscle_joint(load=Mass(mass=5e-324)))


def test_a_loop_takes_a_change_over_and_gets_a_new_law_only_if_one_is_needed():
    before = of_pair()
    loop = before.make_loop()
    assert (loop.state, loop.period) == (WAITING, before.period)
    law, bounds = loop.law, loop.plausibility.bounds
    softer = replace(
        before,
        gains=replace(before.gains, bandwidth=10.0),
        shape=replace(before.shape, max_velocity=0.01),
        period=0.004,
    )
    assert softer.change_loop(loop, before) == ''
    assert loop.law is law
    assert law.gains.bandwidth == 10.0
    begin = 0.5 * sum(before.reach)
    loop.source.start(begin)
    loop.source.follow(1.0)
    loop.source.set_target(begin + 0.1)
    for _ in range(100):
        reference = loop.source.follow(0.01)
    assert begin < reference.position < begin + 0.011  # in 1 s at no more than max_velocity
    assert loop.period == 0.004
    heavier = replace(softer, joint=replace(before.joint, load=Arm(mass=2.0)))
    assert heavier.change_loop(loop, softer) == ''
    assert loop.law is not law
    assert loop.plausibility.bounds != bounds


def test_a_loop_says_that_its_reference_is_out_of_the_new_reach():
    before = setup_of()
    loop = before.make_loop()
    high = before.reach[1]
    loop.see(Measurement(0.0, high))
    loop.tick(0.0)
    loop.source.set_target(high)
    heavier = replace(before, joint=single_muscle_joint(load=Mass(mass=60.0)))
    assert 'is out of reach with the changed parameters' in heavier.change_loop(loop, before)
    assert loop.law.allocation.reach == heavier.reach
