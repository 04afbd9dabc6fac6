# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Standard deviations of nominal values: priors of what is fitted."""

from math import exp, log

import numpy as np
import pytest

from pam_ros.errors import ParameterError
from pam_ros.identification.fit.of_rig import OfRig
from pam_ros.identification.fit.uncertain import spread_unknowns
from pam_ros.identification.fit.unknowns import nominal_unknowns
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint

ELBOW = antagonistic_joint(Muscle(), load=Arm(inertia=0.02, mass=0.0, arm=0.25))
SINGLE = single_muscle_joint(Muscle(), Mass(mass=20.0))
NAMES = ('flexor', 'extensor')


def unknown(name, given, joint=ELBOW, muscles=NAMES):
    (found,) = [k for k in spread_unknowns(joint, muscles, {name: given}) if k.name == name]
    return found


def test_without_any_the_unknowns_are_the_constants():
    assert spread_unknowns(ELBOW, NAMES, {}) == nominal_unknowns(ELBOW, NAMES)


@pytest.mark.parametrize('given', ['50%', ' 50 %', 0.01, '0.01', np.float64(0.01)])
def test_a_number_that_cannot_be_negative_has_a_prior_of_its_logarithm(given):
    found = unknown('inertia', given)
    assert found.of == OfRig('inertia', 'load')
    assert found.value(0.0) == 0.02
    # One standard deviation is a factor of 1.5, to either side.
    assert found.value(1.0) == pytest.approx(0.03, rel=1e-12)
    assert found.value(-1.0) == pytest.approx(0.02 / 1.5, rel=1e-12)
    assert found.prior == 1.0


@pytest.mark.parametrize(('name', 'deviation'), [('hanging_at', 0.2), ('mass', 0.3)])
def test_other_numbers_and_those_at_zero_have_a_normal_prior(name, deviation):
    found = unknown(name, deviation)
    assert found.value(0.0) == 0.0
    assert found.value(1.0) == pytest.approx(deviation)
    low = found.bounds[0]
    assert found.value(low) == (0.0 if name == 'mass' else pytest.approx(-np.pi))


def test_a_mounting_is_that_of_one_muscle():
    found = unknown('contraction_2', 0.01)
    assert found.of == OfRig('contraction_2', 'mounting', 1)
    assert found.value(-2.0) == pytest.approx(ELBOW.actuators[1].contraction - 0.02)


def test_a_constant_is_that_of_one_muscle_or_of_all():
    usual = {k.name: k for k in nominal_unknowns(ELBOW, NAMES)}
    one = {k.name: k for k in spread_unknowns(ELBOW, NAMES, {'flexor.a2': '12%'})}
    assert one['flexor.a2'].value(1.0) - one['flexor.a2'].base == pytest.approx(
        0.12 * abs(one['flexor.a2'].base)
    )
    assert one['extensor.a2'] == usual['extensor.a2']
    both = {k.name: k for k in spread_unknowns(ELBOW, NAMES, {'zeta': '20%'})}
    for name in NAMES:
        found = both[f'{name}.zeta']
        assert exp(found.scale) == pytest.approx(1.2)
        assert log(found.value(1.0) / found.base) == pytest.approx(log(1.2))
    assert both.keys() == usual.keys()


def test_one_muscle_has_a_constant_without_its_name():
    (found,) = [k for k in spread_unknowns(SINGLE, (), {'a2': '10%'}) if k.name == 'a2']
    assert found.scale == pytest.approx(0.1 * abs(found.base))


@pytest.mark.parametrize(
    ('spreads', 'words'),
    [
        ({'nosuch': '5%'}, 'the uncertain parameter nosuch is not one that a recording of this'),
        ({'kappa_max': '5%'}, 'the uncertain parameter kappa_max is not one'),
        ({'inertia': '0%'}, "uncertain inertia = '0%' is not allowed: give a standard deviation"),
        ({'inertia': -0.1}, 'uncertain inertia = -0.1 is not allowed'),
        ({'inertia': 'nan'}, "uncertain inertia = 'nan' is not allowed"),
        ({'inertia': 'inf%'}, "uncertain inertia = 'inf%' is not allowed"),
        ({'inertia': 'half'}, "uncertain inertia = 'half' is not allowed"),
        ({'inertia': True}, 'uncertain inertia = True is not allowed'),
        ({'inertia': None}, 'uncertain inertia = None is not allowed'),
        ({'flexor.a2': 5.0}, 'give a standard deviation above 0, as a share such as 10%'),
        ({'mass': '5%'}, 'uncertain mass = 5%: a share of a nominal value of 0 is 0; give the '
                         'standard deviation in kg'),
        (['inertia'], 'uncertain = '),
    ],
)  # fmt: skip
def test_a_text_without_a_standard_deviation_is_refused(spreads, words):
    with pytest.raises(ParameterError) as refused:
        spread_unknowns(ELBOW, NAMES, spreads)
    assert words in str(refused.value)


def test_the_refusal_of_an_unknown_name_lists_the_known_names():
    with pytest.raises(
        ParameterError, match=r'flexor\.a1, a1, .*extensor\.zeta, inertia, mass, arm'
    ):
        spread_unknowns(ELBOW, NAMES, {'weight': '5%'})
