# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Muscles that are stepped in time: what the simulator node and the controllers' tests drive."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.rig import layout as at
from pam_ros.rig.bind import bind
from pam_ros.rig.model import RigModel, start_effects, start_row

Array = NDArray[np.float64]


class Rig:
    """One or more muscles with their loads, stepped together at a fixed step.

    All quantities are arrays with one entry a muscle, in the order of *models*: position m and
    velocity m/s (contraction positive), pressure Pa gauge in the chamber, force N (pulling),
    stiffness N/m, damping N s/m. Steps are counted, so time is exact; the same models, start
    and commands give the same bits, however the steps are split into calls.

    *models* must share one library of effects. *step* is in s. Raises ParameterError when it is
    too long for one of them.
    """

    def __init__(self, models: Sequence[RigModel], step: float = 1e-3) -> None:
        """Make the rig at rest at 0 Pa; see :meth:`reset` to start elsewhere."""
        n = len(models)
        self.step = step
        self.models: tuple[RigModel, ...] = ()
        self._layout = models[0].layout
        self._x = np.zeros((n, self._layout.width))
        self._scratch = np.zeros_like(self._x)
        self._out = np.zeros((n, 4))
        # Commands under way in the pressure path: stamps and values, grown as they are needed.
        self._at = np.zeros((n, 16))
        self._queue = np.zeros((n, 16))
        self.change(models)
        self.reset(np.zeros(n), [m.rest(0.0) for m in models], np.zeros(n))

    def change(self, models: Sequence[RigModel]) -> None:
        """Go on from the present state with other parameters; with these errors, with the old.

        Hidden states are kept; an effect that was absent starts as after a long rest here.
        """
        for model in models:
            model.check_step(self.step)
        self._q = np.array([m.row() for m in models])
        for x, q, old, new in zip(self._x, self._q, self.models, models, strict=False):
            appeared = tuple(e for e in new.present if e not in old.present)
            start_effects(appeared, self._layout, q, x, x[at.P])
        self.models = tuple(models)
        self._kernel = bind(self._layout, max((m.active for m in models), key=len))

    def reset(self, pressure: ArrayLike, position: ArrayLike, velocity: ArrayLike) -> None:
        """Set time to 0 and the state to these arrays, after a long rest at *pressure* there.

        *pressure* is also the command in force; commands under way are forgotten.
        """
        self._k = 0
        self._u = np.array(pressure, dtype=float)
        self._count = np.zeros(len(self._u), dtype=np.int64)
        position, velocity = np.asarray(position, float), np.asarray(velocity, float)
        for m, q in enumerate(self._q):
            self._x[m] = start_row(self._layout, q, self._u[m], position[m], velocity[m])

    def command(self, pressure: ArrayLike) -> None:
        """Command these gauge pressures in Pa from the present time on."""
        for m, value in enumerate(np.broadcast_to(np.asarray(pressure, float), self._u.shape)):
            i = int(self._count[m])
            if i and self._at[m, i - 1] == self.time:
                i -= 1  # the last one counts
            elif i == self._at.shape[1]:
                self._at = np.concatenate([self._at, self._at], axis=1)
                self._queue = np.concatenate([self._queue, self._queue], axis=1)
            self._at[m, i], self._queue[m, i] = self.time, value
            self._count[m] = i + 1

    def advance(self, steps: int = 1) -> None:
        """Step all muscles *steps* times."""
        self._kernel.advance(
            self._x,
            self._scratch,
            self._q,
            self._u,
            self._at,
            self._queue,
            self._count,
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
        """Position y in m, contraction positive (muscles,)."""
        return np.array(self._x[:, at.Y])

    @property
    def velocity(self) -> Array:
        """Velocity in m/s (muscles,)."""
        return np.array(self._x[:, at.V])

    @property
    def pressure(self) -> Array:
        """Gauge pressure in the chamber in Pa (muscles,)."""
        return np.array(self._x[:, at.P])

    def outputs(self) -> Array:
        """Return force N, stiffness N/m, damping N s/m, acceleration m/s^2 as (muscles, 4).

        Force is the muscle's pull, effects included, without its damping.
        """
        self._kernel.outputs(self._x, self._scratch, self._q, self.time, self._out)
        return np.array(self._out)
