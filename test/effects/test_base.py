# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What an effect is: values that are checked, and a class that can act and be absent."""

import math
from dataclasses import FrozenInstanceError, dataclass
from typing import ClassVar

import pytest

from pam_ros.effects import (
    EFFECTS,
    CoulombFriction,
    Leak,
    Payload,
    PressureOffset,
    Slack,
    ViscousFriction,
)
from pam_ros.effects.base import ONSET, Compensation, EffectEquations, HiddenState
from pam_ros.effects.parameter import strength
from pam_ros.errors import ParameterError
from pam_ros.rig.joint import Joint
from support.made_effects import effect_with

BY_EFFECT = pytest.mark.parametrize('effect', EFFECTS, ids=lambda effect: effect.name)


def anywhere(*_):
    return 0.0


def pressure(p, t, h, x, i, xn, q, j):
    return p


@BY_EFFECT
def test_its_values_are_checked_one_by_one(effect):
    for p in (*effect.parameters(), ONSET):
        made = effect(**{p.name: p.high})
        assert getattr(made, p.name) == p.high
        assert made.given == ({p.name: p.high} if p.high != p.default else {})
        for bad in (math.nan, math.inf, 1e12, 'much', True, None):
            with pytest.raises(ParameterError, match=rf'effects\.{effect.name}\.{p.name} = '):
                effect(**{p.name: bad})


def test_its_fields_are_in_the_order_of_its_rows_and_the_onset_has_a_name():
    friction = CoulombFriction(8.0, 12.0, onset=3.0)
    assert (friction.level, friction.breakaway, friction.onset) == (8.0, 12.0, 3.0)
    assert friction == CoulombFriction(level=8, breakaway=12, onset=3)
    assert friction.row[:3] == (8.0, 12.0, 0.01)
    assert friction.given == {'level': 8.0, 'breakaway': 12.0, 'onset': 3.0}
    assert [*friction.values][:3] == ['level', 'breakaway', 'stribeck_speed']
    assert 'onset' not in CoulombFriction().values
    assert repr(friction) == 'CoulombFriction(level=8.0, breakaway=12.0, onset=3.0)'
    with pytest.raises(FrozenInstanceError):
        friction.level = 3.0


def test_it_is_present_by_its_strengths():
    assert Leak(rate=0.1).is_present
    assert not Leak(refill=0.1).is_present
    assert not Payload().is_present


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({}, 'effect made has no function: give it at least one'),
        (
            {'force': anywhere, 'outside': anywhere},
            'effect made acts in a muscle and on the joint (force, outside): make two',
        ),
        ({'drag': anywhere}, 'effect made has drag without outside'),
        (
            {'pressure': anywhere, 'treated': Compensation.PATH, 'has': (HiddenState('p', 'Pa'),)},
            'effect made has hidden states, which Compensation.PATH does not compute: give cham',
        ),
        ({'mass': 0.0}, 'mass = 0.0 is not a function: if a parameter of the effect has'),
    ],
)
def test_a_class_that_could_never_act_or_be_inverted_is_refused(given, sentence):
    with pytest.raises(ParameterError) as error:
        effect_with(**given)
    assert str(error.value).startswith(sentence)


def test_a_class_that_could_never_be_absent_is_refused():
    @dataclass(frozen=True)
    class Always(effect_with(outside=anywhere)):
        size: float = 1.0

        name: ClassVar = 'always'

    with pytest.raises(ParameterError, match='effect always has no strength'):
        Always.parameters()
    with pytest.raises(ParameterError, match='effect always has no strength'):
        Joint(library=(Always,))


def test_a_library_holds_classes():
    for wrong in (Leak(), Joint, 'leak'):
        with pytest.raises(ParameterError, match=r'library\[0\] = '):
            Joint(library=(wrong,))


def test_a_parameter_with_the_name_of_a_place_hides_no_function():
    with pytest.raises(ParameterError, match='is not a function: if a parameter'):

        class Hidden(effect_with(outside=anywhere)):
            pressure: float = strength('hides the function', high=1.0, scale=0.1)
            equations: ClassVar = EffectEquations(pressure=pressure)


def test_what_a_controller_asks_of_an_effect_without_memory():
    """Closed forms; an effect that does not act there leaves what it gets."""
    offset = PressureOffset(offset=5e3, gain=0.02)
    assert offset.equations.resting_pressure(1e5, offset.row, 0) == 1.02 * 1e5 + 5e3
    slack = Slack(share=1.0, push=3.0)
    assert slack.equations.resting_force(-1e4, 0.0, 0.1, slack.row, 0) == pytest.approx(-3.0)
    assert slack.equations.resting_force(1e4, 0.0, 0.1, slack.row, 0) == pytest.approx(1e4)
    drag = ViscousFriction(coefficient=30.0)
    assert drag.equations.viscous_drag(drag.row, 0) == 30.0
    assert drag.equations.resting_pressure(1e5, drag.row, 0) == 1e5
    assert drag.equations.resting_force(7.0, 1e5, 0.1, drag.row, 0) == 7.0
    assert offset.equations.viscous_drag(offset.row, 0) == 0.0
