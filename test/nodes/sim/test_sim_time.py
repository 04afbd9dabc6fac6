# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulator's own time over DDS: scaled."""

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.simulator.modes import FIRST
from pam_ros.timing.pace import SECOND
from support.harness import Program, lose_nothing

MS = SECOND // 1000

SCALED = {'time_mode': 'scaled', 'command_timeout': 0.0, **lose_nothing()}
RELEASED = {'initial.at_rest': False, 'initial.position': 0.0, 'initial.pressure': 6e5}


def stamp(message):
    return message.header.stamp.sec * SECOND + message.header.stamp.nanosec


def tick(message):
    return message.clock.sec * SECOND + message.clock.nanosec


@pytest.mark.at_any_pace
@pytest.mark.parametrize('factor', [0.0, 0.5, 20.0])
def test_the_motion_is_the_same_at_any_speed(peer, factor):
    states = peer.collect(JointState, 'joint_states')
    clocks = peer.collect(Clock, '/clock')
    given = {**SCALED, **RELEASED, 'speed_factor': factor, 'publish_rate': 100.0}
    with Program('pam_sim', parameters=given):
        peer.until(lambda: len(states) > 100 and len(clocks) > 100, 'states')
    rig = Simulation([single_muscle_joint()], 1e-3)
    rig.reset([6e5], [0.0], [0.0])
    path = {}
    for k in range(max((stamp(m) - FIRST) // (10 * MS) for m in states) + 1):
        path[FIRST + 10 * k * MS] = rig.position.item(), rig.velocity.item()
        rig.advance(10)
    assert all((m.position[0], m.velocity[0]) == path[stamp(m)] for m in states)
    assert all(np.diff([stamp(m) for m in states]) > 0)
    assert all((tick(m) - FIRST) % (10 * MS) == 0 for m in clocks)
    assert all(np.diff([tick(m) for m in clocks]) > 0)


@pytest.mark.at_any_pace
def test_speed_changes_while_it_runs_without_a_jump(peer):
    states = peer.collect(JointState, 'joint_states')
    diagnostics = peer.collect(DiagnosticArray, '/diagnostics')
    given = {**SCALED, **RELEASED, 'publish_rate': 50.0, 'speed_factor': 0.5}

    def wanted():
        return {
            v.value
            for m in diagnostics[-1:]
            for s in m.status
            for v in s.values
            if v.key == 'wanted publish rate (Hz)'
        }

    with Program('pam_sim', parameters=given):
        for factor, rate in ((2.0, '100'), (0.5, '25'), (4.0, '200')):
            assert peer.set_one('pam_sim', speed_factor=factor).successful
            peer.until(lambda r=rate: wanted() == {r}, f'word of {rate} Hz')
            peer.more(states, 20)
        assert not peer.set_one('pam_sim', speed_factor=0.05).successful
        assert 'read-only' in peer.set_one('pam_sim', time_mode='lockstep').reason
    assert set(np.diff([stamp(m) for m in states])) == {20 * MS}


@pytest.mark.parametrize('factor', [0.0, pytest.param(5.0, marks=pytest.mark.at_any_pace)])
def test_pause_step_and_reset_in_scaled_time(peer, factor):
    states = peer.collect(JointState, 'joint_states')
    clocks = peer.collect(Clock, '/clock')
    given = {**SCALED, **RELEASED, 'speed_factor': factor, 'publish_rate': 100.0}
    with Program('pam_sim', parameters={**given, 'step_periods': 25}):
        peer.more(states, 5)
        refused = peer.call(Trigger, 'pam_sim/step')
        assert not refused.success
        assert 'pause it first' in refused.message
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success

        def stands():
            last = [stamp(m) for m in states[-3:]]
            return len(set(last)) == 1 and len({tick(m) for m in clocks[-3:]}) == 1

        peer.until(stands, 'a standstill that is reported')
        begin = stamp(states[-1])
        response = peer.call(Trigger, 'pam_sim/step')
        assert response.success
        end = begin + 250 * MS
        peer.until(lambda: stamp(states[-1]) > begin and stands(), 'the steps')
        assert stamp(states[-1]) == end
        assert peer.call(Trigger, 'pam_sim/reset').success
        peer.until(lambda: states[-1].position[0] == 0.0, 'the initial state')
        reset = stamp(states[-1])
        assert reset > end
        count = len(states)
        assert peer.call(SetBool, 'pam_sim/pause', data=False).success
        peer.until(lambda: stamp(states[-1]) > reset + 5 * 10 * MS, 'motion')
    after = sorted({stamp(m) for m in states[count:]} | {reset})
    assert after[1] - after[0] == 10 * MS  # no jump
    assert all(np.diff([stamp(m) for m in states]) >= 0)


@pytest.mark.at_any_pace
def test_step_in_real_time_is_of_exact_periods(peer):
    states = peer.collect(JointState, 'joint_states')
    given = {**RELEASED, **lose_nothing(), 'step_periods': 40}
    with Program('pam_sim', parameters=given):
        peer.more(states)
        peer.call(SetBool, 'pam_sim/pause', data=True)
        peer.call(Trigger, 'pam_sim/reset')
        peer.until(lambda: states[-1].position[0] == 0.0, 'the initial state')
        assert peer.call(Trigger, 'pam_sim/step').success
        rig = Simulation([single_muscle_joint()], 1e-3)
        rig.reset([6e5], [0.0], [0.0])
        rig.advance(80)
        peer.until(lambda: states[-1].position[0] == rig.position.item(), 'the state after 40')
        peer.more(states, 100)
        assert states[-1].position[0] == rig.position.item()
    assert all(np.diff([stamp(m) for m in states]) > 0)


def test_others_follow_its_clock(peer):
    leader = peer.collect(JointState, '/joint_states')
    follower = peer.collect(JointState, '/follower/joint_states')
    given = {**SCALED, **RELEASED, 'speed_factor': 5.0, 'publish_rate': 100.0}
    own = {**RELEASED, 'use_sim_time': True, 'publish_rate': 100.0}
    with (
        Program('pam_sim', '-r', '__ns:=/follower', parameters=own),
        Program('pam_sim', parameters=given),
    ):
        peer.until(lambda: follower and stamp(follower[-1]) > FIRST + SECOND, 'the time')
        assert peer.call(SetBool, '/pam_sim/pause', data=True).success
        # States from before the pause may still be on their way.
        peer.until(lambda: len({stamp(m) for m in leader[-5:]}) == 1, 'the pause')
        end = stamp(leader[-1])
        peer.until(lambda: abs(end - stamp(follower[-1])) <= 10 * MS, 'the same time')
        count = len(follower)
        peer.more(leader, 10)
        assert {stamp(m) for m in follower[count:]} <= {end, stamp(follower[count - 1])}


@pytest.mark.at_any_pace
def test_a_command_acts_at_any_speed(peer):
    states = peer.collect(JointState, 'joint_states')
    with Program('pam_sim', parameters={**SCALED, 'speed_factor': 0.0}):
        peer.more(states)
        peer.publish(Float64(data=4e5), 'pressure_command')
        assert peer.until(lambda: states[-1].position[0] > 0.05, 'motion')
