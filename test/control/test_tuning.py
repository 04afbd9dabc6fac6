# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tuning numbers: each with a unit and with where it comes from, and in the joint's own units."""

from dataclasses import astuple, dataclass, fields, replace

import pytest

from pam_ros.control.estimates import EstimateTuning
from pam_ros.control.gains import OrderTuning
from pam_ros.control.learning.features import FeatureTuning
from pam_ros.control.learning.learning_tuning import LearningTuning
from pam_ros.control.pressure_path import PathTuning
from pam_ros.control.reference.shaping import StreamTuning
from pam_ros.control.rest.cause import CauseTuning
from pam_ros.control.rest.gain_reduction import ReductionTuning
from pam_ros.control.rest.oscillation import OscillationTuning
from pam_ros.control.rest.rejection import RejectionTuning
from pam_ros.control.rest.standstill import StandstillTuning
from pam_ros.control.rest.stiction import StictionTuning
from pam_ros.control.sliding_mode import LawTuning
from pam_ros.control.tuning import JointScale, number, numbers_of
from pam_ros.sizes import Sizes

TUNINGS = [
    CauseTuning,
    EstimateTuning,
    FeatureTuning,
    LawTuning,
    LearningTuning,
    OrderTuning,
    OscillationTuning,
    PathTuning,
    ReductionTuning,
    RejectionTuning,
    StandstillTuning,
    StictionTuning,
    StreamTuning,
]
BY_TUNING = pytest.mark.parametrize('tuning', TUNINGS, ids=lambda tuning: tuning.__name__)
# A rig that is 10 times as strong, at 100 times the pressure, and 1/10 times as long; its joint is
# revolute. A number along a muscle goes with the units of the joint and with the rig's sizes.
TURNED = JointScale(Sizes(10.0, 100.0, 0.1), 25.0, 0.08, is_revolute=True)
SCALES = {
    '': 1.0,
    's': 1.0,
    '1/s': 1.0,
    'rad/s': 1.0,
    'm': 2.5,
    'm/s': 2.5,
    'm/s^2': 2.5,
    'N': 0.8,
    'N/s': 0.8,
    'N^2': 0.8**2,
    'Pa': 100.0,
}
OF_JOINT = {'N/m': 1.0, 'N^2': 1.0}  # N m/rad and (N m)^2: force times length


def flat(value):
    return value if isinstance(value, tuple) else (value,)


@BY_TUNING
def test_each_number_has_a_unit_that_is_known_and_a_source(tuning):
    numbers = numbers_of(tuning)
    assert set(numbers) == {field.name for field in fields(tuning)}
    for name, (_, about) in numbers.items():
        assert about.unit in (SCALES if about.along_muscle else OF_JOINT), name
        assert len(about.source.split()) >= 3, name


@BY_TUNING
def test_a_muscle_on_a_mass_has_them_to_the_bit(tuning):
    assert repr(astuple(JointScale().of(tuning()))) == repr(astuple(tuning()))


@BY_TUNING
def test_each_number_goes_with_the_joint_and_its_sizes_by_its_unit(tuning):
    turned = TURNED.of(tuning())
    for name, (value, about) in numbers_of(tuning).items():
        factor = (SCALES if about.along_muscle else OF_JOINT)[about.unit]
        expected = [factor * each for each in flat(value)]
        assert flat(getattr(turned, name)) == pytest.approx(expected), name
        if about.unit in ('', 's', '1/s', 'rad/s'):
            assert getattr(turned, name) is value, name


@BY_TUNING
def test_they_are_not_changed_in_passing(tuning):
    name = fields(tuning)[0].name
    with pytest.raises(AttributeError):
        setattr(tuning(), name, 1.0)


def test_what_was_changed_is_scaled_too():
    quick = replace(StandstillTuning(), rest_speed=2e-4)
    assert TURNED.of(quick).rest_speed == pytest.approx(5e-4)


def test_an_unknown_unit_is_refused():
    @dataclass(frozen=True)
    class Bad:
        way: float = number(1.0, 'furlong', 'a source of three words')

    with pytest.raises(KeyError, match='furlong'):
        JointScale().of(Bad())
