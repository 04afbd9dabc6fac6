# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Collect all messages of a simulated muscle, and match them by time."""

import numpy as np
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pam_ros.demo.run import PublishedRun
from pam_ros.errors import PamError
from pam_ros.nodes.demo.client import Client

TOPICS = ('joint_states', 'pressure', 'force', 'stiffness', 'damping')
HISTORY = 5000  # messages that the simulator keeps for a late subscriber: 10 s at 500 Hz
QUIET = 0.3  # s without a message after which all messages have arrived


def seconds(message: JointState) -> float:
    """Return the stamp of a message in s."""
    return float(message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec)


def lose_nothing(namespace: str = '') -> dict[str, int]:
    """Return the parameters with which a ``pam_sim`` keeps messages until they are received."""
    return {f'qos_overrides.{namespace}/{topic}.publisher.depth': HISTORY for topic in TOPICS}


class RigLog:
    """Collects the topics of one ``pam_sim`` in the client's namespace."""

    def __init__(self, client: Client, ambient: float = 101325.0) -> None:
        """Subscribe; *ambient* is the simulator's ambient pressure in Pa."""
        self._client, self._ambient = client, ambient
        kinds = (JointState, FluidPressure, Float64, Float64, Float64)
        self._topics = [client.collect(k, name) for k, name in zip(kinds, TOPICS, strict=True)]
        self.states = self._topics[0]

    @property
    def now(self) -> float:
        """The stamp of the last state in s."""
        return seconds(self.states[-1])

    def put_in_step(self) -> PublishedRun:
        """Reduce the simulator's publish_rate to 1 Hz, and return all messages that arrived.

        Floats carry no stamp, but the simulator publishes all topics together. When all messages
        have arrived, they match if they are counted from the end. Raises PamError if one was lost.
        """
        self._client.set_together('pam_sim', publish_rate=1.0)
        before = None
        while before != (before := [len(messages) for messages in self._topics]):
            self._client.work(QUIET)
        n = min(before)
        states, pressures, force, stiffness, damping = (m[len(m) - n :] for m in self._topics)
        run = PublishedRun(
            np.array([seconds(m) for m in states]),
            np.array([m.position[0] for m in states]),
            np.array([m.velocity[0] for m in states]),
            np.array([m.fluid_pressure for m in pressures]) - self._ambient,
            np.array([m.data for m in force]),
            np.array([m.data for m in stiffness]),
            np.array([m.data for m in damping]),
        )
        efforts = np.array([m.effort[0] for m in states])
        if not np.array_equal(run.force, efforts) or np.any(np.diff(run.t) <= 0.0):
            raise PamError('messages of the simulator were lost: is the machine overloaded?')
        return run
