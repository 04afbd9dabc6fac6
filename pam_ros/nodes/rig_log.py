# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Hear all that a simulated muscle publishes, and put it in step."""

import numpy as np
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pam_ros.demo.run import PublishedRun
from pam_ros.errors import PamError
from pam_ros.nodes.client import Client

QUIET = 0.3  # s without a message after which none is under way any more


class RigLog:
    """Collects the topics of one ``pam_sim`` in the client's namespace."""

    def __init__(self, client: Client, ambient: float = 101325.0) -> None:
        """Subscribe; *ambient* is the simulator's ambient pressure in Pa."""
        self._client, self._ambient = client, ambient
        self.states = client.collect(JointState, 'joint_states')
        self._pressures = client.collect(FluidPressure, 'pressure')
        self._floats = [
            client.collect(Float64, name) for name in ('force', 'stiffness', 'damping')
        ]

    @property
    def now(self) -> float:
        """The stamp of the last state in s."""
        return seconds(self.states[-1])

    def put_in_step(self) -> PublishedRun:
        """Return all that came, once the simulator has stopped.

        Floats carry no stamp, but the simulator publishes all topics in one go: counted from
        their ends they are in step. Raises PamError where a message was lost.
        """
        topics = [self.states, self._pressures, *self._floats]
        while True:
            before = [len(messages) for messages in topics]
            self._client.work(QUIET)
            if before == [len(messages) for messages in topics]:
                break
        n = min(before)
        states, pressures, force, stiffness, damping = (m[len(m) - n :] for m in topics)
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


def seconds(message: JointState) -> float:
    """Return the stamp of a message in s."""
    return message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
