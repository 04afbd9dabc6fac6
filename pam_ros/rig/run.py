# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate one rig over given stamps: a recording's, or an experiment's on paper."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.rig.bind import bind
from pam_ros.rig.model import RigModel, start_row

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trajectory:
    """What a simulation gives at its stamps, each (n,): s, m, m/s, Pa gauge, N.

    Force is the muscle's pull less its damping, which is what a force cell at its end reads.
    """

    t: Array
    position: Array
    velocity: Array
    pressure: Array
    force: Array


def simulate(
    model: RigModel,
    t: ArrayLike,
    command_t: ArrayLike,
    command: ArrayLike,
    position: float | None = None,
    velocity: float = 0.0,
    step: float = 1e-3,
) -> Trajectory:
    """Run a free rig over the stamps *t* with its commands exactly as stamped.

    t (n,), command_t, command (m,): s and gauge Pa, ascending; a command holds from its stamp
    to the next, the first also before. The rig starts at t[0] after a long rest under the
    command that was in force there, at *position* m (default: where it rests) with *velocity*
    m/s. Samples are the state before a command of the same stamp has acted. Steps are at most
    *step* s and never reach across a command. Raises ParameterError when *step* is too long for
    the model.
    """
    model.check_step(step)
    t, command_t, command = (np.asarray(a, float) for a in (t, command_t, command))
    q = model.row()
    p = command[max(np.searchsorted(command_t + model.delay, t[0]) - 1, 0)]
    y = model.rest(p) if position is None else position
    x = start_row(model.layout, q, p, y, velocity)
    out = np.empty((len(t), 4))
    bind(model.layout, model.active).simulate(
        x, np.empty_like(x), q, t, command_t, command, step, out, True
    )
    return Trajectory(t, *out.T)


def simulate_held(
    model: RigModel,
    t: ArrayLike,
    pressure: ArrayLike,
    position: ArrayLike,
    velocity: ArrayLike | None = None,
    step: float = 1e-3,
) -> Trajectory:
    """Run a rig whose length is prescribed: pressure and position in, force out.

    t, pressure, position, velocity (n,): s, gauge Pa, m, m/s (default: the gradient of the
    position); linear between stamps.
    """
    t, pressure, position = (np.asarray(a, float) for a in (t, pressure, position))
    v = np.gradient(position, t) if velocity is None else np.asarray(velocity, float)
    q = model.row()
    x = start_row(model.layout, q, pressure[0], position[0], v[0])
    out = np.empty((len(t), 4))
    bind(model.layout, model.active).simulate_held(
        x, np.empty_like(x), q, t, pressure, position, v, step, out
    )
    return Trajectory(t, *out.T)
