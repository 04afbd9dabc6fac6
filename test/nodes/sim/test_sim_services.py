# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``~/reset`` and ``~/pause`` of ``pam_sim`` over DDS."""

from itertools import groupby

import numpy as np
import pytest
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from support.harness import Program, lose_nothing

RELEASED = {
    'initial.pressure': 600e3,
    'initial.at_rest': False,
    'initial.position': 0.0,
    **lose_nothing(),
}


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def from_start(peer, states, count):
    """Reset, and return the first *count* states of the run that then begins."""
    peer.more(states)  # the start of the program itself is past
    before = len(states)
    assert peer.call(Trigger, 'pam_sim/reset').success

    def begun():
        return [i for i in range(before, len(states)) if states[i].position[0] == 0.0]

    (first, *_) = peer.until(begun, 'the initial state')
    peer.until(lambda: len(states) >= first + count, f'{count} states')
    return states[first : first + count]


@pytest.mark.at_any_pace
def test_reset_goes_to_the_initial_state_of_now(peer):
    states = peer.collect(JointState, 'joint_states')
    with Program('pam_sim', parameters=RELEASED):
        start = {'initial__position': 0.05, 'initial__velocity': -0.2}
        assert peer.set_together('pam_sim', **start).successful
        before = len(states)
        assert peer.call(Trigger, 'pam_sim/reset').success
        peer.until(
            lambda: any((m.position[0], m.velocity[0]) == (0.05, -0.2) for m in states[before:]),
            'the new initial state',
        )
        refused = peer.set_together('pam_sim', initial__position=0.5)
        assert not refused.successful
        assert 'initial.position = 0.5' in refused.reason


def test_pause_stands_still_but_talks_and_resumes_without_a_jump(peer):
    states = peer.collect(JointState, 'joint_states')
    with Program('pam_sim', parameters={**RELEASED, 'publish_rate': 1000.0}):
        whole = from_start(peer, states, 1500)
        broken = from_start(peer, states, 300)  # in full motion
        begin = states.index(broken[0])
        assert peer.call(SetBool, 'pam_sim/pause', data=True).message == 'paused'
        peer.more(states, 500)
        paused = states[-200:]
        assert len({m.position[0] for m in paused}) == 1
        assert len({stamp(m) for m in paused}) == len(paused)
        assert peer.call(SetBool, 'pam_sim/pause', data=False).message == 'running'
        peer.more(states, 500)
    assert all(np.diff([stamp(m) for m in states]) > 0)
    # A sample each step: but for the standstill the states are those of the whole run.
    motion = [position for position, _ in groupby(m.position[0] for m in states[begin:])]
    n = min(len(motion), len(whole))
    assert n > 700
    assert motion[:n] == [m.position[0] for m in whole[:n]]


@pytest.mark.at_any_pace
def test_a_command_during_a_pause_acts_when_time_goes_on(peer):
    states = peer.collect(JointState, 'joint_states')
    with Program('pam_sim', parameters={'command_timeout': 0.0}):
        peer.more(states)
        peer.call(SetBool, 'pam_sim/pause', data=True)
        peer.publish(Float64(data=400e3), 'pressure_command')
        peer.more(states, 200)
        at_rest = states[-1].position[0]
        assert states[-100].position[0] == at_rest
        peer.call(SetBool, 'pam_sim/pause', data=False)
        peer.until(lambda: states[-1].position[0] > at_rest + 0.01, 'motion')


def test_a_command_right_after_a_long_step_acts(peer):
    """The simulator was busy for more than half a second, but nobody has stopped it."""
    pressures = peer.collect(FluidPressure, 'pressure')
    slow = {'publish_rate': 10.0, 'step_periods': 20000, 'command_timeout': 0.0}
    with Program('pam_sim', parameters=slow):
        peer.publish(Float64(data=1e5), 'pressure_command')
        peer.until(lambda: pressures and pressures[-1].fluid_pressure > 2e5, 'a first command')
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success
        assert peer.call(Trigger, 'pam_sim/step').success
        assert peer.call(SetBool, 'pam_sim/pause', data=False).success
        peer.publish(Float64(data=2e5), 'pressure_command')
        peer.until(lambda: pressures[-1].fluid_pressure > 3e5, 'the commanded pressure')


def test_a_change_that_loses_the_load_where_time_stands_still_is_a_fault(peer):
    """A muscle that becomes shorter than the position of its load; it ended the program."""
    states = peer.collect(JointState, 'joint_states')
    with Program('pam_sim', parameters={'initial.pressure': 400e3}) as sim:
        peer.more(states)
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success
        assert states[-1].position[0] > 0.05
        assert peer.set_one('pam_sim', l0=0.05).successful
        peer.until(lambda: 'the state is invalid' in sim.output, 'the fault')
        peer.until(lambda: states[-1].position[0] < 0.05, 'the initial state')
        assert sim.is_running
        assert sim.output.count('the state is invalid') == 1
        assert sim.stop() == 0
