# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_excite`` and ``pam_record`` next to a simulator that makes the time."""

import signal

import numpy as np
import pytest
from sensor_msgs.msg import JointState

from pam_ros.excitation.programme import programme
from pam_ros.excitation.settings import Excitation
from support.bags import contents
from support.harness import DEADLINE, Peer, Program, lose_nothing

pytestmark = pytest.mark.usefixtures('module_domain')

RATE = 100.0  # Hz of states
CLOCK_RATES = {'scaled': 50.0, 'lockstep': RATE}  # Hz of /clock
PLAN = {'duration': 30.0, 'pressure_min': 150e3, 'pressure_max': 400e3}
DURATION = PLAN['duration']  # s
LAST_THIRD = 21 * 10**9  # ns
# A busy machine may keep the rig quiet for a while, and time goes faster than on the wall.
EXCITATION = {**PLAN, 'use_sim_time': True, 'countdown': 0.5, 'silence': 10.0}
# The rig and the recorder.
EXCITATION |= {'subscribers': 2, 'patience': DEADLINE}
# After such a pause two steps of the pressure can become one, with a larger overshoot.
EXCITATION |= {'kappa_max': 0.3, 'contraction_max': 0.3}
FASTER = {
    'scaled': {'time_mode': 'scaled', 'speed_factor': 3.0},
    'lockstep': {'time_mode': 'lockstep'},
}


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def play(peer, bag, mode, *, is_delayed=False):
    """Excite and record a simulated rig; return what is in the bag, by topic.

    If *is_delayed*, the recorder does not run in the last third of the programme.
    """
    rig = {**FASTER[mode], 'publish_rate': RATE, 'clock_rate': CLOCK_RATES[mode], **lose_nothing()}
    recorder = ('-p', 'use_sim_time:=true', '--', '-o', str(bag))
    with Program('pam_sim', parameters=rig), Program('pam_record', *recorder) as record:
        peer.until(lambda: peer.node.count_subscribers('joint_states'), 'the recorder')
        with Program('pam_excite', parameters=EXCITATION) as excite:
            if is_delayed:
                states = peer.collect(JointState, 'joint_states')
                peer.until(lambda: states and stamp(states[-1]) > LAST_THIRD, 'the last third')
                record.interrupt(signal.SIGSTOP)
                peer.until(lambda: 'vented' in excite.output, 'the end')
                record.interrupt(signal.SIGCONT)
            assert excite.process.wait(2.0 * DEADLINE) == 0, excite.output
            assert f'played {DURATION:.1f} s, vented' in excite.output
        record.stop()
    return contents(bag)


@pytest.fixture(scope='module')
def bags(module_domain, tmp_path_factory):
    folder = tmp_path_factory.mktemp('bags')
    with Peer() as peer:
        return {mode: play(peer, folder / mode, mode) for mode in FASTER}


@pytest.mark.parametrize('mode', FASTER)
def test_what_is_recorded_has_the_time_of_its_sending(bags, mode):
    bag = bags[mode]
    late = np.array([time - stamp(message) for time, message in bag['/joint_states']]) * 1e-9
    assert len(late) > 0.9 * DURATION * RATE
    if mode == 'lockstep':
        # Time stands still until the command: /clock says when it moves on.
        assert not late.any()
        stamps = {stamp(message) for _, message in bag['/joint_states']}
        assert {time for time, _ in bag['/pressure_command']} <= stamps
        return
    periods = np.abs(late) * CLOCK_RATES[mode]
    # It lies between two messages of /clock, unless a busy machine has lost one of these.
    assert np.quantile(periods, 0.95) <= 1.001, np.quantile(periods, (0.9, 0.95, 0.99, 1.0))


@pytest.mark.parametrize('mode', FASTER)
def test_each_state_is_answered_and_the_programme_is_played_in_its_time(bags, mode):
    bag = bags[mode]
    times = np.array([time for time, _ in bag['/pressure_command']]) * 1e-9
    values = np.array([message.data for _, message in bag['/pressure_command']])
    if mode == 'lockstep':
        assert len(times) / np.ptp(times) == pytest.approx(RATE, rel=0.05)
    # The faster time goes, the more states a machine that is busy for a while leaves without an
    # answer: those of a typical second have one.
    seconds = np.bincount((times - times[0]).astype(int))[:-1]
    assert np.median(seconds) == pytest.approx(RATE, rel=0.05)
    # Lockstep waits for the first command, at 1 s; else the last one tells when it began.
    begin = 1.0 if mode == 'lockstep' else times[-1] - DURATION
    plan = programme(Excitation(**PLAN))
    expected = np.interp(times - begin, plan.t, plan.pressure[:, 0])
    off = np.abs(values - expected)
    slack = 3.0 / CLOCK_RATES[mode] * Excitation().pressure_rate  # Pa
    # In lockstep always; else commands are as late as the machine is, and the faster time goes.
    assert (np.max(off) if mode == 'lockstep' else np.median(off)) < slack
    assert values.max() == pytest.approx(plan.pressure.max(), rel=0.02)


def test_in_lockstep_the_rig_moves_the_same_each_time(bags, peer, tmp_path):
    again = play(peer, tmp_path / 'again', 'lockstep')
    runs = [
        {stamp(m): m.position[0] for _, m in bag['/joint_states']}
        for bag in (bags['lockstep'], again)
    ]
    both = runs[0].keys() & runs[1].keys()
    assert len(both) > 0.9 * DURATION * RATE
    assert [runs[0][t] for t in both] == [runs[1][t] for t in both]
    assert np.ptp(list(runs[0].values())) > 0.02


def test_for_a_recorder_that_starts_later_it_waits(bags, peer, tmp_path):
    rig = {**FASTER['lockstep'], 'publish_rate': RATE, 'clock_rate': RATE}
    recorder = ('-p', 'use_sim_time:=true', '--', '-o', str(tmp_path / 'late'))
    simulator = Program('pam_sim', parameters=rig)
    with simulator, Program('pam_excite', parameters=EXCITATION) as excite:
        lacks = 'pressure_command has 1 of 2 subscribers'
        peer.until(lambda: lacks in excite.output, 'the line that it waits')
        with Program('pam_record', *recorder) as record:
            assert excite.process.wait(2.0 * DEADLINE) == 0, excite.output
            record.stop()
    late = contents(tmp_path / 'late')['/pressure_command']
    commands = bags['lockstep']['/pressure_command']
    assert [message.data for _, message in late] == [message.data for _, message in commands]
    assert late[0][1].data == 0.0


def test_a_recorder_that_is_delayed_has_each_command_at_its_time(bags, peer, tmp_path):
    delayed = play(peer, tmp_path / 'delayed', 'lockstep', is_delayed=True)
    runs = [
        [(time, message.data) for time, message in bag['/pressure_command']]
        for bag in (bags['lockstep'], delayed)
    ]
    assert runs[0] == runs[1]
