# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_command position`` and ``stiffness`` next to a controller."""

import re

import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from support.commanding import command
from support.harness import Program

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

MUSCLE = {'muscle': 'dmsp_20_400n'}
LOCKSTEP = {'time_mode': 'lockstep'}
FOLLOWS = {'use_sim_time': True}


def terms(messages):
    """Return the newest terms of the law by name."""
    return dict(zip(messages[-1].name, messages[-1].position, strict=True))


def test_a_position_is_followed_or_refused_with_the_reason(peer):
    states = peer.collect(JointState, 'joint_states')
    with (
        Program('pam_sim', parameters={**MUSCLE, **LOCKSTEP}),
        Program('pam_control', parameters={**MUSCLE, **FOLLOWS}),
    ):
        peer.more(states, 50)
        end = command('position', '60mm')
        assert (end.code, end.sentence) == (
            0,
            '/pam_control received 0.06 m on /position_reference',
        )
        peer.until(lambda: abs(states[-1].position[0] - 0.06) < 5e-4, 'the position')
        for text, words in (
            ('60', ['/pam_control refuses it: reference 60 m is out of reach', 'is in m)']),
            ('-60mm', ['reference -0.06 m is out of reach: this rig can hold its load at ']),
            ('20deg', ['20deg is in rad', 'a length']),
        ):
            end = command('position', text)
            assert end.code == 2, end
            for word in words:
                assert word in end.sentence
        assert command('call', 'enable', 'false', '--node', 'pam_control').code == 0
        end = command('position', '50mm')
        assert end.code == 2
        assert 'position_reference is ignored: disabled' in end.sentence


def test_an_angle_and_a_stiffness(peer):
    states = peer.collect(JointState, 'pam_control/state')
    pair = {'joint': 'antagonistic'}
    with (
        Program('pam_sim', parameters={**pair, **LOCKSTEP}),
        Program('pam_control', parameters={**pair, **FOLLOWS}),
    ):
        peer.more(states, 20)
        assert command('position', '5deg').code == 0
        peer.until(lambda: abs(terms(states)['reference'] - 0.0872665) < 1e-4, 'the angle')
        refused = command('stiffness', '1e6')
        assert refused.code == 2
        low, high = re.search(r'stiffness of (\S+) to (\S+) N m/rad', refused.sentence).groups()
        wanted = 0.5 * (float(low) + float(high))
        assert command('stiffness', f'{wanted:g}Nm/rad').code == 0
        peer.until(
            lambda: terms(states)['co_contraction'] == pytest.approx(wanted, rel=1e-3),
            'the stiffness',
        )


def test_a_controller_that_tells_nothing_gets_plausible_positions(peer):
    received = []
    peer.node.create_subscription(Float64, 'position_reference', received.append, 10)
    other = peer.node.create_publisher(Float64, 'position_reference', 10)

    end = command('position', '20deg', peer=peer)
    name = peer.node.get_fully_qualified_name()
    assert end.code == 0
    warning, line = end.output.splitlines()
    assert warning.startswith(f'pam_command: warning: {name} publishes /position_reference')
    assert line == f'{name} received 0.349066 rad on /position_reference'
    end = command('position', '60', peer=peer)
    assert (end.code, 'not a plausible position' in end.sentence) == (2, True)
    assert [message.data for message in received] == [pytest.approx(0.349066, rel=1e-5)]
    peer.node.destroy_publisher(other)


def test_no_controller_is_one_sentence():
    with Program('pam_sim', parameters=MUSCLE):
        end = command('position', '60mm', wait=('--wait', '4'))
    assert end.code == 1
    assert 'subscribes to /position_reference after 4 s' in end.sentence
    assert '/pam_sim' in end.sentence
