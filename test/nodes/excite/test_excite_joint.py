# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_excite`` and a joint of two muscles: its commands, when it stops, what is recorded."""

from pathlib import Path

import numpy as np
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray

from pam_ros.excitation.programme import programme
from pam_ros.excitation.settings import Excitation
from support.harness import Program
from support.marks import at_release

pytestmark = pytest.mark.usefixtures('domain')

ANTAGONISTIC = str(Path(__file__).parents[3] / 'config' / 'antagonistic.yaml')
PATIENT = {'duration': 30.0, 'countdown': 0.0, 'silence': 30.0, 'patience': 60.0}
PAIR = {'joint': 'antagonistic', **PATIENT}


class Elbow:
    """Publishes the angle of a joint, and keeps the commands of its muscles."""

    def __init__(self, peer):
        self.peer, self.angle = peer, 0.0
        self.messages = peer.collect(Float64MultiArray, 'pressure_commands')
        self._joints = peer.node.create_publisher(JointState, 'joint_states', 10)

    @property
    def commands(self):
        return np.array([message.data for message in self.messages])

    def tell(self):
        self._joints.publish(JointState(name=['elbow'], position=[self.angle]))
        return True

    def until(self, condition, what):
        self.peer.until(lambda: self.tell() and condition(), what)

    def until_pressed(self):
        self.until(lambda: self.messages and min(self.messages[-1].data) > 1e4, 'pressure')


@pytest.fixture
def elbow(peer):
    return Elbow(peer)


@pytest.mark.parametrize('angle', [-1.5, at_release(1.5), at_release(float('nan'))])
def test_a_joint_that_leaves_its_window_is_vented_on_both_sides(elbow, angle):
    with Program('pam_excite', parameters=PAIR) as program:
        elbow.until_pressed()
        elbow.angle = angle
        elbow.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        sentence = next(line for line in program.output.splitlines() if 'stopped' in line)
    where = f'at {angle:.3f} rad, outside its window of -1.400 to 1.400 rad'
    assert where in sentence or 'the position of the joint is nan' in sentence
    commands = elbow.commands
    assert commands.shape[1] == 2
    assert not commands[-1].any()
    assert np.abs(np.diff(commands, axis=0)).max() <= 0.1 * Excitation().pressure_rate * (1 + 1e-9)
    assert elbow.messages[0].layout.dim[0].label == 'pam_1,pam_2'


@pytest.mark.parametrize(
    ('kind', 'topic'),
    [(Float64MultiArray, 'pressure_commands'), (Float64, 'pam_2/pressure_command')],
)
def test_another_commander_of_the_joint_is_named(elbow, peer, kind, topic):
    rival = peer.node.create_publisher(kind, topic, 10)
    with Program('pam_excite', parameters=PAIR) as program:
        elbow.until(lambda: not program.is_running, 'the end')
        assert program.wait() == 1
        assert f'/{peer.node.get_name()} commands pressures as well' in program.output
    peer.node.destroy_publisher(rival)
    assert not elbow.messages


def test_muscles_with_topics_of_their_own_are_all_waited_for(peer, elbow):
    """And each of them is commanded when it is there."""
    given = {**PAIR, 'muscles': ['flexor', 'extensor'], 'muscle_topics': True}
    flexor = peer.collect(Float64, 'flexor/pressure_command')
    with Program('pam_excite', parameters=given) as program:
        lacks = 'extensor/pressure_command has no subscriber'
        elbow.until(lambda: lacks in program.output, 'the line that it waits')
        assert 'flexor/pressure_command has no subscriber' not in program.output
        assert not flexor
        extensor = peer.collect(Float64, 'extensor/pressure_command')
        elbow.until(lambda: extensor and extensor[-1].data > 1e4, 'pressure')
        assert flexor
    assert not elbow.messages


@pytest.mark.at_any_pace
def test_the_plan_of_a_joint_and_its_file(peer, tmp_path):
    file = tmp_path / 'plan.csv'
    options = ('--params-file', ANTAGONISTIC, '--', '--dry-run', '--csv', str(file))
    with Program('pam_excite', *options) as program:
        assert program.wait() == 0, program.output
        output = program.output
    assert 'stops and vents outside -1.400 to 1.400 rad, and after 0.5 s' in output
    assert 'the nominal model would move from -1.' in output
    assert 'CAUTION' not in output
    assert 'WARN' not in output
    table = np.loadtxt(file, delimiter=',', skiprows=1)
    np.testing.assert_array_equal(table[:, 1:], programme(Excitation(), (1, -1)).pressure)
