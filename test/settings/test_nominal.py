# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The joint of a parameter file as the search for missing effects takes it, and back."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pam_ros.effects import CoulombFriction, PressureLag
from pam_ros.errors import ParameterError
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.rig.joint import Actuator
from pam_ros.settings.files import read, write
from pam_ros.settings.nominal import nominal_joint, uncertain_values

ANTAGONISTIC = Path(__file__).parents[2] / 'config' / 'antagonistic.yaml'
NAMED = ['muscles=flexor,extensor']


@pytest.mark.parametrize('kind', [kind.name for kind in ARRANGEMENTS])
def test_every_kind_goes_to_a_file_and_comes_back(kind, tmp_path):
    nominal = nominal_joint('dmsp_20_400n', [f'joint={kind}'])
    assert nominal.kind.name == kind
    assert len(nominal.muscles) == nominal.kind.muscles
    write(tmp_path / 'joint.yaml', nominal.flat())
    again = nominal_joint(tmp_path / 'joint.yaml')
    assert (again.muscles, again.name) == (nominal.muscles, nominal.name)
    assert again.joint.parameters().tobytes() == nominal.joint.parameters().tobytes()


def test_muscles_that_differ_stand_behind_their_names(tmp_path):
    nominal = nominal_joint(ANTAGONISTIC, NAMED)
    first, second = nominal.joint.actuators
    late = Actuator(replace(second.muscle, a5=310.0), [PressureLag(fill=0.06, vent=0.09)], 0.12)
    joint = replace(nominal.joint, actuators=(first, late), effects=[CoulombFriction(level=0.2)])
    values = nominal.flat(joint)
    assert values['extensor.a5'] == 310.0
    assert values['flexor.a5'] == first.muscle.a5
    assert values['a1'] == first.muscle.a1
    assert values['extensor.effects.pressure_lag.fill'] == 0.06
    assert values['effects.coulomb_friction.level'] == 0.2
    assert values['contraction_2'] == 0.12
    assert not any(name.startswith('flexor.effects') for name in values)
    write(tmp_path / 'joint.yaml', values)
    again = nominal_joint(tmp_path / 'joint.yaml').joint
    np.testing.assert_array_equal(again.parameters(), joint.parameters())
    assert again.present == joint.present


def test_the_uncertainty_of_a_parameter():
    nominal = nominal_joint(ANTAGONISTIC, NAMED)
    assert nominal.unit('effects.coulomb_friction.level') == 'N m'
    assert nominal.unit('extensor.l0') == nominal.unit('l0') == 'm'
    assert nominal.text('flexor.a1') == nominal.text('a1') != ''
    assert nominal.text('flexor.nothing') == nominal.unit('nothing') == ''
    assert nominal_joint('dmsp_20_400n').unit('effects.coulomb_friction.level') == 'N'


@pytest.mark.parametrize(
    ('overrides', 'sentence'),
    [
        (['joint=foo'], 'joint = .foo. is not allowed: give one of load, parallel'),
        (['mas=3'], 'mas is not a parameter: was mass meant?'),
        (['mass'], 'sets nothing: give name=value'),
        (['wrist.l0=2'], 'wrist.l0 is not a parameter of joint = antagonistic'),
        (['muscles=one'], 'muscles: 1 names do not fit joint = antagonistic'),
        (['muscles=a,b,c,d'], 'describes 2 joints, pam_1, pam_2: give a file with one joint'),
        (['rate=100'], 'rate is not a parameter of joint = antagonistic'),
        (['contraction_1=0.8'], r'never within kappa_min and kappa_max'),
    ],
)
def test_what_is_refused(overrides, sentence):
    with pytest.raises(ParameterError, match=sentence):
        nominal_joint(ANTAGONISTIC, overrides)


# Standard deviations ----------------------------------------------------------------------------

UNCERTAIN = """
/**:
  ros__parameters:
    mass: 18.0
pam_identify:
  ros__parameters:
    uncertain: {mass: 5%, a2: '10%'}
    uncertain.l0: 0.001
"""


def test_standard_deviations_of_a_file_are_for_pam_identify_alone(tmp_path):
    path = tmp_path / 'rig.yaml'
    path.write_text(UNCERTAIN)
    assert uncertain_values(path) == {'mass': '5%', 'a2': '10%', 'l0': 0.001}
    plain = tmp_path / 'plain.yaml'
    plain.write_text('pam_sim:\n  ros__parameters:\n    mass: 18.0\n')
    assert uncertain_values(plain) == {}
    assert nominal_joint(path).joint == nominal_joint(plain).joint
    assert 'uncertain.mass' not in read(path)


def test_a_preset_states_none():
    assert uncertain_values('dmsp_20_400n') == {}
