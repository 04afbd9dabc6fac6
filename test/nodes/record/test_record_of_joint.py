# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated joint of two muscles, recorded over DDS and read as ``pam_identify`` reads it."""

import numpy as np
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from pam_ros.nodes.record.node import OF_JOINTS, OF_MUSCLE, missing_topics
from pam_ros.recording.read import read_recording
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.settings.nominal import nominal_joint
from support.bags import written
from support.harness import Program

pytestmark = [pytest.mark.at_any_pace, pytest.mark.usefixtures('domain')]

COMMANDS = [[3e5, 2e5], [2.2e5, 2.8e5], [3.4e5, 3.1e5]]


def recorded(bag):
    """Return how many messages of the joint and of its pressures are in the bag, of each."""
    counts = written(bag)
    return min(counts.get(topic, 0) for topic in ('/joint_states', '/pressures'))


def test_the_bag_of_a_joint_is_a_recording_of_it(peer, tmp_path):
    nominal = nominal_joint('dmsp_20_400n', ['joint=antagonistic', 'muscles=flexor,extensor'])
    bag = tmp_path / 'elbow'
    given = {**nominal.flat(), 'command_timeout': 0.0, 'rate': 200.0}
    states = peer.collect(JointState, 'joint_states')
    with (
        Program('pam_sim', parameters=given),
        Program('pam_record', '--', '-o', str(bag)) as recorder,
    ):
        publisher = peer.node.create_publisher(Float64MultiArray, 'pressure_commands', 10)
        peer.until(lambda: publisher.get_subscription_count() == 2, 'both programs')
        # The recorder has to receive each topic before the joint moves: a signal that
        # begins late is not used. Only messages in the bag show this.
        peer.until(lambda: recorded(bag) > 0, 'messages of both topics in the bag')
        ends = []
        for command in COMMANDS:
            angle = equilibrium(nominal.joint, command)
            publisher.publish(Float64MultiArray(data=command))
            peer.until(
                lambda angle=angle: (
                    states
                    and abs(states[-1].position[0] - angle) < 1e-4
                    and abs(states[-1].velocity[0]) < 1e-3
                ),
                f'rest at {angle}',
            )
            ends.append(angle)
        recorder.interrupt()
        assert recorder.wait() == 0
        output = recorder.output
    found = read_recording(bag, nominal.joint, muscles=nominal.recorded_muscles)
    assert (found.muscles, found.unit) == (('flexor', 'extensor'), 'rad')
    np.testing.assert_array_equal(found.command, COMMANDS)
    assert found.pressure is not None, f'{found.warnings} {output}'
    for k, (angle, command) in enumerate(zip(ends, COMMANDS, strict=True)):
        until = found.command_t[k + 1] if k < 2 else np.inf
        last = np.flatnonzero(found.t < until - 0.05)[-1]
        assert found.position[last] == pytest.approx(angle, abs=2e-3)
        np.testing.assert_allclose(found.pressure[last], command, rtol=1e-9)


@pytest.mark.parametrize(
    ('found', 'missing'),
    [
        ([], [*OF_MUSCLE, '/asked']),
        (['joint_states', '/asked'], list(OF_MUSCLE[1:])),
        (['joint_states', 'pressures'], [*OF_JOINTS[1:5], '/asked']),
        ([*OF_JOINTS, '/asked'], []),
    ],
)
def test_a_topic_of_the_other_kind_of_rig_is_not_missing(found, missing):
    wanted = {**dict.fromkeys((*OF_MUSCLE, *OF_JOINTS), False), '/asked': True}
    assert missing_topics(wanted, found, {*OF_MUSCLE}, {*OF_JOINTS}) == missing
