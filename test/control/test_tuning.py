# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tuning numbers: each with a unit and with where it comes from, and in the joint's own units."""

from dataclasses import astuple, dataclass, fields, replace

import pytest

from pam_ros.control.estimates import EstimateTuning
from pam_ros.control.gains import OrderTuning
from pam_ros.control.learning.features import FeatureTuning
from pam_ros.control.learning.learning_tuning import LearningTuning
from pam_ros.control.reference.shaping import StreamTuning
from pam_ros.control.rest.oscillation import OscillationTuning
from pam_ros.control.rest.rejection import RejectionTuning
from pam_ros.control.rest.standstill import StandstillTuning
from pam_ros.control.rest.stiction import StictionTuning
from pam_ros.control.sliding_mode import LawTuning
from pam_ros.control.tuning import number, numbers_of, scaled

TUNINGS = [
    EstimateTuning,
    FeatureTuning,
    LawTuning,
    LearningTuning,
    OrderTuning,
    OscillationTuning,
    RejectionTuning,
    StandstillTuning,
    StictionTuning,
    StreamTuning,
]
BY_TUNING = pytest.mark.parametrize('tuning', TUNINGS, ids=lambda tuning: tuning.__name__)
# How a unit goes with the scale of lengths and that of forces.
SCALES = {
    '': 1.0,
    's': 1.0,
    '1/s': 1.0,
    'rad/s': 1.0,
    'm': 25.0,
    'm/s': 25.0,
    'm/s^2': 25.0,
    'N': 0.08,
    'N/s': 0.08,
    'N^2': 0.08**2,
}


def flat(value):
    return value if isinstance(value, tuple) else (value,)


@BY_TUNING
def test_each_number_has_a_unit_that_is_known_and_a_source(tuning):
    numbers = numbers_of(tuning)
    assert set(numbers) == {field.name for field in fields(tuning)}
    for name, (_, about) in numbers.items():
        assert about.unit in SCALES, name
        assert len(about.source.split()) >= 3, name


@BY_TUNING
def test_a_muscle_on_a_mass_has_them_to_the_bit(tuning):
    assert repr(astuple(scaled(tuning(), 1.0, 1.0))) == repr(astuple(tuning()))


@BY_TUNING
def test_lengths_and_forces_go_with_the_joint_and_nothing_else_does(tuning):
    numbers, turned = numbers_of(tuning), scaled(tuning(), 25.0, 0.08)
    for name, (value, about) in numbers.items():
        expected = [SCALES[about.unit] * each for each in flat(value)]
        assert flat(getattr(turned, name)) == pytest.approx(expected), name
        if SCALES[about.unit] == 1.0:
            assert getattr(turned, name) is value, name


@BY_TUNING
def test_they_are_not_changed_in_passing(tuning):
    name = fields(tuning)[0].name
    with pytest.raises(AttributeError):
        setattr(tuning(), name, 1.0)


def test_what_was_changed_is_scaled_too():
    quick = replace(StandstillTuning(), rest_speed=2e-4)
    assert scaled(quick, 25.0, 0.08).rest_speed == pytest.approx(5e-3)


def test_an_unknown_unit_is_refused():
    @dataclass(frozen=True)
    class Bad:
        way: float = number(1.0, 'furlong', 'a source of three words')

    with pytest.raises(KeyError, match='furlong'):
        scaled(Bad(), 1.0, 1.0)
