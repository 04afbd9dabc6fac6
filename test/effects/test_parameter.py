# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of effects: their ranges, and their units on a joint that turns."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import EFFECTS, CoulombFriction, EndStop, Leak, ViscousFriction
from pam_ros.effects.base import ON_JOINT
from pam_ros.effects.parameter import start_from
from pam_ros.errors import ParameterError
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.units import REVOLUTE, revolute_unit
from support.joint_models import lever, pair
from support.made_effects import effect_with

ON_LOAD = [effect for effect in EFFECTS if effect.acts_on_joint()]
BY_EFFECT = pytest.mark.parametrize('effect', ON_LOAD, ids=lambda effect: effect.name)


def described(effect):
    return {p.name: (p.unit, p.low, p.high) for p in effect.parameters(revolute=True)}


def test_effects_on_a_joint_that_turns_have_its_units():
    effects = {effect.name: effect for effect in EFFECTS}
    stop = described(effects['end_stop'])
    assert stop['upper'] == stop['lower'] == ('rad', -math.pi, math.pi)
    assert stop['stiffness'][0] == 'N m/rad'
    friction = described(effects['coulomb_friction'])
    assert [unit for unit, _, _ in friction.values()] == [
        'N m', 'N m', 'rad/s', 'N m/Pa', '', 'rad',
    ]  # fmt: skip
    # 0.2 mm at an arm of 20 mm, and ten times as much on any rig
    assert friction['presliding'] == ('rad', 1e-7, pytest.approx(0.1))
    assert described(effects['viscous_friction'])['coefficient'][0] == 'N m s/rad'
    assert described(effects['payload'])['mass'][0] == 'kg'  # at the end of the arm


@BY_EFFECT
def test_nothing_else_about_them_differs(effect):
    for one, this in zip(effect.parameters(revolute=True), effect.parameters(), strict=True):
        assert one.unit == REVOLUTE[this.unit]
        if this.unit == 'm':
            assert replace(one, unit='m', high=this.high, fit_high=this.fit_high) == this
        elif this.unit != 'fraction':
            assert replace(one, unit=this.unit) == this


def test_every_effect_acts_in_a_muscle_or_on_the_joint():
    for effect in EFFECTS:
        on_joint = [bool(getattr(effect.equations, place)) for place in ON_JOINT]
        assert effect.acts_on_joint() is any(on_joint)
    assert len(ON_LOAD) < len(EFFECTS)


def test_no_unit_of_the_library_is_missing():
    """Of parameters and of hidden states, each of which is known where it is turned."""
    for effect in ON_LOAD:
        for p in (*effect.parameters(), *effect.states):
            assert revolute_unit(p.unit, p.name) == REVOLUTE[p.unit]


def test_a_unit_turned_twice_has_a_meaning_only_where_it_stays():
    stays = {unit for unit, other in REVOLUTE.items() if unit == other}
    assert stays == {'', 'kg', 's', '1/s', 'rad/s', 'Hz', 'Pa', 'Pa/s', 'fraction of l0'}


def outside(f, p, y, v, t, h, x, i, xn, q, j):
    """Return a drag that grows with the square of the speed."""
    return f - q[j] * v * abs(v)


DRAG = effect_with('air_drag', 'N s^2/m^2', outside=outside)


def test_a_unit_without_a_counterpart_for_a_revolute_joint_is_refused():
    sentence = (
        'effects.air_drag.size is in N s^2/m^2: the unit for a revolute joint is not known; '
        'add the unit to REVOLUTE in pam_ros/units.py'
    )
    with pytest.raises(ParameterError) as error:
        DRAG.parameters(revolute=True)
    assert str(error.value) == sentence
    library = (DRAG,)
    single_muscle_joint(effects=[DRAG(size=1.0)], library=library)  # it slides
    with pytest.raises(ParameterError) as error:
        pair(load=[DRAG(size=1.0)], library=library)
    assert str(error.value) == sentence


@pytest.mark.slow
def test_with_its_unit_named_it_acts_there(monkeypatch):
    monkeypatch.setitem(REVOLUTE, 'N s^2/m^2', 'N m s^2/rad^2')
    drag = effect_with('air_drag', 'N s^2/m^2', outside=outside)
    assert described(drag)['size'][0] == 'N m s^2/rad^2'
    joint = pair(load=[drag(size=0.3)], library=(drag,))
    bare = pair(library=(drag,))
    found = []
    for one in (joint, bare):
        rig = Simulation([one])
        rig.reset([3e5, 3e5], [0.1], [-2.0])
        found.append(rig.joint_outputs().acceleration[0])
    assert found[0] - found[1] == pytest.approx(0.3 * 2.0**2 / joint.inertia, rel=1e-9)


@pytest.mark.parametrize('made', [pair, lever], ids=['pair', 'lever'])
@pytest.mark.parametrize(
    ('load', 'effort'),
    [
        ([ViscousFriction(coefficient=0.3)], -0.3 * 2.0),
        ([EndStop(upper=0.1, stiffness=50.0, damping=0.0)], -50.0 * 0.2),
        ([EndStop(lower=0.7, lower_stiffness=20.0, damping=0.0)], 20.0 * 0.4),
    ],
    ids=['friction', 'above', 'below'],
)
def test_what_is_given_in_these_units_acts_in_them(made, load, effort):
    """At 0.3 rad and 2 rad/s; a step of 1 ms softens a stop of 50 N m/rad by a billionth."""
    found = []
    for one in (made(load=load), made()):
        rig = Simulation([one])
        rig.reset([3e5, 3e5], [0.3], [2.0])
        found.append(rig.joint_outputs().acceleration[0])
    np.testing.assert_allclose((found[0] - found[1]) * made().inertia, effort, rtol=1e-6)


def test_a_contraction_on_a_joint_may_be_an_angle():
    """One dataclass serves both kinds of joint, each of which checks its own range."""
    assert EndStop(upper=3.0, stiffness=1e3).upper == 3.0
    allowed = 'give -3.14159 to 3.14159 fraction or rad'
    with pytest.raises(ParameterError, match=f'upper = 3.5 is not allowed: {allowed}'):
        EndStop(upper=3.5)
    single_muscle_joint(effects=[EndStop(upper=0.9, stiffness=1e3)])
    with pytest.raises(ParameterError, match=r'effects.end_stop.upper = 1.5 is not allowed'):
        single_muscle_joint(effects=[EndStop(upper=1.5, stiffness=1e3)])


def test_a_length_on_a_joint_may_be_an_angle():
    assert pair(load=[CoulombFriction(level=1.0, presliding=0.08)]).effects[0].presliding == 0.08
    allowed = 'give 1e-07 to 0.1 m or rad'
    with pytest.raises(ParameterError, match=f'presliding = 0.2 is not allowed: {allowed}'):
        CoulombFriction(level=1.0, presliding=0.2)
    allowed = 'give 1e-07 to 0.002 m'
    with pytest.raises(ParameterError, match=f'presliding = 0.08 is not allowed: {allowed}$'):
        single_muscle_joint(effects=[CoulombFriction(level=1.0, presliding=0.08)])


def test_where_a_fit_starts_names_parameters_and_values_that_there_are():
    assert start_from(Leak, rate=0.3, refill=0.0) == {'rate': 0.3, 'refill': 0.0}
    with pytest.raises(ParameterError, match=r'effects.leak.rate = 20.0 is not allowed'):
        start_from(Leak, rate=20.0)
    with pytest.raises(ParameterError, match='Leak has no leakage'):
        start_from(Leak, leakage=0.1)
