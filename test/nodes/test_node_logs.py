# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs write to the terminal and to ``/rosout``: the start, waits, and their ends."""

import pytest
from rcl_interfaces.msg import Log
from rclpy.logging import LoggingSeverity
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from support.control_watch import Watch
from support.harness import Program

pytestmark = pytest.mark.at_any_pace
VENTED = ': vented'
BACK = 'commands are received again'


def wait_for(peer, program, words, count=1):
    """Wait until the program has written *words* so many times."""

    def is_written():
        assert program.is_running, program.output
        return program.output.count(words) >= count

    peer.until(is_written, words)


def test_the_line_at_the_start_is_on_rosout_too(peer):
    lines = []
    kept = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    peer.node.create_subscription(Log, '/rosout', lines.append, kept)
    given = ('-r', '__ns:=/left', '-r', 'joint_states:=measured', '-p', 'muscle:=dmsp_10')
    starts = ('simulates the muscle dmsp_10 of', 'controls the joint pam (load; muscle dmsp_10 of')
    with Program('pam_sim', *given) as sim, Program('pam_control', *given) as control:
        for program, start in zip((sim, control), starts, strict=True):

            def found(start=start):
                return [one for one in lines if one.msg.startswith(start)]

            (line,) = peer.until(found, start)
            assert line.level == LoggingSeverity.INFO.value
            assert '/left/pressure_command' in line.msg
            assert '/left/measured' in line.msg
            assert program.output.count(line.msg) == 1


def test_a_simulator_waits_for_the_clock_and_for_commands(peer):
    with Program('pam_sim', parameters={'use_sim_time': True}) as sim:
        wait_for(peer, sim, 'waits for /clock')
        time = 0

        def passes(words):
            nonlocal time
            time += 50_000_000
            clock = Clock()
            clock.clock.sec, clock.clock.nanosec = divmod(time, 10**9)
            peer.publish(clock, '/clock')
            return words in sim.output

        peer.until(lambda: passes('/clock is received'), 'the end of the wait')
        peer.until(lambda: passes('waits for commands on /pressure_command'), 'the next wait')
        peer.publish(Float64(data=1e5), 'pressure_command')
        peer.until(lambda: passes('commands are received on /pressure_command'), 'its end')
        assert sim.output.count('waits for commands') == 1
        # If this process is held up for a second, the clock is missing once more.
        waits = sim.output.count('waits for /clock')
        assert sim.output.count('/clock is received') == waits


def test_in_lockstep_a_simulator_waits_for_a_controller(peer):
    with Program('pam_sim', parameters={'time_mode': 'lockstep'}) as sim:
        states = peer.collect(JointState, 'joint_states')
        wait_for(peer, sim, 'waits for a controller')
        seen = 0

        def answers():
            nonlocal seen
            if len(states) > seen:
                seen = len(states)
                peer.publish(Float64(data=1e5), 'pressure_command')
            return 'commands are received: simulated time passes' in sim.output

        peer.until(answers, 'the end of the wait')
        # The line is not repeated. Commands of a peer that is held up are another line.
        assert sim.output.count('waits for a controller') == 1


def test_a_simulator_tells_when_commands_stop_and_when_they_come_back(peer):
    with Program('pam_sim', parameters={'command_timeout': 0.3}) as sim:
        peer.publish(Float64(data=1e5), 'pressure_command')
        wait_for(peer, sim, VENTED)

        # A publisher that is slower than the time-out is not back, and says nothing new.
        for _ in range(4):
            peer.publish(Float64(data=1e5), 'pressure_command')
            peer.work(1.2)
        assert sim.output.count(VENTED) == 1
        assert BACK not in sim.output

        def commands():
            peer.publish(Float64(data=1e5), 'pressure_command')
            return BACK in sim.output

        peer.until(commands, 'the end')
        wait_for(peer, sim, VENTED, 2)
        assert sim.output.count(BACK) == 1


def test_a_controller_waits_for_states_and_tells_when_they_stop_and_come_back(peer):
    with Program('pam_control', parameters={'pressure_wait': 3.0}) as control:
        wait_for(peer, control, 'waits for joint_states')
        message = JointState(name=['pam'], position=[0.05])

        def sees(words, count=1):
            message.header.stamp = peer.node.get_clock().now().to_msg()
            peer.publish(message, 'joint_states')
            return control.output.count(words) >= count

        peer.until(lambda: sees('control begins'), 'the end of the wait')
        wait_for(peer, control, 'joint_states has stopped: vents')
        # States that come more slowly than the time-out say nothing new.
        for _ in range(4):
            sees('')
            peer.work(0.8)
        assert control.output.count('has stopped') == 1
        peer.until(lambda: sees('joint_states are received again'), 'the end')
        wait_for(peer, control, 'has stopped', 2)
        for words in (
            'waits for joint_states',
            'control begins',
            'joint_states are received again',
        ):
            assert control.output.count(words) == 1


def test_a_controller_waits_for_a_measured_pressure(peer):
    with Program('pam_control', parameters={'pressure_wait': 60.0}) as control:
        watch = Watch(peer)
        states = JointState(name=['pam'], position=[0.05])
        peer.publish(states, 'joint_states')  # and finds it

        def sees(words):
            states.header.stamp = peer.node.get_clock().now().to_msg()
            peer.publish(states, 'joint_states')
            return words in control.output

        peer.until(lambda: sees('waits for a measured pressure'), 'the wait')
        pressure = FluidPressure(fluid_pressure=3e5)
        pressure.header.stamp = peer.node.get_clock().now().to_msg()
        peer.publish(pressure, 'pressure')
        peer.until(lambda: sees('control begins'), 'its end')
        assert peer.until(lambda: watch.commands, 'commands')


def test_an_excitation_logs_its_topics_and_what_it_waits_for(peer):
    given = {'duration': 60.0, 'countdown': 3.0}
    with Program('pam_excite', '-r', 'pressure_command:=valve', parameters=given) as excite:
        wait_for(peer, excite, 'commands: /valve, at 200 Hz; states: /joint_states')
        wait_for(
            peer,
            excite,
            'waits for the rig: pressure_command has no subscriber, joint_states is not published',
        )
        peer.collect(Float64, 'valve')

        def sees():
            peer.publish(JointState(name=['pam'], position=[0.0]), 'joint_states')
            return 'the rig is found' in excite.output

        peer.until(sees, 'the end of the wait')
        assert excite.output.count('waits for the rig') == 1


def test_a_recorder_logs_its_topics_and_its_directory(peer, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with Program('pam_record', '-r', '__ns:=/left') as record:
        wait_for(peer, record, 'records to recording_')
        (line,) = (one for one in record.output.splitlines() if 'records to' in one)
        assert '/left/joint_states, /left/pressure_command, ' in line
        wait_for(peer, record, 'waits for a publisher')
        peer.publish(Float64(data=1.0), '/left/force')
        wait_for(peer, record, 'the first topic is found')
        assert record.output.count('waits for a publisher') == 1
