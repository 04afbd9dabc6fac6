# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The rig that ``pam_excite`` can excite: one muscle on a mass, and a sentence for any other."""

from pathlib import Path

import pytest

from pam_ros.errors import ParameterError
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.settings.excite import experiment, table
from pam_ros.settings.files import read, write
from pam_ros.settings.tables import checked

ANTAGONISTIC = Path(__file__).parents[2] / 'config' / 'antagonistic.yaml'
ALLOWED = 'is not allowed: pam_excite excites only one muscle that moves a mass (joint = load)'


@pytest.mark.parametrize('kind', ARRANGEMENTS, ids=lambda kind: kind.name)
def test_only_one_muscle_on_a_mass_can_be_excited(kind):
    given = {'joint': kind.name, 'muscle': 'dmsp_10'}
    if kind.name == 'load':
        assert experiment(checked(table(given), given)).model.muscle.l0 == 0.25
        return
    with pytest.raises(ParameterError) as refused:
        table(given)
    assert str(refused.value) == f'joint = {kind.name} ({kind.text}) {ALLOWED}'


def test_a_joint_that_does_not_exist_is_refused():
    with pytest.raises(ParameterError) as refused:
        table({'joint': 'shoulder'})
    assert str(refused.value) == f'joint = shoulder {ALLOWED}'


def test_the_file_of_a_joint_is_refused_as_what_it_is_and_not_for_its_names():
    for given, where in (
        (read(ANTAGONISTIC), ''),
        ({'muscle': str(ANTAGONISTIC)}, f'{ANTAGONISTIC}: '),
    ):
        with pytest.raises(ParameterError) as refused:
            table(given)
        assert str(refused.value).startswith(f'{where}joint = antagonistic (two muscles turn ')


def test_the_file_of_a_joint_without_similar_names_is_refused(tmp_path):
    write(tmp_path / 'lever.yaml', {'joint': 'lever', 'crank': 0.05, 'anchor': 0.45})
    with pytest.raises(ParameterError, match=r'lever\.yaml: joint = lever '):
        table({'muscle': str(tmp_path / 'lever.yaml')})
