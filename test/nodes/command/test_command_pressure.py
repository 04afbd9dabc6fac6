# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_command pressure`` next to simulators, and next to a rig that is none of this package."""

import pytest
from sensor_msgs.msg import FluidPressure
from std_msgs.msg import Float64, Float64MultiArray

from support.commanding import WAIT, command, said
from support.harness import Program

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

AMBIENT = 101325.0
RIG = {'publish_rate': 50.0, 'muscle': 'dmsp_20_400n'}
HELD = {**RIG, 'command_timeout': 0.0}
TWO = {**HELD, 'muscles': ['left', 'right']}


def gauge(messages):
    """Return the newest pressure or pressures in Pa, gauge."""
    newest = messages[-1]
    if isinstance(newest, FluidPressure):
        return pytest.approx(newest.fluid_pressure - AMBIENT)
    return [pytest.approx(one - AMBIENT) for one in newest.data]


def test_it_is_repeated_until_ctrl_c_and_then_the_muscle_vents(peer):
    found = peer.collect(FluidPressure, 'pressure')
    with Program('pam_sim', parameters=RIG):
        with Program('pam_command', '--', 'pressure', '300kPa', *WAIT) as program:
            peer.until(lambda: found and gauge(found) == 300e3, 'the pressure')
            # Twice the time-out, in simulated time: without a repetition it would have vented.
            peer.more(found, 100)
            assert gauge(found) == 300e3
            program.interrupt()
            assert program.wait() == 0
            assert said(program) == (
                '/pam_sim received 300000 Pa on /pressure_command, repeated 10 times a second '
                'until Ctrl-C: it vents 1 s after the last command\n'
            )
        peer.until(lambda: gauge(found) == 0.0, 'the muscle to vent')


def test_one_command_is_sufficient_without_a_time_out(peer):
    found = peer.collect(FluidPressure, 'arm/pressure')
    with Program('pam_sim', '-r', '__ns:=/arm', parameters=HELD):
        end = command('pressure', '2', 'bar', ros=('-r', '__ns:=/arm'))
        assert (end.code, end.sentence) == (
            0,
            '/arm/pam_sim received 200000 Pa on /arm/pressure_command, and keeps this command',
        )
        peer.until(lambda: found and gauge(found) == 200e3, 'the pressure')
        # The same topic, by a remapping.
        end = command('pressure', '1bar', ros=('-r', 'pressure_command:=/arm/pressure_command'))
        assert end.code == 0
        peer.until(lambda: gauge(found) == 100e3, 'the other pressure')


def test_what_the_rig_does_not_permit_is_refused_and_not_sent(peer):
    found = peer.collect(FluidPressure, 'pressure')
    with Program('pam_sim', parameters=HELD):
        for text, words in (
            ('450', ['450kPa', '450bar', '600000 Pa']),
            ('9bar', ['9bar (900000 Pa)', '/pam_sim', '600000 Pa']),
            ('-1kPa', ['-1kPa', '0 to 600000 Pa']),
        ):
            end = command('pressure', text)
            assert end.code == 2, end
            assert end.sentence.startswith('pam_command: ')
            for word in words:
                assert word in end.sentence
        end = command('pressure', '1bar', '2bar')
        assert (end.code, end.sentence) == (
            2,
            'pam_command: 2 pressures for one muscle of /pam_sim: give one',
        )
        end = command('pressure', 'pam:=1bar', wait=('--wait', '4'))
        assert end.code == 1
        assert end.sentence.endswith(
            '/pressure_command has a subscriber: leave out the names of muscles'
        )
        peer.more(found, 5)
        assert gauge(found) == 0.0
        assert command('pressure', '450Pa').code == 0
        peer.until(lambda: gauge(found) == 450.0, 'the pressure with a unit')


def test_several_muscles_in_order_and_by_name(peer):
    found = peer.collect(Float64MultiArray, 'pressures')
    with Program('pam_sim', parameters=TWO):
        assert command('pressure', '300kPa', '2bar').code == 0
        peer.until(lambda: found and gauge(found) == [300e3, 200e3], 'both in order')
        assert command('pressure', 'right:=300kPa', 'left:=100kPa').code == 0
        peer.until(lambda: gauge(found) == [100e3, 300e3], 'both by name')
        for values, words in (
            (['1bar'], ['1 pressure for 2 muscles', 'left, right']),
            (['left:=1bar'], ['left, right', 'muscle_topics']),
            (['1bar', '7bar'], ['/pam_sim (right)', '600000 Pa']),
        ):
            end = command('pressure', *values)
            assert end.code == 2, end
            for word in words:
                assert word in end.sentence
        peer.more(found, 5)
        assert gauge(found) == [100e3, 300e3]


def test_one_of_several_muscles_by_its_own_topic(peer):
    found = peer.collect(Float64MultiArray, 'pressures')
    given = {**TWO, 'muscle_topics': True, 'right.p_max': 400e3}
    with Program('pam_sim', parameters=given):
        assert command('pressure', 'right:=3bar').code == 0
        peer.until(lambda: found and gauge(found) == [0.0, 300e3], 'the right one')
        end = command('pressure', 'right:=5bar')
        assert (end.code, '/pam_sim (right) permits 0 to 400000 Pa' in end.sentence) == (2, True)
        # In the namespace of a muscle the topic is that of a single one, with its limits.
        end = command('pressure', '5bar', ros=('-r', '__ns:=/right'))
        assert (end.code, '/pam_sim (right) permits 0 to 400000 Pa' in end.sentence) == (2, True)


def test_another_publisher_is_named(peer):
    with Program('pam_sim', parameters=HELD):
        other = peer.node.create_publisher(Float64, 'pressure_command', 10)
        peer.until(other.get_subscription_count, 'the simulator')
        end = command('pressure', '1bar')
        assert end.code == 0
        first, last = end.output.splitlines()
        name = peer.node.get_fully_qualified_name()
        assert first == (
            f'pam_command: warning: {name} commands pressures as well: the rig follows the '
            'newest command of either'
        )
        assert last.startswith('/pam_sim received 100000 Pa')


def test_a_rig_that_tells_nothing_is_commanded_until_it_ends(peer):
    received = []
    valve = peer.node.create_subscription(Float64, 'pressure_command', received.append, 10)
    with Program('pam_command', '--', 'pressure', '3bar', *WAIT) as program:
        peer.until(lambda: len(received) > 5, 'commands')
        assert 'warning' not in program.output
        other = peer.node.create_publisher(Float64, 'pressure_command', 10)
        peer.until(lambda: 'warning: ' in program.output, 'the warning of a second publisher')
        peer.node.destroy_publisher(other)
        peer.node.destroy_subscription(valve)
        peer.until(lambda: not program.is_running, 'the end of the program')
        assert program.wait() == 1
        first, _, last = said(program).splitlines()[-3:]
    assert {message.data for message in received} == {300e3}
    assert first.endswith('until Ctrl-C, because its time-out is not known')
    assert last == 'pam_command: no node receives /pressure_command any more'


def test_a_recorder_is_no_rig(tmp_path):
    bag = str(tmp_path / 'bag')
    with Program('pam_record', '--', '-o', bag) as recorder:
        end = command('pressure', '1bar', wait=('--wait', '4'))
        assert recorder.is_running
    assert end.code == 1
    assert end.sentence.startswith('pam_command: no node of a rig subscribes to /pressure_command')
    assert '/pam_record' in end.sentence


def test_a_topic_of_another_type_is_named(peer):
    topic = peer.node.create_subscription(FluidPressure, 'pressure_command', lambda _: None, 10)
    end = command('pressure', '1bar', wait=('--wait', '2'), peer=peer)
    assert end.code == 1
    assert (
        '/pressure_command is sensor_msgs/msg/FluidPressure, not std_msgs/msg/Float64'
        in end.sentence
    )
    peer.node.destroy_subscription(topic)


def test_nothing_there_is_one_sentence_after_one_that_it_waits(domain):
    with Program('pam_command', '--', 'pressure', '1bar', '--wait', '1.5') as program:
        assert program.wait() == 1
        first, last = program.output.splitlines()
    assert first == (
        'pam_command: waits up to 1.5 s for a subscriber of /pressure_command or '
        '/pressure_commands'
    )
    assert f'after 1.5 s in ROS_DOMAIN_ID {domain}, and no other node is there' in last
    assert 'pam_sim' in last


def test_a_rig_in_another_namespace_is_named():
    with Program('pam_sim', '-r', '__ns:=/arm', parameters=HELD):
        assert command('get', 'mass', '--node', '/arm/pam_sim').code == 0
        end = command('pressure', '1bar', wait=('--wait', '4'))
    assert end.code == 1
    assert '/arm/pressure_command exists' in end.sentence
    assert '--ros-args -r __ns:=/arm' in end.sentence


def test_ctrl_c_before_the_rig_is_found(peer):
    with Program('pam_command', '--', 'pressure', '1bar', *WAIT) as program:
        peer.until(lambda: 'waits up to' in program.output, 'the line that it waits')
        program.interrupt()
        assert program.wait() == 130
        assert program.output.endswith('pam_command: interrupted before it was complete\n')
