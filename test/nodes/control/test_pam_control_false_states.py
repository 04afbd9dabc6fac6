# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` next to a publisher whose states cannot be true: the load stays where it is."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool

from support.control_watch import Simulation, Watch
from support.harness import Program

FALSE = [-1.0, -0.3, 0.0, 0.3, 1.0, 1e300]  # m; the load is at 60 mm


@pytest.fixture
def watch(peer):
    return Watch(peer)


def is_true(message):
    return message.position[0] not in FALSE


def soon_after(time):
    """Return a stamp 1 us later."""
    passed = time.nanosec + 1000
    return Time(sec=time.sec + passed // 10**9, nanosec=passed % 10**9)


def value(status, key):
    return next(int(pair.value) for pair in status.values if pair.key == key)


def left_out(watch):
    """Return how many joint states the last diagnostics say were left out."""
    status = watch.status(lambda s: True, 'the diagnostics')
    return value(status, 'implausible joint_states')


def tell_until_left_out(watch, states, false):
    """Publish a false state after each of the diagnostics until one more is left out.

    One that a busy machine holds up is older than the next true one, and is no news.
    """
    before, counted = left_out(watch), -1

    def is_left_out():
        nonlocal counted
        if left_out(watch) > before:
            return True
        if counted != (counted := len(watch.arrays)):
            message = JointState(name=['pam'], position=[false])
            message.header.stamp = soon_after(states[-1].header.stamp)
            watch.peer.publish(message, 'joint_states')
        return False

    watch.peer.until(is_left_out, f'a state of {false} m that is left out')


@pytest.mark.at_any_pace
def test_false_states_do_not_move_the_load_and_are_counted(watch):
    states = watch.peer.collect(JointState, 'joint_states')
    # However long a busy machine holds them up.
    rig = {'initial.pressure': 300e3, 'command_timeout': 0.0}
    with (
        Program('pam_sim', parameters=rig),
        Program('pam_control', parameters={'state_timeout': 60.0}) as control,
    ):
        begin = watch.begin()
        for false in FALSE:
            tell_until_left_out(watch, states, false)
        status = watch.status(lambda s: 'beyond the travel' in s.message, 'the warning')
        assert status.level == DiagnosticStatus.WARN
        assert 'joint_states has a position -1 m, which is beyond the travel' in control.output
        positions = np.array([one.position[0] for one in states if is_true(one)])
        assert positions == pytest.approx(begin, abs=1e-4)


@pytest.mark.at_any_pace
def test_states_that_stay_false_are_no_states(watch):
    rig = Simulation(watch.peer)
    with Program('pam_control', parameters={'state_timeout': 0.2}):
        rig.tell_until(lambda: len(watch.terms) > 10, 'control', 0.06)
        rig.tell_until(
            lambda: any(
                'has stopped: vents: joint_states has a position -0.3 m' in s.message
                for array in watch.arrays
                for s in array.status
            ),
            'the time-out',
            -0.3,
        )
        assert watch.steady_command() == 0.0
        before = len(watch.terms)
        rig.tell_until(lambda: len(watch.terms) > before, 'control again', 0.05)
        assert watch.terms[before].position[0] == pytest.approx(0.05)


@pytest.mark.at_any_pace
def test_states_whose_stamp_stays_the_same_are_no_states_and_this_is_the_reason(watch):
    peer, rig = watch.peer, Simulation(watch.peer)
    frozen = JointState(name=['pam'], position=[0.06])
    frozen.header.stamp.sec = 1000
    reason = 'joint_states repeats the stamp 1000.000 s: not used'

    def shown(words):
        peer.publish(frozen, 'joint_states')
        return any(words in s.message for array in watch.arrays for s in array.status)

    with Program('pam_control', parameters={'state_timeout': 0.5}) as control:
        # Control does not begin with a state that may be old.
        peer.until(lambda: shown(f'waits for joint_states: {reason}'), 'the reason at the start')
        rig.tell_until(lambda: watch.terms, 'control')
        peer.until(lambda: shown(f'has stopped: vents: {reason}'), 'the reason')
        peer.until(lambda: f'has stopped: vents: {reason}' in control.output, 'the log')
        # If it is enabled again, it has no state yet.
        assert peer.call(SetBool, 'pam_control/enable', data=False).success
        assert reason in peer.call(SetBool, 'pam_control/enable', data=True).message
        before = len(watch.terms)
        rig.tell_until(lambda: len(watch.terms) > before, 'control again')


@pytest.mark.at_any_pace
def test_a_rig_that_repeats_each_state_and_then_stops_has_only_stopped(watch):
    rig = Simulation(watch.peer)

    def tell_twice():
        for _ in range(2):
            rig.tell()
            rig.count -= 1
        rig.count += 1
        return len(watch.terms) > 10

    with Program('pam_control', parameters={'state_timeout': 2.0}) as control:
        watch.peer.until(tell_twice, 'control')
        watch.status(lambda s: s.message == 'joint_states has stopped: vents', 'the time-out')
        assert 'repeats the stamp' not in control.output


@pytest.mark.at_any_pace
@pytest.mark.parametrize(
    ('false', 'end'),
    [
        (-20e3, ''),
        (5e6, ''),
        (346.0, ' (is it in kPa?)'),
        (math.nan, ''),
    ],
)
def test_control_does_not_begin_at_a_pressure_that_cannot_be(watch, false, end):
    rig, peer = Simulation(watch.peer), watch.peer
    with Program(
        'pam_control', parameters={'pressure_wait': 0.5, 'state_timeout': 60.0}
    ) as control:

        def began():
            pressure = FluidPressure(fluid_pressure=false)
            pressure.header.stamp.sec = 11 + rig.count
            peer.publish(pressure, 'pressure')
            rig.tell()
            return watch.terms and watch.commands

        peer.until(began, 'control')
        first = watch.commands[0].data
        words = f'pressure has {false:.6g} Pa, but only 81325 to 851325 Pa absolute is possible'
        assert f'{words}{end}: not used' in control.output
        assert 1e5 < first < 5e5  # that which holds the configured load at 60 mm
        status = watch.status(lambda s: words in s.message, 'the warning')
        assert status.level == DiagnosticStatus.WARN


@pytest.mark.at_any_pace
def test_pressures_of_another_number_of_muscles_are_reported(watch):
    rig, peer = Simulation(watch.peer), watch.peer
    given = {'joint': 'antagonistic', 'pressure_wait': 0.5, 'state_timeout': 60.0}
    words = 'pressures has 3 values for 2 muscles: not used'
    with Program('pam_control', parameters=given) as control:

        def reported():
            peer.publish(Float64MultiArray(data=[3e5, 3e5, 3e5]), 'pressures')
            rig.tell()
            return words in control.output

        peer.until(reported, 'the sentence')
        status = watch.status(lambda s: words in s.message, 'the warning')
        assert status.level == DiagnosticStatus.WARN
