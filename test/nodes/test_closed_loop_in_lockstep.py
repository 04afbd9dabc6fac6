# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A controller's test as a CI runs it: 6 s of a closed loop in lockstep, the same to the bit.

``docs/ros2_control.md`` explains it. Two controllers: ``test/support/example_controller.py`` of
one muscle, and ``pam_control`` of a pair, with a trajectory that is sent while time stands still.
"""

import os
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from support.harness import Peer, Program

pytestmark = [pytest.mark.at_any_pace, pytest.mark.usefixtures('module_domain')]

CONTROLLER = Path(__file__).parents[1] / 'support' / 'example_controller.py'
SECONDS = 6.0
BEGIN, TOLD = 1, 6.0  # s, when the trajectory of pam_control begins, and how long it is
# Works and pauses for times that differ, so that all programs wait for a core now and then.
BUSY = """
import random, time
while True:
    until = time.monotonic() + random.uniform(0.0, 0.02)
    while time.monotonic() < until:
        pass
    time.sleep(random.uniform(0.0, 0.02))
"""
RIG = {'time_mode': 'lockstep', 'sensor.position_noise': 5e-6}
BUSY_BESIDE = (0, os.cpu_count() or 1)  # programs that compete for the cores, in each run


def keep_busy(stack, count):
    """Let so many programs compete for the cores, for the time of *stack*."""
    for _ in range(count):
        other = stack.enter_context(subprocess.Popen([sys.executable, '-c', BUSY]))
        stack.callback(other.kill)


def run(file, busy=0):
    """Run the scenario with *busy* other programs on the machine, and return what was seen."""
    with ExitStack() as stack:
        keep_busy(stack, busy)
        stack.enter_context(Program('pam_sim', parameters=RIG))
        subprocess.run([sys.executable, CONTROLLER, str(SECONDS), file], check=True, timeout=300)
    return np.load(file)


@pytest.fixture(scope='module')
def runs(module_domain, tmp_path_factory):
    folder = tmp_path_factory.mktemp('runs')
    return [run(folder / f'{i}.npz', n) for i, n in enumerate(BUSY_BESIDE)]


def test_the_reference_is_tracked(runs):
    t, error = runs[0]['t'], runs[0]['position'] - runs[0]['reference']
    assert len(t) == SECONDS * 500 + 1
    np.testing.assert_allclose(np.diff(t), 2e-3, atol=1e-9)
    settled = error[t > 4.0]
    assert np.sqrt(np.mean(settled**2)) < 0.6e-3  # m, of a sine of 20 mm
    assert np.max(np.abs(settled)) < 2e-3
    assert np.ptp(runs[0]['position'][t > 4.0]) > 0.038


def test_two_runs_are_the_same_to_the_bit_one_of_them_on_a_busy_machine(runs):
    first, other = runs
    for name in ('t', 'reference', 'position', 'pressure'):
        assert first[name].tobytes() == other[name].tobytes(), name


def seconds(message):
    return message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec


def swing(t):
    """Return the angle in rad of a 0.5 Hz sine of 15 degrees, *t* s after its soft beginning."""
    share = np.clip(np.minimum(t, TOLD - t) / 2.0, 0.0, 1.0)
    return np.radians(15.0) * np.sin(0.5 * np.pi * share) ** 2 * np.sin(np.pi * t)


def trajectory():
    """Return it as points, 20 ms apart, from BEGIN s of simulated time."""
    points = [
        JointTrajectoryPoint(
            positions=[float(swing(k / 50))],
            time_from_start=Duration(sec=k // 50, nanosec=k % 50 * 20_000_000),
        )
        for k in range(1, round(50 * TOLD) + 1)
    ]
    message = JointTrajectory(joint_names=['pam'], points=points)
    message.header.stamp.sec = BEGIN
    return message


def run_pam_control(busy):
    """Return the angles of a run by their stamps."""
    both = {'joint': 'antagonistic'}
    rig = {
        **RIG,
        **both,
        'mass': 1.3,  # more than is configured in the controller
        'sensor.position_noise': float(np.radians(0.02)),
        'initial.pressure': 2e5,
        'qos_overrides./joint_states.publisher.depth': 5000,
    }
    # Control begins at the pressure that is there, however late that is received.
    given = {**both, 'use_sim_time': True, 'pressure_wait': 60.0}
    with ExitStack() as stack:
        keep_busy(stack, busy)
        peer = stack.enter_context(Peer())
        stack.enter_context(Program('pam_sim', parameters=rig))
        states = peer.collect(JointState, 'joint_states')
        diagnostics = peer.collect(DiagnosticArray, '/diagnostics')
        peer.more(states)
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success
        commands = peer.collect(Float64MultiArray, 'pressure_commands')
        control = stack.enter_context(Program('pam_control', parameters=given))
        peer.more(commands)  # it controls
        peer.publish(trajectory(), 'joint_trajectory')
        count = len(diagnostics)
        peer.until(lambda: len(diagnostics) > count + 2, 'a second to be heard')
        assert peer.call(SetBool, 'pam_sim/pause', data=False).success
        end = BEGIN + TOLD + 1.0
        peer.until(lambda: seconds(states[-1]) >= end, f'{end} s')
        (line,) = control.output.splitlines()  # no warning, only the start
        assert 'controls the joint' in line
    # A listener who is late on a busy machine misses states, but what it hears it hears right.
    return {seconds(m): m.position[0] for m in states}


@pytest.fixture(scope='module')
def runs_of_a_pair(module_domain):
    return [run_pam_control(n) for n in BUSY_BESIDE]


@pytest.mark.release
def test_pam_control_tracks_the_angle_of_a_pair(runs_of_a_pair):
    t, angle = (np.array(each) for each in zip(*runs_of_a_pair[0].items(), strict=True))
    swung = (t > BEGIN + 2.0) & (t < BEGIN + TOLD - 2.0)
    assert np.sum(swung) > 500
    error = angle[swung] - swing(t[swung] - BEGIN)
    assert np.ptp(angle[swung]) > np.radians(29.0)
    assert np.sqrt(np.mean(error**2)) < np.radians(0.2)


def test_pam_control_runs_are_the_same_to_the_bit(runs_of_a_pair):
    first, other = runs_of_a_pair
    both = first.keys() & other.keys()
    assert len(both) > 2000
    assert [first[t] for t in both] == [other[t] for t in both]
