# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_command set``, ``get``, ``list`` and ``call`` next to running programs."""

import pytest
from sensor_msgs.msg import JointState
from std_srvs.srv import Empty

from support.commanding import command
from support.ends import ends
from support.harness import Program

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

FRICTION = 'effects.coulomb_friction.level'
RIG = {'muscle': 'dmsp_20_400n', 'publish_rate': 50.0}
RIG_OF_CONTROL = {'muscle': 'dmsp_20_400n'}
SIM = ('--node', '/pam_sim')


def test_parameters_are_set_together_or_not_at_all(peer):
    with Program('pam_sim', parameters=RIG):
        end = command('set', FRICTION, '4', 'mass:=12kg', *SIM)
        assert (end.code, end.output) == (0, f'{FRICTION}: 4.0\nmass: 12.0\n')
        assert peer.get('pam_sim', FRICTION, 'mass') == [4.0, 12.0]
        for words, expected in (
            (['zeta', '0.2', 'mass', '-4'], ['/pam_sim refuses', 'mass', 'none of them']),
            (['zeta', '0.2', 'p_min', '5bar', 'p_max', '4bar'], ['p_min', 'none of them']),
            (['zeta', '0.2', 'muscle', 'dmsp_10'], ['read-only', 'muscle']),
            (['effects.coulomb_fricton.level', '4'], [f'was {FRICTION} meant']),
            (['mass', '4mm'], ["'mm'", 'kg']),
            (['mass', 'much'], ["mass 'much'"]),
        ):
            end = command('set', *words, *SIM)
            assert end.code == 2, end
            assert end.sentence.startswith('pam_command: ')
            for word in expected:
                assert word in end.sentence
        assert peer.get('pam_sim', FRICTION, 'mass', 'zeta')[:2] == [4.0, 12.0]
        assert peer.get('pam_sim', 'zeta') != [0.2]


def test_a_name_that_two_nodes_have_needs_a_node(peer):
    with Program('pam_sim', parameters=RIG), Program('pam_control', parameters=RIG_OF_CONTROL):
        peer.until(
            lambda: {'pam_sim', 'pam_control'} <= set(peer.node.get_node_names()), 'both nodes'
        )
        end = command('set', 'mass', '12', peer=peer)
        assert (end.code, end.sentence) == (
            2,
            'pam_command: /pam_control, /pam_sim have mass: choose one with --node, as in '
            '--node /pam_control',
        )
        end = command('get', 'mass', peer=peer)
        assert (end.code, end.output) == (0, '/pam_control mass: 20.0\n/pam_sim mass: 20.0\n')
        assert command('set', 'mass', '12', '--node', 'pam_control').code == 0
        assert peer.get('pam_sim', 'mass') + peer.get('pam_control', 'mass') == [20.0, 12.0]
        # Only one of them has this.
        end = command('get', 'publish_rate', 'physics_rate', peer=peer)
        assert end.output == 'publish_rate: 50.0\nphysics_rate: 1000.0\n'
        end = command('get', 'physics_rate', 'state_rate', peer=peer)
        assert (end.code, 'physics_rate, state_rate' in end.sentence) == (2, True)


def test_a_list_is_that_of_the_program_itself():
    with Program('pam_sim', parameters=RIG):
        listed = command('list', 'coulomb', *SIM)
        nothing = command('list', 'nonsense', *SIM)
    with Program('pam_sim', '--', '--parameters', 'coulomb') as program:
        assert program.wait() == 0
        own = program.output
    assert (listed.code, listed.output) == (0, own)
    assert FRICTION in own
    assert (nothing.code, "'nonsense'" in nothing.sentence) == (2, True)


def test_services_are_called_and_their_answers_printed(peer):
    states = peer.collect(JointState, 'joint_states')
    given = {**RIG, 'command_timeout': 0.0, 'vent_time': 0.0}
    with Program('pam_sim', parameters=given):
        assert command('pressure', '3bar').code == 0
        peer.until(lambda: states and states[-1].position[0] > 0.03, 'the load to move')
        end = command('call', 'step', *SIM)
        assert (end.code, 'not paused' in end.sentence) == (2, True)
        end = command('call', 'pause', 'true', *SIM)
        assert (end.code, end.output) == (0, 'paused\n')
        assert command('call', '/pam_sim/step').code == 0
        end = command('call', 'reset', *SIM)
        assert (end.code, end.output) == (0, 'at the initial state\n')
        peer.until(lambda: states[-1].position[0] < 0.0, 'the initial state')
        for words, expected in (
            (['pause', *SIM], 'true or false'),
            (['reset', 'true', *SIM], 'takes no value'),
            (['/pam_sim/get_parameters'], 'rcl_interfaces/srv/GetParameters'),
            (['/a b'], 'not the name of a service'),
        ):
            end = command('call', *words)
            assert end.code == 2, end
            assert expected in end.sentence
        end = command('call', 'rest', *SIM, wait=('--wait', '2'))
        assert end.code == 1
        assert 'pam_sim/pause, pam_sim/reset, pam_sim/step' in end.sentence


def test_an_empty_service_of_another_node(peer):
    called = []

    def serve(request, response):
        called.append(request)
        return response

    name = peer.node.get_name()
    peer.node.create_service(Empty, '~/zero', serve)
    end = command('call', 'zero', '--node', name, peer=peer)
    assert (end.code, end.output) == (0, 'done\n')
    assert len(called) == 1


def test_no_node_is_one_sentence(domain):
    for words, missing in (
        (['get', 'mass'], 'no node with parameters in the namespace /'),
        (['set', 'mass', '4', '--node', 'pam_sim'], 'no node /pam_sim with parameters'),
        (['call', 'reset'], "no service 'reset' in the namespace /"),
    ):
        end = command(*words, wait=('--wait', '1'))
        assert end.code == 1
        assert missing in end.sentence
        assert f'ROS_DOMAIN_ID {domain}' in end.sentence


def test_bad_arguments_end_it_with_a_sentence():
    refused = [
        ([], ['ACTION']),
        (['--', 'presure', '1bar'], ['presure', 'pressure']),
        (['--', 'pressure'], ['VALUE']),
        (['--', 'pressure', '-1furlong'], ['furlong', 'kPa']),
        (['--', 'pressure', '1bar', '--wait', '-1'], ['--wait -1', '0 to 3600 s']),
        (['--', 'pressure', '1bar', '--hold', 'inf'], ['--hold inf']),
        (['--', 'position', '60', 'mm', '1'], ['1']),
        (['--', 'set', 'mass'], ['mass has no value']),
        (['--', 'call', 'pause', 'perhaps'], ['perhaps', 'true']),
        (['--', 'get', 'mass', '--nonsense'], ['--nonsense']),
    ]
    found = ends('pam_command', [arguments for arguments, _ in refused])
    for (arguments, words), end in zip(refused, found, strict=True):
        assert (end.code, end.sentence.partition(':')[0].split()[0]) == (2, 'pam_command'), (
            arguments
        )
        assert 'Traceback' not in end.output
        for word in words:
            assert word in end.sentence, (arguments, word)
