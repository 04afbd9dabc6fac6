# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pages against running programs: topics, services, parameters, defaults, commands, figures."""

import re
import subprocess
import sys

import numpy as np
import pytest
from rcl_interfaces.srv import ListParameters
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from support.ends import ends
from support.harness import DEADLINE, Program
from support.pages import (
    CONTROLLER,
    DOCS,
    PAGES,
    SIMULATOR,
    blocks,
    code,
    commands,
    names,
    part,
    rows,
    text_of,
)

pytestmark = pytest.mark.at_any_pace

# What every node has: parameters, logging, its description.
OF_EVERY_NODE = ('rcl_interfaces/', 'type_description_interfaces/')
TEN_MINUTES = DOCS / 'tutorials' / 'muscle_in_ten_minutes.md'
OWN_MUSCLE = DOCS / 'tutorials' / 'your_own_muscle_and_joint.md'
SETTLED = 8.0  # s after which the load rests
SETTINGS = ('effects.', 'initial.', 'sensor.')
OF_AN_EXAMPLE = 'effects.choked_valve.slowness'  # the effect that a tutorial writes
DRY_RUNS = [
    words[words.index('--ros-args') + 1 :]
    for page in PAGES
    for words in commands(page)
    if {'--dry-run', '--ros-args'} <= set(words)
]


def table_of(page, name):
    """Return what a part of a page says: name -> type, `/` before what is absolute."""
    found = {}
    for name_cell, type_cell, _ in rows(part(page, name)):
        (kind,) = code(type_cell)
        found.update(dict.fromkeys(code(name_cell.partition('(')[0]), kind))
    return found


ONE, SEVERAL = table_of(SIMULATOR, 'interface'), table_of(SIMULATOR, 'several')
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
    expected = table_of(CONTROLLER, 'control')
    with Program('pam_control'):
        holds = peer.until(
            lambda: expected.items() <= interface(peer, 'pam_control').items(), 'the table'
        )
        assert holds


def test_the_interface_is_that_of_the_running_controller_of_a_pair(peer):
    expected = {**table_of(CONTROLLER, 'control'), **table_of(CONTROLLER, 'pair')}
    for of_one in ('pressure', 'pressure_command'):
        del expected[of_one]
    with Program('pam_control', parameters={'joint': 'antagonistic'}):
        holds = peer.until(
            lambda: expected.items() <= interface(peer, 'pam_control').items(), 'the table'
        )
        assert holds
        assert 'pressure_command' not in interface(peer, 'pam_control')


def test_parameters_exist_and_have_their_defaults(peer):
    named = {name for page in PAGES for name in names(page) if name.startswith(SETTINGS)}
    with Program('pam_sim'):
        known = peer.call(ListParameters, 'pam_sim/list_parameters').result.names
        for name in named - {OF_AN_EXAMPLE}:
            stem, *rest = re.split('[<*]', name)
            if rest:
                assert any(one.startswith(stem) for one in known), name
            else:
                assert name in known
        for name_cell, default_cell, _ in rows(part(SIMULATOR, 'parameters')):
            of_row = [name for name in code(name_cell) if '<' not in name]
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


def seconds(state):
    return stamp(state) * 1e-9


def later(peer, states):
    """Return the state after a load has had the time to come to rest."""
    peer.more(states)
    begun = seconds(states[-1])
    peer.until(lambda: seconds(states[-1]) > begun + SETTLED, 'the load to rest')
    return states[-1]


def test_the_first_commands_lead_to_the_result_on_the_page(peer):
    page = text_of(TEN_MINUTES)
    states = peer.collect(JointState, 'joint_states')

    def command(pascals):
        peer.publish(Float64(data=pascals), 'pressure_command')
        return later(peer, states)

    # Few states: a test that falls behind reads those from before the command.
    time = {'time_mode': 'scaled', 'speed_factor': 10.0, 'publish_rate': 50.0}
    rig = {'muscle': 'dmsp_20_400n', 'command_timeout': 0.0, **time}
    with Program('pam_sim', parameters=rig):
        state = command(300e3)
        assert f'{state.position[0]:.4f} m' in page
        assert f'{state.effort[0]:.1f} N' in page
        assert peer.set_one('pam_sim', command_timeout=1.0).successful
        assert f'{later(peer, states).position[0]:.4f} m' in page
        assert peer.set_one('pam_sim', command_timeout=0.0).successful
        assert peer.set_one('pam_sim', effects__coulomb_friction__level=20.0).successful
        found = [1e3 * command(p).position[0] for p in (0.0, 300e3, 450e3, 300e3)]
        assert str(np.array(found[1:]).round(1)) in page


def test_the_controller_of_the_first_minutes_reaches_its_reference(peer):
    states = peer.collect(JointState, 'joint_states')
    muscle = {'muscle': 'dmsp_20_400n'}
    rig = {**muscle, 'time_mode': 'lockstep', 'effects.coulomb_friction.level': 20.0}
    with (
        Program('pam_sim', parameters=rig),
        Program('pam_control', parameters={**muscle, 'use_sim_time': True}),
    ):
        peer.more(states, 50)
        peer.publish(Float64(data=0.06), 'position_reference')
        assert later(peer, states).position[0] == pytest.approx(0.06, abs=2e-4)


def test_the_file_of_a_self_made_muscle_starts_the_simulator(peer, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (own,) = (one for one in blocks(OWN_MUSCLE, 'python') if 'fit_static_map' in one)
    subprocess.run([sys.executable, '-c', own], check=True, timeout=DEADLINE)
    with Program('pam_sim', '--params-file', 'my_muscle.yaml'):
        assert peer.get('pam_sim', 'l0', 'p_max', 'mass') == [0.3, 400e3, 5.0]
