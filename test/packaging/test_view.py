# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What view.launch.py starts, with stand-ins for launch, and the configuration of RViz."""

from pathlib import Path

import ament_index_python.packages as index
import pytest
import yaml
from urdf_parser_py.urdf import URDF

from pam_ros.errors import PamError
from support.launch_stand_in import Loaded

ROOT = Path(__file__).parents[2]
FILE = ROOT / 'launch' / 'view.launch.py'


@pytest.fixture
def installed(monkeypatch):
    """Return the packages that are found; a test may take one away."""
    packages = {'robot_state_publisher', 'rviz2'}

    def find(name):
        if name not in packages:
            raise index.PackageNotFoundError(name)
        return '/opt'

    monkeypatch.setattr(index, 'get_package_prefix', find)
    return packages


@pytest.fixture
def view(monkeypatch, installed):
    """Return the launch file, loaded with stand-ins that remember what they get."""
    return Loaded(monkeypatch, FILE)


@pytest.mark.parametrize('model', ['rig', 'antagonistic_pair'])
def test_it_publishes_the_description_of_the_model(view, model):
    nodes = view.nodes(f'model:={model}', 'namespace:=left', 'use_sim_time:=true')
    publisher, rviz = nodes['robot_state_publisher'], nodes['rviz2']
    assert (publisher.package, rviz.package) == ('robot_state_publisher', 'rviz2')
    time, description = publisher.parameters
    text, kind = description['robot_description']
    assert kind is str
    assert text == (ROOT / 'urdf' / f'{model}.urdf').read_text(encoding='utf-8')
    assert publisher.namespace == rviz.namespace == 'left'
    assert time == rviz.parameters[0] == {'use_sim_time': True}


def test_a_description_of_ones_own_is_read_from_its_path(view, tmp_path):
    own = tmp_path / 'arm.urdf'
    own.write_text('<robot name="arm"><link name="world"/></robot>', encoding='utf-8')
    publisher = view.nodes(f'model:={own}')['robot_state_publisher']
    assert publisher.parameters[1]['robot_description'][0] == own.read_text(encoding='utf-8')


def test_a_model_that_there_is_not_is_refused_with_those_that_there_are(view):
    with pytest.raises(PamError, match='model = arm is not allowed: give antagonistic_pair, rig'):
        view.nodes('model:=arm')


def test_without_rviz_it_starts_where_rviz_is_not_installed(view, installed):
    installed.remove('rviz2')
    assert set(view.nodes('rviz:=false')) == {'robot_state_publisher'}
    with pytest.raises(PamError, match=r'rviz2 is not installed: .*, or rviz:=false'):
        view.nodes()


def test_a_missing_publisher_is_named(view, installed):
    installed.remove('robot_state_publisher')
    with pytest.raises(PamError, match=r'robot_state_publisher is not installed: .*-publisher$'):
        view.nodes('rviz:=false')


def test_rviz_shows_the_model_from_its_root(view):
    rviz = view.nodes()['rviz2']
    option, path = rviz.arguments
    assert option == '-d'
    shown = yaml.safe_load(Path(path).read_text(encoding='utf-8'))['Visualization Manager']
    for file in (ROOT / 'urdf').glob('*.urdf'):
        described = URDF.from_xml_string(file.read_bytes())
        assert shown['Global Options']['Fixed Frame'] == described.get_root()
    model = next(d for d in shown['Displays'] if d['Class'].endswith('/RobotModel'))
    # Relative, so that it is found in a namespace; latched, as robot_state_publisher sends it.
    assert model['Description Topic']['Value'] == 'robot_description'
    assert model['Description Topic']['Durability Policy'] == 'Transient Local'
    assert model['Enabled'] is True
