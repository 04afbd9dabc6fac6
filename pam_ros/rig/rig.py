# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints that are stepped in time: what the simulator node and the controllers' tests drive."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.errors import ParameterError
from pam_ros.rig import layout as at
from pam_ros.rig.assembly import Assembly, Model, assemble
from pam_ros.rig.bind import bind, bind_joints
from pam_ros.rig.joint_model import JointModel
from pam_ros.rig.model import start_effects, start_row

Array = NDArray[np.float64]


class Rig:
    """One or more joints with their muscles, stepped together at a fixed step.

    A joint is a muscle with a load of its own (a ``RigModel``), or several muscles on one load
    (a ``JointModel``). All quantities are arrays. With one entry a joint, in the order of
    *models*: position m and velocity m/s (contraction positive), for a revolute joint rad and
    rad/s. With one entry a muscle, in the order of joints and of muscles within them: pressure
    Pa gauge in the chamber, force N (pulling), stiffness N/m, damping N s/m. Where each muscle
    has a load of its own, these are the same. Steps are counted, so time is exact; the same
    models, start and commands give the same bits, however the steps are split into calls.

    *models* must share one library of effects. *step* is in s. Raises ParameterError when it is
    too long for one of them.
    """

    def __init__(self, models: Sequence[Model], step: float = 1e-3) -> None:
        """Make the rig at rest at 0 Pa; see :meth:`reset` to start elsewhere."""
        self.step = step
        self.models: tuple[Model, ...] = ()
        self._layout = models[0].layout
        self._rows: Assembly = assemble(models)
        n = len(self._rows.q)
        self._x = np.zeros((n, self._layout.width))
        self._scratch = np.zeros_like(self._x)
        self._out = np.zeros((n, 4))
        self._joint_out = np.zeros((len(models), 3))
        # Commands under way in the pressure path: stamps and values, grown as they are needed.
        self._at = np.zeros((n, 16))
        self._queue = np.zeros((n, 16))
        self._taken = np.zeros(n, dtype=np.int64)
        self.change(models)
        self.reset(
            np.zeros(len(self._rows.muscle)), [m.rest(0.0) for m in models], np.zeros(len(models))
        )

    def change(self, models: Sequence[Model]) -> None:
        """Go on from the present state with other parameters; with these errors, with the old.

        Hidden states are kept; an effect that was absent starts as after a long rest here.
        Raises ParameterError for joints of other kinds: those are another rig.
        """
        for model in models:
            model.check_step(self.step)
        old, new = self._rows, assemble(models)
        if not np.array_equal(old.kind, new.kind):
            raise ParameterError('a rig that runs keeps its joints: make a new one for others')
        active = max((m.active for m in models), key=len)
        self._rows, self._is_plain = new, new.is_plain
        self._muscles: Any = slice(None) if new.is_plain else new.muscle
        self._loads: Any = slice(None) if new.is_plain else new.load
        if self.models:
            self._place(models)
            for x, q, before, now in zip(self._x, new.q, old.present, new.present, strict=True):
                appeared = tuple(e for e in now if e not in before)
                start_effects(appeared, self._layout, q, x, x[at.P])
        self.models = tuple(models)
        if new.is_plain:
            self._kernel = bind(self._layout, active)
        else:
            self._joint_kernel = bind_joints(self._layout, active)

    def _place(self, models: Sequence[Model]) -> None:
        """Put muscles where their joints are."""
        for a, model in enumerate(models):
            if isinstance(model, JointModel):
                s, v = self._x[self._rows.load[a], [at.Y, at.V]]
                for i, row in enumerate(range(self._rows.first[a], self._rows.load[a])):
                    self._x[row, at.Y] = model.joint.position(s, i, model.geometry)
                    self._x[row, at.V] = model.joint.arm(s, i, model.geometry) * v

    def reset(self, pressure: ArrayLike, position: ArrayLike, velocity: ArrayLike) -> None:
        """Set time to 0 and the state to these arrays, after a long rest at *pressure* there.

        *pressure* (muscles,) is also the command in force; commands under way are forgotten.
        *position* and *velocity* are (joints,).
        """
        rows = self._rows
        self._k = 0
        self._u = np.zeros(len(rows.q))
        self._u[rows.muscle] = pressure
        self._count = np.zeros(len(self._u), dtype=np.int64)
        self._x[:] = 0.0
        self._x[rows.load, at.Y], self._x[rows.load, at.V] = position, velocity
        self._place(self.models)
        for m in rows.muscle:
            self._start(m, self._u[m])
        for first, load in zip(rows.first, rows.load, strict=True):
            if load > first:
                self._start(load, float(np.mean(self._x[first:load, at.P])))

    def _start(self, row: int, pressure: float) -> None:
        y, v = self._x[row, at.Y], self._x[row, at.V]
        self._x[row] = start_row(self._layout, self._rows.q[row], pressure, y, v)

    def command(self, pressure: ArrayLike) -> None:
        """Command these gauge pressures in Pa, (muscles,) or one for all, from now on."""
        muscles = self._rows.muscle
        values = np.broadcast_to(np.asarray(pressure, float), muscles.shape)
        for m, value in zip(muscles.tolist(), values.tolist(), strict=True):
            self._enqueue(m, value)

    def command_one(self, muscle: int, pressure: float) -> None:
        """Command the gauge pressure of one muscle in Pa from now on; the others keep theirs."""
        self._enqueue(int(self._rows.muscle[muscle]), pressure)

    def _enqueue(self, m: int, value: float) -> None:
        i = int(self._count[m])
        if i and self._at[m, i - 1] == self.time:
            i -= 1  # the last one counts
        elif i == self._at.shape[1]:
            self._at = np.concatenate([self._at, self._at], axis=1)
            self._queue = np.concatenate([self._queue, self._queue], axis=1)
        self._at[m, i], self._queue[m, i] = self.time, value
        self._count[m] = i + 1

    def advance(self, steps: int = 1) -> None:
        """Step all joints *steps* times."""
        rows = self._rows
        if self._is_plain:
            self._kernel.advance(
                self._x,
                self._scratch,
                rows.q,
                self._u,
                self._at,
                self._queue,
                self._count,
                self._k,
                steps,
                self.step,
            )
        else:
            self._joint_kernel.advance_joints(
                self._x,
                self._scratch,
                rows.q,
                rows.g,
                self._u,
                self._at,
                self._queue,
                self._count,
                self._taken,
                rows.kind,
                rows.first,
                rows.load,
                self._k,
                steps,
                self.step,
            )
        self._k += steps

    @property
    def time(self) -> float:
        """Simulated time in s since the last reset."""
        return self._k * self.step

    @property
    def position(self) -> Array:
        """Position y in m, contraction positive, or angle in rad (joints,)."""
        return np.array(self._x[self._loads, at.Y])

    @property
    def velocity(self) -> Array:
        """Velocity in m/s or rad/s (joints,)."""
        return np.array(self._x[self._loads, at.V])

    @property
    def contraction(self) -> Array:
        """Contraction as a fraction of the length at rest (muscles,)."""
        return np.array(self._x[self._muscles, at.Y] / self._rows.q[self._muscles, at.L0])

    @property
    def pressure(self) -> Array:
        """Gauge pressure in the chamber in Pa (muscles,)."""
        return np.array(self._x[self._muscles, at.P])

    def outputs(self) -> Array:
        """Return force N, stiffness N/m, damping N s/m, acceleration m/s^2 as (muscles, 4).

        Force is the muscle's pull, effects included, without its damping; the acceleration is
        that of the muscle's end.
        """
        self._look()
        return np.array(self._out[self._muscles])

    def joint_outputs(self) -> Array:
        """Return effort, stiffness and acceleration as (joints, 3).

        Effort in N or N m is what the muscles pull, effects included, without their damping;
        stiffness in N/m or N m/rad is what they give, gravity apart; acceleration in m/s^2 or
        rad/s^2.
        """
        self._look()
        return np.array(self._out[:, (0, 1, 3)] if self._is_plain else self._joint_out)

    def _look(self) -> None:
        rows = self._rows
        if self._is_plain:
            self._kernel.outputs(self._x, self._scratch, rows.q, self.time, self._out)
        else:
            self._joint_kernel.outputs_of_joints(
                self._x,
                self._scratch,
                rows.q,
                rows.g,
                rows.kind,
                rows.first,
                rows.load,
                self.time,
                self._out,
                self._joint_out,
            )
