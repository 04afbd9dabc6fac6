# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate one joint over given stamps: a recording's, or an experiment's on paper."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.errors import ParameterError
from pam_ros.rig import layout as at
from pam_ros.rig.bind import bind
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import Layout
from pam_ros.rig.rest import rest
from pam_ros.rig.start import disturb, start_state
from pam_ros.rig.step_limit import check_step

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trajectory:
    """What a simulation gives at its stamps: s, then m and m/s (rad and rad/s), each (n,).

    Pressure in Pa gauge and force in N are (n,) for one muscle and (n, muscles) for several.
    Force is the muscle's pull less its damping, which is what a force cell at its end reads.
    """

    t: Array
    position: Array
    velocity: Array
    pressure: Array
    force: Array


def simulate(
    joint: Joint,
    t: ArrayLike,
    command_t: ArrayLike,
    command: ArrayLike,
    position: float | None = None,
    velocity: float = 0.0,
    step: float = 1e-3,
    hidden: Mapping[str, Mapping[str, float]] | None = None,
) -> Trajectory:
    """Run a joint over the stamps *t* with its commands exactly as stamped.

    t (n,), command_t (m,): s, ascending. command: gauge Pa, (m,) for one muscle or for all alike,
    else (m, muscles); a command holds from its stamp to the next, the first also before. The
    joint starts at t[0] after a long rest under the commands that were in force there, at
    *position* (default: where it rests) with *velocity*, and with its *hidden* states so far from
    rest (effect, then state, then the change; in all muscles alike). Samples are the state before
    a command of the same stamp has acted. Steps are at most *step* s and never reach across a
    command. Raises ParameterError when *step* is too long for the joint, or the shapes do not fit.
    """
    check_step(joint, step)
    t, command_t, command = (np.asarray(a, float) for a in (t, command_t, command))
    q, layout = joint.parameters(), joint.layout
    command = by_muscle(command, layout.muscles, 'command')
    delays = delays_of(layout, q)
    first = [
        command[max(np.searchsorted(command_t + delay, t[0]) - 1, 0), i]
        for i, delay in enumerate(delays)
    ]
    s = rest(joint, first) if position is None else position
    x = start_state(layout, q, first, s, velocity)
    if hidden:
        disturb(layout, q, x, first, hidden)
    out = np.empty((len(t), layout.run_columns))
    act_t, acting = acting_commands(command_t, command, delays)
    bind(layout, joint.active).simulate(x, layout.scratch(), q, t, act_t, acting, step, out, True)
    return trajectory(t, out)


def simulate_held(
    joint: Joint,
    t: ArrayLike,
    pressure: ArrayLike,
    position: ArrayLike,
    velocity: ArrayLike | None = None,
    step: float = 1e-3,
) -> Trajectory:
    """Run a joint whose coordinate is prescribed: pressure and position in, force out.

    t, position, velocity (n,): s, m, m/s or rad, rad/s (default: the gradient of the position);
    pressure: gauge Pa, as the commands of :func:`simulate`; linear between stamps.
    """
    t, pressure, position = (np.asarray(a, float) for a in (t, pressure, position))
    v = np.gradient(position, t) if velocity is None else np.asarray(velocity, float)
    q, layout = joint.parameters(), joint.layout
    pressure = by_muscle(pressure, layout.muscles, 'pressure')
    x = start_state(layout, q, pressure[0], float(position[0]), float(v[0]))
    out = np.empty((len(t), layout.run_columns))
    bind(layout, joint.active).simulate_held(
        x, layout.scratch(), q, t, pressure, position, v, step, out
    )
    return trajectory(t, out)


def trajectory(t: Array, out: Array) -> Trajectory:
    """Return the columns of a run by name."""
    p, f = out[:, at.RUN_P :: 2], out[:, at.RUN_F :: 2]
    if p.shape[1] == 1:
        p, f = p[:, 0], f[:, 0]
    return Trajectory(t, out[:, at.RUN_S], out[:, at.RUN_V], p, f)


def by_muscle(values: Array, muscles: int, what: str) -> Array:
    """Return *values* (n,) or (n, muscles) as (n, muscles); raises ParameterError otherwise."""
    if values.ndim == 1:
        values = np.repeat(values[:, None], muscles, axis=1)
    if values.ndim != 2 or values.shape[1] != muscles:
        raise ParameterError(
            f'{what} has the shape {values.shape}: give one column for each of {muscles} muscles'
        )
    return np.ascontiguousarray(values)


def delays_of(layout: Layout, q: Array) -> tuple[float, ...]:
    """Return the time in s by which commands act late in each muscle of the parameters q."""
    delays = [
        (effect.delay, layout.parameter_at[effect.name])
        for effect in layout.library
        if effect.delay is not None
    ]
    return tuple(float(sum(delay(row, j) for delay, j in delays)) for row in q[at.MUSCLE :])


def acting_commands(
    command_t: Array, command: Array, delays: tuple[float, ...]
) -> tuple[Array, Array]:
    """Return the stamps at which commands act, and the commands (m, muscles) from each on.

    A command acts its muscle's delay after its stamp; where the muscles' delays differ, all stamps
    at which one of them changes are stamps of all.
    """
    acts = [command_t + delay for delay in delays]
    if all(delay == delays[0] for delay in delays):
        return acts[0], command
    stamps = np.unique(np.concatenate(acts))
    columns = [
        command[np.maximum(np.searchsorted(own, stamps, side='right') - 1, 0), i]
        for i, own in enumerate(acts)
    ]
    return stamps, np.ascontiguousarray(np.stack(columns, axis=1))
