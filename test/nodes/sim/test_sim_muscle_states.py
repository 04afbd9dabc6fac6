# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``muscle_states`` has the stamps of ``joint_states``, and the values of the plain topics."""

import pytest
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import SetBool, Trigger

from support.harness import Program

pytestmark = pytest.mark.at_any_pace

PERIODS = 50
QUANTITIES = ('force', 'stiffness', 'damping', 'pressure')
# It moves from the start, so that no two samples are equal. Time stands still but for ~/step.
MOVING = {
    'time_mode': 'lockstep',
    'step_periods': PERIODS,
    'initial.at_rest': False,
    'initial.pressure': 2e5,
    'initial.position': 0.02,
    'frame_id': 'base',
    'sensor.force_noise': 0.5,
    'sensor.pressure_noise': 100.0,
}
ONE = dict(zip(QUANTITIES, (Float64, Float64, Float64, FluidPressure), strict=True))
ALL = dict.fromkeys(('forces', 'stiffnesses', 'dampings', 'pressures'), Float64MultiArray)
MUSCLES = ('left', 'right')


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def values(message):
    """Return what a plain message says of each muscle."""
    if isinstance(message, FluidPressure):
        return (message.fluid_pressure,)
    return (message.data,) if isinstance(message, Float64) else tuple(message.data)


def samples(items):
    """Return the last samples, each once: where time stands still, they are repeated."""
    return list(dict.fromkeys(items))[-PERIODS:]


@pytest.mark.parametrize(
    ('given', 'kinds', 'muscles'),
    [
        ({}, ONE, ('pam',)),
        ({'muscles': MUSCLES, 'right.mass': 9.0}, ALL, MUSCLES),
        ({'muscles': MUSCLES, 'joint': 'antagonistic', 'muscle_topics': True}, ALL, MUSCLES),
    ],
    ids=['one', 'several', 'pair'],
)
def test_stamps_and_values(peer, given, kinds, muscles):
    joints = peer.collect(JointState, 'joint_states')
    found = peer.collect(JointState, 'muscle_states')
    plain = [peer.collect(kind, topic) for topic, kind in kinds.items()]
    kept = {
        f'qos_overrides./{topic}.publisher.depth': 1000
        for topic in ('joint_states', 'muscle_states', *kinds)
    }
    with Program('pam_sim', parameters=MOVING | kept | given) as sim:
        peer.until(lambda: joints or not sim.is_running, 'the start')
        assert sim.is_running, sim.output
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success
        for messages in (joints, found, *plain):
            peer.until(lambda m=messages: m, 'a first message of each topic')
        last = stamp(joints[-1])
        assert peer.call(Trigger, 'pam_sim/step').success
        end = last + PERIODS * 2_000_000
        peer.until(lambda: stamp(joints[-1]) == stamp(found[-1]) == end, 'the last sample')
        rows = {stamp(m): [tuple(m.position[i::4]) for i in range(len(QUANTITIES))] for m in found}
        expected = [row for time, row in rows.items() if time > last]

        def is_complete():
            return all(
                samples(map(values, messages)) == [row[i] for row in expected]
                for i, messages in enumerate(plain)
            )

        peer.until(is_complete, 'the same values on the plain topics')
    assert samples(map(stamp, joints)) == samples(map(stamp, found))
    assert len(expected) == PERIODS
    for message in found:
        names = [f'{muscle}/{quantity}' for muscle in muscles for quantity in QUANTITIES]
        assert list(message.name) == names
        assert message.header.frame_id == 'base'
        assert not message.velocity
        assert not message.effort
