# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The layout for PlotJuggler: what it draws is there, under the names PlotJuggler gives it."""

import xml.etree.ElementTree as ET
from importlib import import_module
from pathlib import Path

import pytest
from sensor_msgs.msg import JointState

from support.harness import Program

pytestmark = pytest.mark.at_any_pace

LAYOUT = Path(__file__).parents[2] / 'config' / 'plotjuggler.xml'
ROOT = ET.parse(LAYOUT).getroot()
CURVES = [curve.get('name') for curve in ROOT.iter('curve')]
STREAMER = 'ROS2 Topic Subscriber'


def test_position_force_stiffness_and_pressure_are_laid_out():
    drawn = [{curve.get('name') for curve in area.iter('curve')} for area in ROOT.iter('DockArea')]
    for name in ('joint_states/pam/position', 'force/data', 'stiffness/data'):
        assert sum(f'/{name}' in curves for curves in drawn) == 1
    assert {'/pressure/fluid_pressure', '/pressure_command/data'} in drawn
    assert all(area.get('name') for area in ROOT.iter('DockArea'))


def test_every_area_has_its_share():
    for splitter in ROOT.iter('DockSplitter'):
        assert len(splitter) == int(splitter.get('count'))
        sizes = [float(size) for size in splitter.get('sizes').split(';')]
        assert len(sizes) == len(splitter)
        assert abs(sum(sizes) - 1.0) < 1e-9


def test_the_streamer_that_it_starts_subscribes_to_all_that_is_drawn():
    assert ROOT.find('previouslyLoaded_Streamer').get('name') == STREAMER
    (plugin,) = ROOT.find('Plugins')
    assert plugin.get('ID') == STREAMER
    selected = plugin.find('selected_topics').get('value').split(';')
    assert {'/' + curve.split('/')[1] for curve in CURVES} == set(selected)


def test_the_chambers_pressure_is_drawn_less_the_ambient_one(peer):
    with Program('pam_sim'):
        (ambient,) = peer.get('pam_sim', 'ambient_pressure')
    offset = ROOT.find('.//curve[@name="/pressure/fluid_pressure"]/transform/options')
    assert float(offset.get('value_offset')) == -ambient
    assert float(offset.get('value_scale')) == 1.0
    assert float(offset.get('time_offset')) == 0.0


def test_every_curve_is_a_number_on_a_topic_of_the_simulator(peer):
    """PlotJuggler names what a JointState says of a joint after it: topic/joint/position."""
    states = peer.collect(JointState, '/joint_states')
    with Program('pam_sim'):
        peer.more(states)
        topics = {name: get_message(kind) for name, (kind,) in graph(peer).items()}
    for curve in CURVES:
        _, topic, *path = curve.split('/')
        kind = topics[f'/{topic}']
        if kind is JointState:
            joint, field = path
            assert joint in states[0].name
            assert len(getattr(states[0], field)) == len(states[0].name)
        else:
            (field,) = path
            assert kind.get_fields_and_field_types()[field] == 'double'


def get_message(kind):
    """Return the class of a type such as std_msgs/msg/Float64."""
    package, _, name = kind.rpartition('/')
    return getattr(import_module(package.replace('/', '.')), name)


def graph(peer):
    """Return the topics that the simulator has, with their types, once all are known."""
    wanted = {'/' + curve.split('/')[1] for curve in CURVES}

    def known():
        found = dict(peer.node.get_topic_names_and_types())
        return found if wanted <= found.keys() else None

    return peer.until(known, 'the topics of the layout')
