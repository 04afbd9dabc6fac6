# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` is stopped, its rig goes on, and the node wakes: the load is not thrown.

The rig vents meanwhile, from 1 s on and within 2 s.
"""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from sensor_msgs.msg import JointState

from support.control_watch import Watch, stamp
from support.harness import Program, lose_nothing
from support.marks import at_release

RIG = {'initial.pressure': 300e3}
WAY = 0.01  # m
BUMP = 2e-3  # m that the load may move where control begins
FASTEST = 0.15  # m/s; max_velocity is 0.1
COUNTER = 'starts after a silence'


@pytest.fixture
def watch(peer):
    return Watch(peer)


@contextmanager
def stopped(program):
    os.kill(program.process.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(program.process.pid, signal.SIGCONT)


def values(status):
    return {pair.key: pair.value for pair in status.values}


@pytest.mark.parametrize(
    ('seconds', 'on_timeout'),
    [
        at_release(1.3, 'vent'),
        (2.0, 'vent'),
        at_release(2.0, 'hold'),
        at_release(6.0, 'vent'),
    ],
)
def test_a_rig_that_has_begun_to_vent_does_not_jump(watch, seconds, on_timeout):
    peer = watch.peer
    states = peer.collect(JointState, 'joint_states')
    given = {'on_timeout': on_timeout}
    with Program('pam_sim', parameters=RIG), Program('pam_control', parameters=given) as control:
        begin = watch.begin()
        watch.refer(begin + WAY)
        peer.until(lambda: abs(watch.latest('position') - begin - WAY) < 1e-4, 'the position')
        first = len(states)
        with stopped(control):
            peer.work(seconds)
            woke, there = stamp(states[-1]), states[-1].position[0]

        def again():
            return [term for term in watch.terms if stamp(term) > woke]

        peer.until(lambda: len(again()) > 100, 'control again')
        began = stamp(again()[0])
        free = np.array([one.position[0] for one in states if stamp(one) > woke])
        held = np.array([one.position[0] for one in states if stamp(one) > began])
        assert free.max() < there + BUMP
        assert np.max(np.abs([one.velocity[0] for one in states[first:]])) < FASTEST
        # A load that sinks is stopped first.
        assert np.ptp(held) < (BUMP if seconds > 4.0 else 4.0 * BUMP)
        reference = again()[0].position[watch.names.index('reference')]
        assert reference == pytest.approx(held[0], abs=BUMP)

        status = watch.status(lambda s: values(s)[COUNTER] == '1', 'the interruption')
        assert 'no command was given for' in values(status)['last silence']
        assert control.output.count('control starts again from the present position') == 1
        # A new reference is approached within the shape, as from the start.
        last = stamp(states[-1])
        watch.refer(reference + WAY)
        peer.until(
            lambda: abs(watch.latest('position') - reference - WAY) < 1e-3, 'the new position'
        )
        speeds = [one.velocity[0] for one in states if stamp(one) > last]
        assert np.max(np.abs(speeds)) < FASTEST


# A process that is stopped in the middle of a command: it is sent when the process wakes.
STOPS_ITSELF = """
import os, signal
from pam_ros.nodes.control.node import PamControl
from pam_ros.cli.pam_control import main

publish, commands = PamControl._publish, []

def stopped_within(self, pressures):
    commands.append(pressures)
    if len(commands) == 1000:
        os.kill(os.getpid(), signal.SIGSTOP)
    publish(self, pressures)

PamControl._publish = stopped_within
main()
"""


@contextmanager
def that_stops_itself(parameters):
    arguments = [f'{name}:={value}' for name, value in parameters.items()]
    given = [word for one in arguments for word in ('-p', one)]
    process = subprocess.Popen([sys.executable, '-c', STOPS_ITSELF, '--ros-args', *given])
    try:
        yield process
    finally:
        process.send_signal(signal.SIGCONT)
        process.send_signal(signal.SIGINT)
        assert process.wait(60.0) == 0


def is_stopped(process):
    return Path(f'/proc/{process.pid}/stat').read_text().rpartition(')')[2].split()[0] == 'T'


@pytest.mark.parametrize(
    ('on_timeout', 'command_timeout'),
    [('hold', 1.0), at_release('vent', 1.0), at_release('vent', 0.0), at_release('hold', 0.0)],
)
def test_the_command_that_a_stop_held_up_throws_nothing(watch, on_timeout, command_timeout):
    peer = watch.peer
    states = peer.collect(JointState, 'joint_states')
    given = {'on_timeout': on_timeout, 'command_timeout': command_timeout}
    with (
        Program('pam_sim', parameters={**RIG, 'command_timeout': command_timeout}),
        that_stops_itself(given) as process,
    ):
        peer.until(lambda: is_stopped(process), 'the stop')
        before, first = states[-1].position[0], len(states)
        peer.work(2.0)
        woke, there = stamp(states[-1]), states[-1].position[0]
        process.send_signal(signal.SIGCONT)
        peer.until(
            lambda: len([term for term in watch.terms if stamp(term) > woke]) > 100,
            'control again',
        )
        after = np.array([one.position[0] for one in states if stamp(one) > woke])
        assert np.max(np.abs([one.velocity[0] for one in states[first:]])) < FASTEST
        if command_timeout:  # it vents, and does not rise
            assert there < before - BUMP
            assert after.max() < there + BUMP
        else:  # it still holds
            assert np.max(np.abs(after - before)) < BUMP


@pytest.mark.at_any_pace
def test_in_lockstep_control_does_not_restart_after_a_pause(watch):
    peer = watch.peer
    states = peer.collect(JointState, 'joint_states')
    rig = {**RIG, 'time_mode': 'lockstep', **lose_nothing()}
    with (
        Program('pam_sim', parameters=rig),
        Program('pam_control', parameters={'use_sim_time': True}) as control,
    ):
        begin = watch.begin()
        watch.refer(begin + WAY)
        peer.until(lambda: watch.latest('reference') > begin + 0.1 * WAY, 'the motion')
        with stopped(control):
            peer.work(2.0)
        peer.until(lambda: watch.latest('reference') == begin + WAY, 'the reference')
        peer.more(watch.arrays, 2)
        status = watch.status(lambda s: s.message == 'controlling', 'control')
        assert values(status)[COUNTER] == '0'
        assert np.max(np.diff([stamp(one) for one in states])) < 2.1e-3  # each one is answered
        assert np.min([one.position[0] for one in states]) > begin - 1e-4
