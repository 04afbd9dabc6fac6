# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""README.md against running programs: topics, services, parameters, defaults, commands."""

import re
import subprocess
import sys

import numpy as np
import pytest
from rcl_interfaces.srv import ListParameters
from sensor_msgs.msg import JointState

from support.ends import ends
from support.harness import Program, lose_nothing
from support.pages import README, blocks, commands, names, part, rows

pytestmark = pytest.mark.at_any_pace

# What every node has: parameters, logging, its description.
OF_EVERY_NODE = ('rcl_interfaces/', 'type_description_interfaces/')
LENGTH = 2700  # states of 2 ms, so that the error decays to micrometres
AGAIN = 500  # of a second run
SETTINGS = ('effects.', 'initial.', 'sensor.')
DRY_RUNS = [
    words[words.index('--ros-args') + 1 :] for words in commands(README) if '--dry-run' in words
]


def in_code(cell):
    return re.findall(r'`([^`]+)`', cell)


def told(name):
    """Return what a part of the page says: name -> type, `/` before what is absolute."""
    found = {}
    for name_cell, type_cell, _ in rows(part(README, name)):
        (kind,) = in_code(type_cell)
        found.update(dict.fromkeys(in_code(name_cell.partition('(')[0]), kind))
    return found


ONE, SEVERAL = told('interface'), told('several')
OF_ALL = {name: kind for name, kind in ONE.items() if name.startswith(('/', '~'))}


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def seen(program, get):
    """Return the topics or services of a running program as the tables name them."""
    own = {}
    for name, (kind, *_) in get(program, '/'):
        if not kind.startswith(OF_EVERY_NODE):
            short = name.replace(f'/{program}/', '~/')
            own[short if name in ('/clock', '/diagnostics') else short.lstrip('/')] = re.sub(
                '/(msg|srv)/', '/', kind
            )
    return own


def interface(peer, program):
    """Return all topics and services of a running program as the tables name them."""
    node = peer.node
    if (program, '/') not in node.get_node_names_and_namespaces():
        return {}
    getters = (
        node.get_publisher_names_and_types_by_node,
        node.get_subscriber_names_and_types_by_node,
        node.get_service_names_and_types_by_node,
    )
    return {name: kind for get in getters for name, kind in seen(program, get).items()}


@pytest.mark.parametrize(
    ('parameters', 'expected'),
    [({}, ONE), ({'muscles': '[left,right]', 'time_mode': 'scaled'}, SEVERAL | OF_ALL)],
    ids=['one', 'several'],
)
def test_the_interface_is_that_of_the_running_simulator(peer, parameters, expected):
    with Program('pam_sim', parameters=parameters):
        peer.until(lambda: set(expected) <= set(interface(peer, 'pam_sim')), ', '.join(expected))
        assert interface(peer, 'pam_sim') == expected


def test_the_interface_is_that_of_the_running_controller(peer):
    expected = told('control')
    with Program('pam_control'):
        peer.until(lambda: expected.items() <= interface(peer, 'pam_control').items(), 'the table')


def test_the_interface_is_that_of_the_running_controller_of_a_pair(peer):
    expected = {**told('control'), **told('pair')}
    for of_one in ('pressure', 'pressure_command'):
        del expected[of_one]
    with Program('pam_control', parameters={'joint': 'antagonistic'}):
        peer.until(lambda: expected.items() <= interface(peer, 'pam_control').items(), 'the table')
        assert 'pressure_command' not in interface(peer, 'pam_control')


def test_parameters_exist_and_have_their_defaults(peer):
    named = [name for name in names(README) if name.startswith(SETTINGS)]
    with Program('pam_sim'):
        known = peer.call(ListParameters, 'pam_sim/list_parameters').result.names
        for name in named:
            if '<' in name:
                assert any(one.startswith(name.partition('<')[0]) for one in known), name
            else:
                assert name in known
        for name_cell, default_cell, _ in rows(part(README, 'parameters')):
            of_row = [name for name in in_code(name_cell) if '<' not in name]
            assert set(of_row) <= set(known)
            for name, default in zip(of_row, default_cell.split(', '), strict=False):
                (value,) = peer.get('pam_sim', name)
                if re.match(r'\d', default):
                    assert value == float(default.partition(' ')[0]), name
                elif default.startswith('`'):
                    assert value == default.strip('`'), name


@pytest.mark.usefixtures('domain')
def test_the_excitation_plans_as_shown():
    assert DRY_RUNS
    for end in ends('pam_excite', [[*arguments, '--', '--dry-run'] for arguments in DRY_RUNS]):
        assert end.code == 0, end.output
        assert 'total' in end.output


def positions_under(peer, example, length):
    """Return the first positions of a simulator in lockstep with a controller."""
    states = peer.collect(JointState, 'joint_states')
    parameters = {'muscle': 'dmsp_20_400n', 'time_mode': 'lockstep', **lose_nothing()}
    with Program('pam_sim', parameters=parameters):
        peer.more(
            states
        )  # told again and again to a controller to come: all that follow are heard
        controller = subprocess.Popen([sys.executable, '-c', example])
        try:
            peer.until(lambda: len(states) > length + 50 or controller.poll(), 'the states')
        finally:
            controller.kill()
            controller.wait()
    told = {stamp(message): message.position[0] for message in states}  # one may be told twice
    return [told[time] for time in sorted(told)][:length]


def test_the_controller_reaches_its_goal_the_same_way_each_time(peer):
    (example,) = (one for one in blocks(README, 'python') if 'rclpy' in one)
    first = positions_under(peer, example, LENGTH)
    assert len(first) == LENGTH
    np.testing.assert_allclose(first[-100:], 0.06, atol=5e-6)
    assert positions_under(peer, example, AGAIN) == first[:AGAIN]
