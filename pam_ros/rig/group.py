# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints of one kind that are advanced together: their matrices, commands and kernel."""

from collections.abc import Sequence
from math import ceil

import numpy as np
from numpy.typing import NDArray

from pam_ros.rig import layout as at
from pam_ros.rig.bind import bind
from pam_ros.rig.changes import appeared
from pam_ros.rig.joint import Joint
from pam_ros.rig.start import begin_effects, start_state

Array = NDArray[np.float64]
QUEUE_LENGTH = 16  # commands of a muscle that may wait for their delay before the queues grow


class Group:
    """Joints with the same layout.

    x, q: one matrix for each joint; arrays over the muscles begin with (joints, muscles).
    ``joints`` are the given joints; the parameters q are those of the effects that act now.
    """

    def __init__(self, joints: Sequence[Joint], step: float) -> None:
        """Create the matrices for steps of *step* s; :meth:`reset` sets the state."""
        self.layout = layout = joints[0].layout
        n, self.muscles = len(joints), layout.muscles
        self.step = step
        self._declare(joints)
        self._changes: list[int] = []  # later steps, before which effects begin to act
        self._present = [joint.at_start for joint in joints]
        self.q = np.array([joint.parameters() for joint in self._present])
        self.x = np.array([layout.state() for _ in joints])
        # Parts of the state: coordinates and velocities of the joints, pressures of the muscles.
        self.s, self.v = self.x[:, at.JOINT, at.S], self.x[:, at.JOINT, at.V]
        self.p = self.x[:, at.MUSCLE :, at.P]
        self._scratch = np.array([layout.scratch() for _ in joints])
        self.u = np.zeros((n, self.muscles))  # commands that act now, Pa
        # Stamps and values of commands that wait for the delay of the pressure path; can grow.
        self._at = np.zeros((n, self.muscles, QUEUE_LENGTH))
        self._queue = np.zeros((n, self.muscles, QUEUE_LENGTH))
        self._count = np.zeros((n, self.muscles), dtype=np.int64)
        self._done = np.zeros_like(self._count)
        self.out = np.zeros((n, self.muscles, at.OUTPUTS))
        self.joint_out = np.zeros((n, at.JOINT_OUTPUTS))
        self._bind()

    def _bind(self) -> None:
        active = max((joint.active for joint in self.joints), key=len)
        self._kernel = bind(self.layout, active)

    def _declare(self, joints: Sequence[Joint]) -> None:
        self.joints: tuple[Joint, ...] = tuple(joints)
        self._stages = [
            [(self._first_step(time), stage) for time, stage in joint.stages] for joint in joints
        ]

    def _first_step(self, time: float) -> int:
        """Return the number of the first step that does not begin before *time* s."""
        return ceil(time / self.step - 1e-9)

    def change(self, joints: Sequence[Joint], k: int) -> None:
        """Continue from the present state at step number k with *joints* of the same layout.

        Effects that were absent and act at step number k begin to act.
        """
        self._declare(joints)
        self._take_effect(k)
        self._bind()

    def _take_effect(self, k: int) -> None:
        """Give all joints the effects that act from step number k on."""
        firsts = {first for stages in self._stages for first, _ in stages}
        self._changes = sorted(first for first in firsts if first > k)
        for a, stages in enumerate(self._stages):
            before = self._present[a]
            after = self._present[a] = [stage for first, stage in stages if first <= k][-1]
            if after is not before:
                begin_effects(self.layout, self.q[a], self.x[a], appeared(before, after))
                self.q[a] = after.parameters()

    def prepare(self) -> None:
        """Call both kernels of these joints, without effects and with all, for 0 steps."""
        present = self._kernel
        for active in ((), self.layout.library):
            self._kernel = bind(self.layout, active)
            self._step(0, 0)
            self.look(0.0)
        self._kernel = present

    def reset(self, pressures: Array, s: Array, v: Array) -> None:
        """Set the state after a long rest; *pressures* (joints, muscles) become the commands."""
        self.u[:] = pressures
        self._count[:] = 0
        self._take_effect(0)
        for a, q in enumerate(self.q):
            self.x[a] = start_state(self.layout, q, self.u[a], float(s[a]), float(v[a]))

    def command(self, joint: int, muscle: int, time: float, pressure: float) -> None:
        """Command one muscle's pressure in Pa from *time* on."""
        i = int(self._count[joint, muscle])
        if i and self._at[joint, muscle, i - 1] == time:
            i -= 1  # the new command replaces it
        elif i == self._at.shape[2]:
            self._at = np.concatenate([self._at, self._at], axis=2)
            self._queue = np.concatenate([self._queue, self._queue], axis=2)
        self._at[joint, muscle, i], self._queue[joint, muscle, i] = time, pressure
        self._count[joint, muscle] = i + 1

    def advance(self, k: int, steps: int) -> None:
        """Advance all joints by *steps* steps from step number k; effects begin at their steps."""
        end = k + steps
        while self._changes and self._changes[0] < end:
            begins = self._changes[0]
            self._step(k, begins - k)
            self._take_effect(begins)
            k = begins
        self._step(k, end - k)

    def _step(self, k: int, steps: int) -> None:
        self._kernel.advance(
            self.x,
            self._scratch,
            self.q,
            self.u,
            self._at,
            self._queue,
            self._count,
            self._done,
            k,
            steps,
            self.step,
        )

    def look(self, time: float) -> None:
        """Fill ``out`` and ``joint_out`` by ``outputs`` of the kernel."""
        self._kernel.outputs(self.x, self._scratch, self.q, time, self.out, self.joint_out)
