# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_sim`` publishes against other equations, solved by scipy's DOP853.

``test/simulator/test_plant.py`` has the same without topics, at more rates.
"""

from itertools import pairwise

import numpy as np
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from support.harness import Program, lose_nothing
from support.paper import moved, spring

ZETA, MASS, AMBIENT = 0.15, 20.0, 101325.0
RATE = 1000
RELEASED = {
    'initial.pressure': 600e3,
    'initial.at_rest': False,
    'initial.position': 0.0,
    'publish_rate': float(RATE),
    'command_timeout': 0.0,
    **lose_nothing(),
}


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def from_reset(peer, states, count):
    """Reset the simulator; return the place of the initial state when *count* have followed."""
    peer.more(states)
    before = len(states)
    assert peer.call(Trigger, 'pam_sim/reset').success
    (first, *_) = peer.until(
        lambda: [i for i in range(before, len(states)) if states[i].position[0] == 0.0],
        'the initial state',
    )
    peer.until(lambda: len(states) >= first + count, f'{count} states')
    return first


def are_as(a, b):
    return np.isclose(a, b, rtol=1e-10, atol=0.0)


def check_received(peer, messages, wanted):
    """Wait for the values *wanted* (n,) among unstamped messages: they must be in one piece."""
    # Topics are not discovered in one moment: what came before is no measure of what is to come.
    peer.until(lambda: any(are_as([m.data for m in messages], wanted[-1])), f'{wanted[-1]}')
    values, n = np.array([m.data for m in messages]), len(wanted)
    assert any(np.all(are_as(values[i : i + n], wanted)) for i in range(len(values) - n + 1))


def test_all_topics_are_those_of_the_motion_that_the_commands_cause(peer):
    states = peer.collect(JointState, 'joint_states')
    pressures = peer.collect(FluidPressure, 'pressure')
    floats = {name: peer.collect(Float64, name) for name in ('force', 'stiffness', 'damping')}
    with Program('pam_sim', parameters=RELEASED):
        for messages in (pressures, *floats.values()):
            peer.more(messages)  # all are received before the reset
        first = from_reset(peer, states, RATE // 2)
        for command in (300e3, 500e3, 450e3):
            peer.publish(Float64(data=command), 'pressure_command')
            # On a busy machine states of before the command may still be on their way.
            acts = command + AMBIENT
            peer.until(
                lambda acts=acts: np.isclose(pressures[-1].fluid_pressure, acts, rtol=1e-9),
                'the commanded pressure',
            )
            peer.more(states, RATE // 2)
        received = states[first:]
        position = np.array([m.position[0] for m in received])
        force, k = np.array([spring(600e3, y) for y in position[: RATE // 2]]).T
        check_received(peer, floats['force'], force)
        check_received(peer, floats['stiffness'], k)
        check_received(peer, floats['damping'], 2.0 * ZETA * np.sqrt(MASS * k))
    stamps = np.array([stamp(m) for m in received])
    np.testing.assert_allclose(np.diff(stamps), 1e6, atol=1.1)  # whole ns
    efforts = [spring(600e3, y)[0] for y in position[: RATE // 2]]
    np.testing.assert_allclose([m.effort[0] for m in received[: RATE // 2]], efforts, rtol=1e-12)

    at = {stamp(m): m.fluid_pressure - AMBIENT for m in pressures}
    both = np.array([s in at for s in stamps])
    assert np.mean(both) > 0.99  # the last pressures may still be on their way
    t, y = (stamps[both] - stamps[0]) * 1e-9, position[both]
    v = np.array([m.velocity[0] for m in received])[both]
    p = np.array([at[s] for s in stamps[both]])
    np.testing.assert_allclose(np.unique(p.round(3)), [300e3, 450e3, 500e3, 600e3])
    # A sample is the state before a command of the same stamp acts: a command acts at the last
    # sample that still has the old pressure.
    edges = [0, *np.flatnonzero(np.diff(p)), len(p) - 1]
    assert len(edges) == 5
    now = 0.0, 0.0
    for a, b in pairwise(edges):
        path = moved(p[a + 1], *now, t[a : b + 1])
        assert np.max(np.abs(y[a : b + 1] - path[0])) < 4e-9
        assert np.max(np.abs(v[a : b + 1] - path[1])) < 4e-7
        now = path[:, -1]
    assert np.ptp(y) > 0.08
