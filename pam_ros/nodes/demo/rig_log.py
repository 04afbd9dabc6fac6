# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Command a simulated muscle in lockstep, and collect all messages that it publishes."""

import numpy as np
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pam_ros.demo.run import PublishedRun
from pam_ros.demo.stage import progress
from pam_ros.errors import PamError
from pam_ros.nodes.demo.client import Client

TOPICS = ('joint_states', 'pressure', 'force', 'stiffness', 'damping')
STILL = 1e-6  # s: less than a period of the simulator
QUIET = 0.3  # s without a message after which all messages have arrived


def seconds(message: JointState) -> float:
    """Return the stamp of a message in s."""
    return float(message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec)


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

    @property
    def has_begun(self) -> bool:
        """Whether a message has arrived on each topic: from then on none is lost."""
        return all(self._topics)

    def hold(self, command: Float64, duration: float, what: str) -> None:
        """Answer each state with *command* for *duration* s of simulated time, with a bar.

        The simulator is in lockstep: the number of its periods does not depend on the machine.
        """
        end = self.now + duration
        with progress(duration, what, 1.0) as bar:
            while self.now < end - STILL:
                bar.update(self._answer(command))

    def _answer(self, command: Float64) -> float:
        """Publish *command*, await the next state, and return the time that passed in s."""
        before = self.now
        self._client.publish(command, 'pressure_command')
        self._client.until(lambda: self.now > before, f'the state after {before:.3f} s')
        return self.now - before

    def run(self) -> PublishedRun:
        """Return all messages that arrived.

        A Float64 has no stamp, but the simulator publishes all topics together. While it waits for
        a command, no new state is published: messages match if they are counted from the end. A
        state that was published again counts once. Raises PamError if a message was lost.
        """
        counts: list[int] = []
        while counts != (counts := [len(messages) for messages in self._topics]):
            self._client.work(QUIET)
        n = min(counts)
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
        if not np.array_equal(run.force, efforts):
            raise PamError('messages of the simulator were lost: is the machine overloaded?')
        return run.without_repetitions()
