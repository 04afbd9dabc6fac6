# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A wrong name in a constructor of the public interface is a sentence."""

import inspect
import re
from dataclasses import dataclass, is_dataclass, replace

import pytest

import pam_ros
from pam_ros import CoulombFriction, Gains, Limits, Mass, Muscle
from pam_ros.effects import EFFECTS
from pam_ros.errors import ParameterError

# Results of functions; nobody calls their constructors.
RESULTS = {'ForceMap', 'Identification', 'JointOutputs', 'LinearModel', 'MuscleOutputs'}
RESULTS |= {'Recording', 'Trajectory', 'LoadEquations', 'TransmissionEquations'}


def public_dataclasses():
    found = [getattr(pam_ros, name) for name in pam_ros.__all__ if name not in RESULTS]
    return [one for one in found if inspect.isclass(one) and is_dataclass(one)]


def test_every_effect_and_part_is_among_them():
    assert {*EFFECTS, Muscle, Mass, Gains, Limits} <= set(public_dataclasses())


@pytest.mark.parametrize('cls', public_dataclasses(), ids=lambda cls: cls.__name__)
def test_an_unknown_name_is_refused_with_those_that_are_known(cls):
    with pytest.raises(ParameterError, match=f'{cls.__name__} has no zzz: give '):
        cls(zzz=3.0)


@pytest.mark.parametrize(
    ('make', 'text'),
    [
        (lambda: CoulombFriction(lvl=3.0), 'CoulombFriction has no lvl: was level meant?'),
        (lambda: Muscle(mass=3.0), 'Muscle has no mass: give a1, a2, a3, a4, a5, a6, .*'),
        (lambda: replace(Mass(), mas=3.0), 'Mass has no mas: was mass meant?'),
        (
            lambda: CoulombFriction(*range(9)),
            'CoulombFriction takes at most 6 values without a name, not 9: give level, .*',
        ),
    ],
)
def test_the_sentence(make, text):
    with pytest.raises(ParameterError) as error:
        make()
    assert re.fullmatch(text.replace('?', '[?]'), str(error.value))


def test_a_custom_part_has_the_same_check():
    @dataclass(frozen=True)
    class Ballast(Mass):
        pass

    with pytest.raises(ParameterError, match='Ballast has no weight'):
        Ballast(weight=2.0)
