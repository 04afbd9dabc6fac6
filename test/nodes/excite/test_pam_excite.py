# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_excite`` as a process, on a rig that the test plays; simulated time where it is long."""

import os
import pty
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from pam_ros.effects import EFFECTS
from pam_ros.excitation.command import command_line
from pam_ros.excitation.programme import programme
from pam_ros.excitation.settings import Excitation
from support.ends import check_refusals
from support.harness import Program
from support.marks import at_release

pytestmark = pytest.mark.usefixtures('domain')

SHORT = {'duration': 30.0, 'countdown': 0.0}
ANTAGONISTIC = Path(__file__).parents[3] / 'config' / 'antagonistic.yaml'
LONGEST = 0.1  # s without a command for which the pressure may change at once
PATIENT = {**SHORT, 'silence': 30.0}  # a busy machine may keep the rig of the test quiet
# Its standard input becomes the terminal that sends it SIGHUP.
ON_TERMINAL = """
import fcntl, termios
from pam_ros.cli.pam_excite import main
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
main()
"""


class Simulation:
    """Answers commands with joint states, and keeps the commands."""

    def __init__(self, peer, name='pam'):
        self.peer, self.names = peer, [name]
        self.position = 0.03
        self.commands = []
        node = peer.node
        self._joints = node.create_publisher(JointState, 'joint_states', 10)
        self._clock = node.create_publisher(Clock, '/clock', 10)
        node.create_subscription(Float64, 'pressure_command', self._take, QoSProfile(depth=20_000))
        self.time = 0.0

    def _take(self, message):
        self.commands.append(message.data)

    def tell(self):
        """Publish the state once."""
        state = JointState(name=self.names, position=[self.position] * len(self.names))
        self._joints.publish(state)
        return True

    def advance(self, seconds):
        """Let simulated time go on."""
        self.time += seconds
        clock = Clock()
        clock.clock.sec, clock.clock.nanosec = divmod(round(self.time * 1e9), 10**9)
        self._clock.publish(clock)

    def until(self, condition, what):
        """Tell the state again and again until *condition*."""
        self.peer.until(lambda: self.tell() and condition(), what)

    def until_pressed(self):
        """Play until there is pressure in the muscle."""
        self.until(lambda: self.commands and self.commands[-1] > 1e4, 'pressure')


@pytest.fixture
def rig(peer):
    return Simulation(peer)


def excite(parameters=PATIENT, *arguments):
    return Program('pam_excite', *ros_arguments(parameters), '--', *arguments)


def ros_arguments(parameters):
    return [text for name, value in parameters.items() for text in ('-p', f'{name}:={value}')]


def check_vented(commands):
    """Let the last command be 0 and the way there no jump, however late each command was."""
    assert commands[-1] == 0.0
    assert np.abs(np.diff(commands)).max() <= LONGEST * Excitation().pressure_rate * (1 + 1e-9)


def test_it_plays_the_programme_to_its_end(rig):
    fast = {'pressure_rate': 1e9}  # that no pause of the process can hold it up
    expected = programme(Excitation(**SHORT, **fast))
    with excite({**PATIENT, **fast, 'use_sim_time': 'true'}) as program:

        def plays():
            rig.advance(0.04)
            return not program.is_running

        rig.until(plays, 'the end')
        assert program.wait() == 0
        output = program.output
    commands = np.array(rig.commands)
    assert commands[0] == 0.0
    assert commands[-1] == 0.0
    assert commands.max() == pytest.approx(450e3)
    # Time is simulated and fast, so that commands are passed over, but none is out of place.
    places = 0
    for command in commands:
        after = np.flatnonzero(expected.pressure[places:, 0] == command)
        assert after.size > 0
        places += after[0]
    for segment in expected.segments:
        assert f' s  {segment.name}' in output
    assert f'played {expected.duration:.1f} s, vented' in output
    assert output.index('total') < output.index(' s  vented')


@pytest.mark.at_any_pace
def test_the_plan_alone(peer, tmp_path):
    commands = peer.collect(Float64, 'pressure_command')
    file = tmp_path / 'plan.csv'
    with excite({'seed': 5, 'joint': 'load'}, '--dry-run', '--csv', str(file)) as program:
        assert program.wait() == 0
        output = program.output
    assert '\nslow_triangle ' in output
    assert 'seed 5' in output
    assert 'outside -16.0 to 100.0 mm' in output
    assert 'the nominal model would move from' in output
    assert 'CAUTION' not in output
    assert 'WARN' not in output
    table = np.genfromtxt(file, delimiter=',', names=True)
    np.testing.assert_array_equal(
        table['pressure_command_Pa'], programme(Excitation(seed=5)).pressure[:, 0]
    )
    assert commands == []


@pytest.mark.at_any_pace
def test_the_command_lines_that_effects_propose_are_accepted():
    for effect in EFFECTS:
        if effect.excitation:
            name, before, *arguments = shlex.split(command_line(effect.excitation))
            assert before == '--ros-args'
            with Program(name, *arguments, '--', '--dry-run') as program:
                assert program.wait() == 0
                played = [line.split()[0] for line in program.output.splitlines()[2:]]
            segments = effect.excitation.get('segments', ())
            assert tuple(played[: len(segments)]) == segments


@pytest.mark.at_any_pace
def test_the_muscle_narrows_the_limits_and_a_window_too_narrow_is_warned_of():
    values = {'muscle': 'dmsp_10', 'contraction_max': 0.1}
    with excite(values, '--dry-run') as program:
        assert program.wait() == 0
        assert 'to 25.0 mm' in program.output
        assert 'CAUTION' in program.output


@pytest.mark.parametrize('position', [0.11, at_release(-0.02), float('nan')])
def test_a_joint_that_leaves_its_window_stops_it(rig, position):
    with excite() as program:
        rig.until_pressed()
        rig.position = position
        rig.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        sentence = next(line for line in program.output.splitlines() if 'stopped' in line)
    assert sentence.startswith('pam_excite: the ')
    assert 'venting' in sentence
    check_vented(rig.commands)


def test_it_stops_if_joint_states_stop(rig, peer):
    with excite({**SHORT, 'silence': 1.0}) as program:
        rig.until_pressed()
        peer.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        assert 'no joint_states for' in program.output
    check_vented(rig.commands)


@pytest.mark.parametrize(
    'kind', [signal.SIGINT, *map(at_release, (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT))]
)
def test_a_signal_vents(rig, kind):
    with excite() as program:
        rig.until_pressed()
        program.interrupt(kind, 2)
        rig.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 0
        assert 'stop requested, venting' in program.output
        assert 'Traceback' not in program.output
    rig.until(lambda: rig.commands[-1] == 0.0, 'the last command')
    check_vented(rig.commands)


def test_a_terminal_that_is_closed_vents(rig):
    terminal, end = pty.openpty()
    with subprocess.Popen(
        [sys.executable, '-c', ON_TERMINAL, '--ros-args', *ros_arguments(PATIENT)],
        stdin=end,
        stdout=end,
        stderr=end,
        start_new_session=True,
    ) as program:
        os.close(end)
        rig.until_pressed()
        os.close(terminal)
        rig.until(lambda: program.poll() is not None, 'the end')
        assert program.returncode == 0
    rig.until(lambda: rig.commands[-1] == 0.0, 'the last command')
    check_vented(rig.commands)


def test_a_reader_of_its_output_that_ends_first_keeps_it_from_nothing(rig):
    with subprocess.Popen(
        [sys.executable, '-m', 'pam_ros.cli.pam_excite', '--ros-args', *ros_arguments(PATIENT)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    ) as program:
        rig.until_pressed()
        program.stderr.close()
        program.send_signal(signal.SIGINT)
        rig.until(lambda: program.poll() is not None, 'the end')
    rig.peer.work(0.5)  # what was sent is received by then: it waits for that
    check_vented(rig.commands)


@pytest.mark.at_any_pace
def test_a_signal_before_it_plays(peer):
    with excite() as program:
        peer.until(lambda: 'total' in program.output, 'the plan')
        program.interrupt()
        assert program.wait() == 0


@pytest.mark.at_any_pace
def test_without_a_rig_it_gives_up():
    with excite({**SHORT, 'patience': 0.1}) as program:
        assert program.wait() == 1
        missing = 'pressure_command has no subscriber, joint_states is not published'
        assert f'{missing}: is the rig running?' in program.output


@pytest.mark.at_any_pace
def test_with_fewer_subscribers_than_it_needs_it_gives_up(rig):
    with excite({**PATIENT, 'patience': 5.0, 'subscribers': 3}) as program:
        rig.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        assert 'pressure_command has 1 of 3 subscribers: is the rig running?' in program.output
    assert rig.commands == []


@pytest.mark.at_any_pace
def test_without_a_clock_it_gives_up():
    with excite({**SHORT, 'patience': 0.1, 'use_sim_time': 'true'}) as program:
        assert program.wait() == 1
        assert 'use_sim_time is set and /clock is not published' in program.output


@pytest.mark.at_any_pace
def test_another_commander_is_named(rig, peer):
    rival = peer.node.create_publisher(Float64, 'pressure_command', 10)
    with excite({**PATIENT, 'countdown': 30.0}) as program:
        rig.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        assert f'/{peer.node.get_name()} commands pressures as well' in program.output
    peer.node.destroy_publisher(rival)


@pytest.mark.at_any_pace
def test_of_several_joints_one_must_be_chosen(rig):
    rig.names = ['base', 'elbow']
    with excite() as program:
        rig.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        assert '2 joints (base, elbow)' in program.output
        assert 'joint_name' in program.output
    with excite({**PATIENT, 'joint_name': 'knee'}) as program:
        rig.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        assert "no joint 'knee': it has base, elbow" in program.output
    with excite({**PATIENT, 'joint_name': 'elbow'}):
        rig.until_pressed()


@pytest.mark.at_any_pace
def test_a_joint_outside_its_window_is_not_started(rig):
    rig.position = 0.2
    with excite() as program:
        rig.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        assert 'is at 200.0 mm' in program.output
    assert rig.commands == []


@pytest.mark.at_any_pace
def test_nothing_can_be_changed_while_it_plays(rig, peer):
    with excite({**PATIENT, 'countdown': 60.0}):
        rig.until(lambda: True, 'the rig')
        for values in ({'seed': 3}, {'mass': 10.0}, {'pressure_max': 6e5}):
            assert not peer.set_one('pam_excite', **values).successful
        (described,) = peer.describe('pam_excite', 'pressure_rate')
        assert described.read_only
        assert 'Pa/s' in described.description


@pytest.mark.at_any_pace
def test_bad_arguments_end_it_with_a_sentence(tmp_path):
    refused = [
        ({'duration': 3.0}, ['duration = 3.0', '30 to 3600 s']),
        ({'pressure_min': 5e5}, ['pressure_min = 500000', 'pressure_max = 450000']),
        ({'presure_max': 4e5}, ['presure_max', 'pressure_max']),
        ({'muscle': 'dmsp_99'}, ['dmsp_99']),
        ({'joint': 'shoulder'}, ["joint = 'shoulder'", 'one of load, parallel, antagonistic']),
        ({'position_min': 1.5}, ['no position is within contraction_min', '1.5 to 10 m']),
        ({'muscles': '[a, b]'}, ['the rig has 2 joints, a, b: choose one with joint_name']),
        ({'muscle': ANTAGONISTIC}, ['describes a joint (antagonistic), not a muscle']),
    ]
    csv = ['--', '--csv', str(tmp_path / 'nowhere' / 'plan.csv')]
    runs = [([*ros_arguments(given), '--'], named) for given, named in refused]
    check_refusals('pam_excite', [*runs, (csv, ['cannot be written'])])
