# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` vents slowly where joint states stay away, and no other rig than its own."""

import signal
import subprocess
import sys

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import FluidPressure, JointState

from support.control_watch import Simulation, Watch
from support.harness import Program
from support.marks import at_release

AMBIENT = 101325.0  # Pa
FASTEST = 0.15  # m/s; a reference moves with 0.1
RIG = {'initial.pressure': 300e3}


@pytest.fixture
def watch(peer):
    return Watch(peer)


def test_the_pressure_is_lowered_evenly_and_then_nothing_is_commanded(watch):
    rig = Simulation(watch.peer)
    given = {'state_timeout': 0.2, 'vent_time': 1.0, 'rate': 100.0}
    with Program('pam_control', parameters=given):
        rig.tell_until(lambda: len(watch.terms) > 10, 'control')
        watch.status(lambda s: 'has stopped' in s.message, 'the time-out')
        watch.peer.until(lambda: watch.commands[-1].data == 0.0, 'a command of 0 Pa')
        watch.stops_publishing()
    commands = np.array([one.data for one in watch.commands])
    end = int(np.argmax(commands == 0.0))
    assert not np.any(commands[end:])
    rises = np.flatnonzero(np.diff(commands[: end + 1]) >= 0.0)
    steps = -np.diff(commands[rises[-1] + 1 : end + 1])
    assert steps.size > 20
    assert np.max(steps) < 0.25 * np.sum(steps)  # a busy machine may leave some out


@pytest.mark.parametrize('kind', [signal.SIGKILL, at_release(signal.SIGTERM)])
def test_a_rig_that_starts_meanwhile_does_not_obey(watch, kind):
    """It starts with pressure and at rest: any command to the one before would drop its load."""
    peer = watch.peer
    given = {'state_timeout': 0.2, 'vent_time': 30.0}
    # On a busy machine control may begin after the simulator's own time-out for commands.
    patient = {**RIG, 'command_timeout': 0.0}
    with Program('pam_control', parameters=given):
        with Program('pam_sim', parameters=RIG) as sim:
            held = watch.begin() and watch.commands[-1].data
            sim.interrupt(kind)
            if kind == signal.SIGKILL:  # the middleware does not notice it for 20 s
                watch.status(lambda s: 'has stopped' in s.message, 'the time-out')
                watch.stops_publishing()
                assert watch.commands[-1].data > 0.9 * held
            else:
                peer.until(lambda: watch.commands[-1].data < 0.9 * held, 'a command to vent')
        pressures = peer.collect(FluidPressure, 'pressure')
        controlled = len(watch.terms)
        with Program('pam_sim', parameters=patient):
            assert watch.commands[-1].data > 0.1 * held  # it would still vent
            peer.until(lambda: len(watch.terms) > controlled + 100, 'control')
    lowest = min(one.fluid_pressure for one in pressures) - AMBIENT
    assert lowest > 0.98 * RIG['initial.pressure']


def test_few_commands_are_sent_while_it_vents(watch):
    """A rig that is discovered between the check for a new one and a command receives it."""
    rig = Simulation(watch.peer)
    given = {'state_timeout': 0.2, 'vent_time': 2.0, 'rate': 500.0}
    with Program('pam_control', parameters=given):
        rig.tell_until(lambda: len(watch.terms) > 10, 'control')
        held = watch.commands[-1].data
        watch.peer.until(lambda: watch.commands[-1].data == 0.0, 'a command of 0 Pa')
    vents = [one.data for one in watch.commands if 0.0 < one.data < 0.99 * held]
    assert 20 < len(vents) <= 2.0 / 0.009  # a busy machine may leave some out


# A law that gives NaN, which no input makes it give.
GIVES_NAN = """
from math import nan
from pam_ros.cli.pam_control import main
from pam_ros.control.sliding_mode import SlidingMode

update, calls = SlidingMode.update, []

def update_to_nan(self, *arguments):
    calls.append(arguments)
    pressures = update(self, *arguments)
    return (nan,) * len(pressures) if len(calls) > 1500 else pressures

SlidingMode.update = update_to_nan
main()
"""


def test_a_law_that_gives_nan_is_disabled_and_the_load_is_lowered(watch):
    peer = watch.peer
    states = peer.collect(JointState, 'joint_states')
    with Program('pam_sim', parameters=RIG):
        process = subprocess.Popen([sys.executable, '-c', GIVES_NAN])
        try:
            peer.more(states, 1)
            status = watch.status(lambda s: 'not finite' in s.message, 'the fault')
            peer.until(lambda: states[-1].position[0] < 0.01, 'the load at its lower end')
        finally:
            process.send_signal(signal.SIGINT)
            assert process.wait(60.0) == 0
    assert status.level == DiagnosticStatus.ERROR
    assert np.all(np.isfinite([one.data for one in watch.commands]))
    assert max(abs(one.velocity[0]) for one in states) < FASTEST


def test_a_rig_whose_joint_states_are_false_is_let_down(watch):
    """It has no time-out of its own; pam_control lowers the pressure until it is vented."""
    peer = watch.peer
    states = peer.collect(JointState, 'joint_states')
    pressures = peer.collect(FluidPressure, 'pressure')
    rig = {**RIG, 'command_timeout': 0.0}
    given = {'state_timeout': 0.2, 'command_timeout': 0.0}
    with Program('pam_sim', parameters=rig), Program('pam_control', parameters=given):
        watch.begin()
        peer.more(pressures, 1)
        peer.more(states, 1)
        assert peer.set_one('pam_sim', **{'sensor.position_offset': 0.5}).successful
        peer.until(lambda: pressures[-1].fluid_pressure == AMBIENT, 'a vented muscle')
        peer.until(lambda: abs(states[-1].velocity[0]) < 1e-3, 'rest')
    assert states[0].position[0] - (states[-1].position[0] - 0.5) > 0.05  # m
    assert max(abs(one.velocity[0]) for one in states) < FASTEST
