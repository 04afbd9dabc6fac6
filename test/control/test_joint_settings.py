# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Gains and bounds know whether the joint slides or turns, and fit no other."""

from dataclasses import replace

import pytest

from pam_ros.control.gains import Gains
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.errors import ParameterError
from pam_ros.parameters import described
from pam_ros.rig.standard_joints import single_muscle_joint
from support.pair_loop import nominal as elbow
from support.scaled import scaled_muscle

KINDS = (Gains, PidGains, Shape)


@pytest.mark.parametrize('kind', KINDS)
def test_the_joint_decides_which_defaults_apply(kind):
    assert kind.for_joint(single_muscle_joint()) == kind()
    assert kind.for_joint(elbow()) == kind.revolute() != kind()
    assert kind.for_joint(elbow()).is_revolute


@pytest.mark.parametrize('kind', KINDS)
@pytest.mark.parametrize('joint', [single_muscle_joint(), elbow()], ids=['prismatic', 'revolute'])
def test_defaults_of_forces_and_pressures_are_those_of_the_muscles(kind, joint):
    muscle = scaled_muscle(joint.muscles[0], 1e-3, 1e-2, 1.0)
    actuators = tuple(replace(one, muscle=muscle) for one in joint.actuators)
    small = replace(joint, actuators=actuators, load=replace(joint.load, mass=0.02))
    units = {name: about.unit for name, (_, _, about) in described(kind).items()}
    scales = {'N': 1e-3, 'Pa/m': 1e-2, 'Pa/(m s)': 1e-2, 'Pa s/m': 1e-2}
    for name, unit in units.items():
        expected = scales.get(unit, 1.0) * getattr(kind.for_joint(joint), name)
        assert getattr(kind.for_joint(small), name) == pytest.approx(expected, rel=0.01), name


@pytest.mark.parametrize(
    ('kind', 'given'),
    [(Gains, {'bandwidth': 30.0}), (PidGains, {'integral': 1e6}), (Shape, {'max_velocity': 50.0})],
)
def test_what_is_given_goes_before_the_defaults_of_the_joint(kind, given):
    ((name, value),) = given.items()
    made = kind.for_joint(elbow(), **given)
    assert getattr(made, name) == value
    assert made.is_revolute


SLIDES = 'the joint is prismatic .m, N. and {} has the units of a revolute one .rad, N m.'
TURNS = 'the joint is revolute .rad, N m. and {} has the units of a prismatic one .m, N.'


@pytest.mark.parametrize(
    ('make', 'sentence'),
    [
        (lambda: SlidingMode(elbow(), Gains(bandwidth=20.0)), TURNS.format('Gains')),
        (lambda: SlidingMode(single_muscle_joint(), Gains.revolute()), SLIDES.format('Gains')),
        (lambda: SlidingMode(elbow()).set_gains(Gains()), TURNS.format('Gains')),
        (lambda: Pid(elbow(), PidGains()), TURNS.format('PidGains')),
        (lambda: Pid(single_muscle_joint(), PidGains.revolute()), SLIDES.format('PidGains')),
        (lambda: ReferenceSource(Shape(), (-1.0, 1.0), 'rad'), TURNS.format('Shape')),
        (lambda: ReferenceSource(Shape.revolute(), (0.0, 0.1)), SLIDES.format('Shape')),
        (
            lambda: ReferenceSource(Shape(), (0.0, 0.1)).set_shape(Shape.revolute()),
            SLIDES.format('Shape'),
        ),
    ],
)
def test_those_of_the_other_kind_are_refused(make, sentence):
    with pytest.raises(ParameterError, match=sentence):
        make()
