# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What view.launch.py starts, with stand-ins for launch, and what RViz is told to show."""

import runpy
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest
import yaml
from urdf_parser_py.urdf import URDF

ROOT = Path(__file__).parents[2]
FILE = ROOT / 'launch' / 'view.launch.py'
MODULES = (
    'launch',
    'launch.actions',
    'launch.conditions',
    'launch.substitutions',
    'launch_ros',
    'launch_ros.actions',
    'launch_ros.parameter_descriptions',
)


class Configuration:
    """As LaunchConfiguration: looks its name up in the context."""

    def __init__(self, name):
        self.name = name

    def perform(self, context):
        return context[self.name]


@pytest.fixture
def view(monkeypatch):
    """Return what the launch file defines, loaded with stand-ins that remember what they get."""
    stand_ins = {
        'LaunchConfiguration': Configuration,
        'Node': SimpleNamespace,
        'ParameterValue': lambda value, value_type: (value, value_type),
        'IfCondition': lambda value: value,
        'DeclareLaunchArgument': lambda name, **words: SimpleNamespace(name=name, **words),
        'OpaqueFunction': lambda function: function,
        'LaunchDescription': list,
        'LaunchContext': dict,
    }
    for name in MODULES:
        module = ModuleType(name)
        for stand_in, value in stand_ins.items():
            setattr(module, stand_in, value)
        monkeypatch.setitem(sys.modules, name, module)
    return runpy.run_path(str(FILE))


@pytest.mark.parametrize('model', ['rig', 'antagonistic_pair'])
def test_it_publishes_the_description_of_the_model(view, model):
    publisher, rviz = view['start']({'model': model})
    assert (publisher.package, publisher.executable) == 2 * ('robot_state_publisher',)
    _, description = publisher.parameters
    text, kind = description['robot_description']
    assert kind is str
    assert text == (ROOT / 'urdf' / f'{model}.urdf').read_text(encoding='utf-8')
    assert (rviz.package, rviz.executable) == 2 * ('rviz2',)
    assert rviz.condition.name == 'rviz'
    assert publisher.namespace.name == rviz.namespace.name == 'namespace'


def test_a_description_of_ones_own_is_read_from_its_path(view, tmp_path):
    own = tmp_path / 'arm.urdf'
    own.write_text('<robot name="arm"><link name="world"/></robot>', encoding='utf-8')
    publisher, _ = view['start']({'model': str(own)})
    assert publisher.parameters[1]['robot_description'][0] == own.read_text(encoding='utf-8')


def test_all_that_is_looked_up_is_an_argument_with_a_default(view):
    arguments = view['generate_launch_description']()[:-1]
    assert {argument.name for argument in arguments} == {
        'model', 'rviz', 'namespace', 'use_sim_time',
    }  # fmt: skip
    assert all(isinstance(argument.default_value, str) for argument in arguments)


def test_rviz_shows_the_model_from_its_root(view):
    _, rviz = view['start']({'model': 'rig'})
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
