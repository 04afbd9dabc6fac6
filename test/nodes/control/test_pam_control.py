# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` and its rig as processes: following, safety, refusals, exit codes."""

import math
import signal

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pam_ros.control.signals import TERMS
from support.control_watch import LOSE_NO_TERMS, Rig, Watch, columns
from support.harness import Program

START = {'mass': 20.0, 'initial.pressure': 300e3}
LOCKSTEP = {**START, 'time_mode': 'lockstep'}
FOLLOWING = {'use_sim_time': True, 'state_rate': 500.0, **LOSE_NO_TERMS}
ENABLE = 'pam_control/enable'


@pytest.fixture
def watch(peer):
    return Watch(peer)


@pytest.mark.at_any_pace
def test_a_step_and_a_sine_are_followed_in_lockstep(watch):
    with Program('pam_sim', parameters=LOCKSTEP), Program('pam_control', parameters=FOLLOWING):
        begin = watch.begin()
        assert list(watch.terms[0].name) == list(TERMS)
        assert watch.latest('error') == pytest.approx(0.0, abs=1e-5)  # it begins without a bump
        heard = watch.lead(lambda: watch.refer(begin + 0.01), 2.0)
        t, seen = columns(heard[-100:])
        np.testing.assert_allclose(np.diff(t), 2e-3, atol=1e-8)
        assert seen['reference'][-1] == pytest.approx(begin + 0.01, abs=1e-9)
        assert np.max(np.abs(seen['error'])) < 1e-5
        assert np.ptp(seen['pressure']) < 1e3

        # A sine of 5 mm at 0.5 Hz as a trajectory, as robot stacks send them.
        middle, swing, turn = begin + 0.01, 0.005, math.pi
        times = np.linspace(0.05, 4.0, 80)
        points = [
            JointTrajectoryPoint(
                positions=[middle + swing * math.sin(turn * t)],
                velocities=[swing * turn * math.cos(turn * t) * (t < 4.0)],
                time_from_start=Duration(sec=int(t), nanosec=int(t % 1.0 * 1e9)),
            )
            for t in times
        ]
        sine = JointTrajectory(joint_names=['pam'], points=points)
        heard = watch.lead(lambda: watch.peer.publish(sine, 'joint_trajectory'), 4.2)
        t, seen = columns(heard)
        moving = (t > 1.0) & (t < 3.0)
        assert np.ptp(seen['reference'][moving]) == pytest.approx(2.0 * swing, rel=0.02)
        assert np.sqrt(np.mean(seen['error'][moving] ** 2)) < 1e-4


def test_a_set_point_is_reached_in_real_time(watch):
    with Program('pam_sim', parameters=START), Program('pam_control') as control:
        begin = watch.begin()
        watch.refer(begin + 0.01)

        def is_there():
            return abs(watch.latest('position') - begin - 0.01) < 1e-4

        watch.peer.until(is_there, 'the set-point')
        control.interrupt(signal.SIGTERM)
        assert control.wait() == 0
        assert 'Traceback' not in control.output


@pytest.mark.parametrize(('action', 'pressure'), [('vent', 0.0), ('hold', None)])
def test_silence_of_the_joint_is_answered_safely(watch, action, pressure):
    rig = Rig(watch.peer)
    told = {'on_timeout': action, 'state_timeout': 0.2}
    with Program('pam_control', parameters=told):
        rig.tell_until(lambda: len(watch.terms) > 10, 'control')
        status = watch.status(lambda s: 'stay away' in s.message, 'the time-out')
        assert status.level == DiagnosticStatus.ERROR
        assert {'vent': 'vents', 'hold': 'holds'}[action] in status.message
        commanded = watch.steady_command()
        assert commanded == pytest.approx(pressure) if action == 'vent' else commanded > 1e5
        # When the joint is seen again, it goes on from there.
        before = len(watch.terms)
        rig.tell_until(lambda: len(watch.terms) > before, 'control again', 0.05)
        assert watch.terms[before].position[TERMS.index('reference')] == pytest.approx(0.05)


@pytest.mark.at_any_pace
def test_bad_references_are_refused_with_the_range(watch):
    with Program('pam_sim', parameters=LOCKSTEP), Program('pam_control', parameters=FOLLOWING):
        begin = watch.begin()
        for bad, words in (
            (0.3, ('reference 0.3 m', 'out of reach', ' to 0.09')),
            (math.nan, ('reference nan',)),
            (-math.inf, ('reference -inf',)),
        ):
            watch.refer(bad)
            status = watch.status(
                lambda s, words=words: all(word in s.message for word in words), str(words)
            )
            assert status.level == DiagnosticStatus.WARN
        message = JointTrajectory(joint_names=['elbow'], points=[JointTrajectoryPoint()])
        watch.peer.publish(message, 'joint_trajectory')
        watch.status(lambda s: 'elbow' in s.message and 'pam' in s.message, 'the wrong name')
        message = JointTrajectory(joint_names=['pam'], points=[JointTrajectoryPoint()])
        watch.peer.publish(message, 'joint_trajectory')
        watch.status(lambda s: 'point 0 of the trajectory' in s.message, 'the empty point')
        assert watch.latest('reference') == begin
        assert all(math.isfinite(message.data) for message in watch.commands)


@pytest.mark.at_any_pace
def test_a_wrong_joint_name_is_named_and_nothing_is_commanded(watch):
    rig = Rig(watch.peer)
    with Program('pam_control', parameters={'joint_name': 'elbow'}) as control:

        def is_said():
            return 'no joint elbow (joint_name), but pam' in control.output

        rig.tell_until(is_said, 'the warning')
        status = watch.status(lambda s: 'no joint elbow' in s.message, 'the diagnostics')
        assert status.level == DiagnosticStatus.ERROR
        assert not watch.commands


@pytest.mark.at_any_pace
def test_a_position_that_is_no_number_is_not_used(watch):
    rig = Rig(watch.peer)
    with Program('pam_control'):
        rig.tell_until(lambda: watch.commands, 'control')
        rig.tell_until(
            lambda: any('position nan' in s.message for a in watch.arrays for s in a.status),
            'the diagnostics',
            math.nan,
        )
        assert all(math.isfinite(message.data) for message in watch.commands)


def test_disabled_it_commands_nothing_and_enabled_it_holds_the_load_where_it_is(watch):
    rig = Rig(watch.peer)
    with Program('pam_control', parameters={'start_enabled': False}):
        rig.tell_until(lambda: watch.arrays, 'the diagnostics')
        assert not watch.commands
        watch.refer(0.07)
        watch.status(lambda s: 'not taken: disabled' in s.message, 'the refusal')
        assert watch.peer.call(SetBool, ENABLE, data=True).success
        rig.tell_until(lambda: watch.commands, 'commands', 0.055)
        assert watch.begin() == pytest.approx(0.055)
        answer = watch.peer.call(SetBool, ENABLE, data=False)
        assert answer.success
        assert 'disabled' in answer.message
        watch.falls_silent()
        rig.tell(0.055)
        watch.status(lambda s: 'disabled' in s.message, 'its word')
        watch.falls_silent()


@pytest.mark.at_any_pace
def test_the_baseline_and_measured_velocity_control_as_well(watch):
    told = {**FOLLOWING, 'velocity_source': 'measured'}
    with Program('pam_sim', parameters=LOCKSTEP), Program('pam_control', parameters=told):
        begin = watch.begin()
        watch.lead(lambda: watch.refer(begin + 0.005), 1.6)
        assert abs(watch.latest('error')) < 1e-5
        pytest.importorskip('simple_pid', reason='the baseline needs simple-pid')
        assert watch.peer.set_one('pam_control', controller='pid').successful
        watch.peer.more(watch.terms, 300)
        watch.lead(lambda: watch.refer(begin), 4.0)
        assert abs(watch.latest('error')) < 2e-5


@pytest.mark.at_any_pace
def test_parameters_are_described_and_changed_or_refused_as_a_whole(watch):
    with Program('pam_sim', parameters=LOCKSTEP), Program('pam_control', parameters=FOLLOWING):
        watch.begin()
        (about,) = watch.peer.describe('pam_control', 'gains.bandwidth')
        assert about.floating_point_range[0].from_value == 0.5
        assert '1/s' in about.description
        bad = watch.peer.set_one('pam_control', limits__pressure_high=-5.0)
        assert not bad.successful
        assert 'pressure_high' in bad.reason
        bad = watch.peer.set_one('pam_control', gains__velocity_bandwidth=2000.0)
        assert not bad.successful
        assert 'too fast for a control rate of 500 Hz' in bad.reason
        assert watch.peer.set_one('pam_control', gains__bandwidth=10.0).successful
        assert watch.peer.set_one('pam_control', mass=21.0).successful
        watch.peer.more(watch.terms, 1000)
        assert abs(watch.latest('error')) < 1e-5


@pytest.mark.at_any_pace
@pytest.mark.usefixtures('domain')
@pytest.mark.parametrize(
    ('arguments', 'named'),
    [
        (['-p', 'mass:=-3.0'], ['mass = -3.0', 'above 0']),
        (['-p', 'rat:=100.0'], ['rat ', 'rate']),
        (['-p', 'on_timeout:=explode'], ['on_timeout', 'vent', 'hold']),
        (['-p', 'muscle:=dmsp_99'], ['dmsp_99', 'dmsp_20_400n']),
        (['-p', 'gains.bandwidth:=100.0'], ['fast_bandwidth', 'bandwidth = 100']),
        (['-p', 'rate:=20.0'], ['velocity_bandwidth', '20 Hz']),
        (['-p', 'mass:=1e4'], ['mass']),
        (['--nonsense'], ['nonsense']),
    ],
)
def test_bad_arguments_end_it_with_a_sentence(arguments, named):
    with Program('pam_control', *arguments) as control:
        assert control.wait() == 2
        sentence = control.output.splitlines()[-1]
        assert sentence.startswith('pam_control: ')
        for word in named:
            assert word in sentence
        assert 'Traceback' not in control.output


def test_two_in_namespaces_do_not_disturb_each_other(peer):
    left = peer.collect(JointState, '/left/pam_control/state')
    right = peer.collect(JointState, '/right/pam_control/state')
    spaces = [('-r', f'__ns:=/{name}') for name in ('left', 'right')]
    programs = [
        Program(name, *space, parameters=START if name == 'pam_sim' else None)
        for space in spaces
        for name in ('pam_sim', 'pam_control')
    ]
    with programs[0], programs[1], programs[2], programs[3]:
        peer.more(left)
        peer.more(right)
        begin = right[-1].position[0]
        peer.publish(Float64(data=begin + 0.005), '/left/position_reference')
        peer.until(lambda: left[-1].position[0] > begin + 0.004, 'motion on the left')
        assert right[-1].position[0] == pytest.approx(begin, abs=1e-9)
