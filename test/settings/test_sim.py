# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The settings of the simulator, put together and checked as a whole."""

from pathlib import Path

import pytest

from pam_ros.errors import ParameterError
from pam_ros.rig import statics
from pam_ros.settings.braid import BRAID
from pam_ros.settings.files import read
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked, rig_table
from pam_ros.simulator.initial import initial_state

CONFIG = Path(__file__).parents[2] / 'config'
MUSCLES = sorted(path.stem for path in (CONFIG / 'muscles').glob('*.yaml'))


def built(given):
    """Return the simulation of a node that was started with *given*."""
    scene = Scene(given)
    return scene.build(checked(scene.table(), given))


def test_sim_yaml_lists_all_that_is_not_the_rig_with_its_defaults():
    values = read(CONFIG / 'sim.yaml')
    # ROS has no empty list in a file: names are shown in a comment there.
    left_out = {*rig_table(), *BRAID, 'muscle', 'muscles', 'joint_names'}
    beside = {n: entry for n, entry in Scene({}).table().items() if n not in left_out}
    assert values == {name: default for name, (_, default, _) in beside.items()}
    assert {n: type(v) for n, v in values.items()} == {
        n: kind for n, (kind, _, _) in beside.items()
    }


RIGS = sorted((CONFIG / 'rigs').glob('*.yaml'))
ONE_MUSCLE = [path for path in RIGS if 'joint' not in read(path)]


@pytest.mark.parametrize('name', [*MUSCLES, *map(str, ONE_MUSCLE)])
def test_every_muscle_and_rig_of_the_package_can_be_simulated(name):
    now = built({'muscle': name})
    ((pressure,), (position,), (velocity,)) = initial_state(now)
    assert (pressure, velocity) == (0.0, 0.0)
    (joint,) = now.joints
    if not joint.muscle.is_load_only:
        kappa = position / joint.muscle.l0
        weight = float(statics.weight(joint, 0.0))
        assert joint.muscle.force(0.0, kappa) == pytest.approx(weight, rel=1e-9)


@pytest.mark.parametrize('path', [path for path in RIGS if path not in ONE_MUSCLE])
def test_every_joint_of_the_package_can_be_simulated_and_is_no_muscle(path):
    now = built(read(path))
    assert len(now.muscle_names) == len(now.joints[0].muscles) > 1
    with pytest.raises(ParameterError, match=r'describes a joint .* not a muscle: '):
        built({'muscle': str(path)})


def test_values_of_a_muscle_are_defaults_only():
    assert Scene({'muscle': 'dmsp_10'}).table()['l0'][1] == 0.25
    assert built({'muscle': 'dmsp_10', 'l0': 0.3}).joints[0].muscle.l0 == 0.3


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        (
            {'initial.pressure': 700e3},
            r'initial.pressure = 700000 Pa is outside p_min = 0 to p_max',
        ),
        (
            {'initial.at_rest': False, 'initial.position': 0.5},
            r'initial.position = 0.5 m is not possible with a muscle of 0.4 m: give -0.08 to 0.38',
        ),
        ({'publish_rate': 2000.0}, r'publish_rate = 2000 Hz is above physics_rate = 1000 Hz'),
        ({'mass': 1e-6}, 'does not resolve a mass'),
    ],
)
def test_what_does_not_go_together_is_refused(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        built(given)


def test_a_position_out_of_reach_matters_only_where_it_is_used():
    assert initial_state(built({'initial.position': 0.5}))[1][0] < 0.1
