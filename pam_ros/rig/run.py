# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate one joint at given stamps: those of a recording or of a planned experiment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.arguments import along, array, instance, number, refuse, refuse_shape, stamps
from pam_ros.errors import ParameterError
from pam_ros.muscle.pressure_unit import warn_of_unit
from pam_ros.rig import layout as at
from pam_ros.rig.bind import bind
from pam_ros.rig.changes import changes_of, refuse_onsets, run_over, run_pressures
from pam_ros.rig.equilibrium import rest_position
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import delays_of
from pam_ros.rig.start import behind_reservoir, disturb, start_state
from pam_ros.rig.statics import refuse_position
from pam_ros.rig.step_limit import check_step

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trajectory:
    """Results of a simulation at its stamps: s, then m and m/s (rad and rad/s), each (n,).

    Pressure in Pa gauge and force in N are (n,) for one muscle and (n, muscles) for several.
    The force is that of the muscle minus its damping, as a force cell at its end measures it. If
    a machine moves the muscle, it also includes friction: see :func:`simulate_held`.
    """

    t: Array
    position: Array
    velocity: Array
    pressure: Array
    force: Array


def simulate(
    joint: Joint,
    t: ArrayLike,
    command: ArrayLike,
    command_t: ArrayLike | None = None,
    *,
    position: float | None = None,
    velocity: float = 0.0,
    step: float = 1e-3,
    hidden: Mapping[str, Mapping[str, float]] | None = None,
) -> Trajectory:
    """Simulate a joint at the stamps *t*, with its commands exactly at their stamps.

    t (n,), command_t (m,): s, ascending; None if the commands have the stamps t. command: gauge
    Pa, (m, muscles), a row for each stamp and a column for each muscle; for one muscle also (m,),
    for one stamp also (muscles,). A command is active from its stamp to the next one, the first
    also before its stamp. The joint starts at t[0] after a long rest under the commands that act
    just before t[0], at *position* in m or rad (default: its rest position) with *velocity* in m/s
    or rad/s. *hidden* gives changes of the hidden states from rest, by effect and then by state,
    the same in all muscles. An effect with an onset begins to act at this time on the time axis of
    t. Samples are the state before a command or an onset of the same stamp has acted. Steps are at
    most *step* s and never extend across a command or an onset.

    Raises ParameterError if *step* is too long for the joint, if shapes do not fit, stamps go
    back, a number is not finite, the muscles cannot have *position*, commands are so high that the
    motion is not finite, or *hidden* has an effect that the joint lacks. Warns of commands that
    seem to be in kPa or bar, or are far above p_max.
    """
    step = number('step', step)
    check_step(instance('joint', joint, Joint, 'a Joint'), step)
    t = stamps('t', t)
    clock, command_t = (
        ('t', t) if command_t is None else ('command_t', stamps('command_t', command_t))
    )
    start = [stage for time, stage in joint.stages if time <= max(t[0], 0.0)][-1]
    q, layout = start.parameters(), joint.layout
    command = by_muscle('command', command, clock, command_t.size, layout.muscles)
    warn_of_unit('command', command, joint.muscles)
    velocity = number('velocity', velocity)
    first = _acting(command_t, command, delays_of(layout, q), t[0])
    if position is None:
        s = rest_position(start, first)
    else:
        s = number('position', position)
        refuse_position('position', s, joint)
    x = start_state(layout, q, first, s, velocity)
    if hidden:
        disturb(layout, q, x, first, hidden, start.all_present)
    kernel, changes = bind(layout, joint.active), changes_of(joint, float(t[0]))
    out = run_over(kernel, layout, x, t, q, changes, command_t, command, step, forces=True)
    return trajectory(t, out, joint, 'command', command)


def simulate_pressure(
    joint: Joint,
    t: ArrayLike,
    command: ArrayLike,
    command_t: ArrayLike | None = None,
    *,
    step: float = 1e-3,
) -> Array:
    """Simulate the pressures in the chambers of a joint at the stamps *t*, in Pa gauge.

    The pressure path is simulated alone, since it does not depend on the motion. t, command and
    command_t are those of :func:`simulate`; the chambers start at t[0] after a long rest under the
    commands that act then. The result is (n,) for one muscle and (n, muscles) for several. Steps
    are at most *step* s. Raises ParameterError if an effect has an onset, shapes do not fit,
    stamps go back or a number is not finite. Warns of commands that seem to be in kPa or bar.
    """
    instance('joint', joint, Joint, 'a Joint')
    refuse_onsets(joint, 'simulate_pressure')
    if number('step', step) <= 0.0:
        refuse('step', step, 'more than 0 s')
    t = stamps('t', t)
    clock, command_t = (
        ('t', t) if command_t is None else ('command_t', stamps('command_t', command_t))
    )
    q, layout = joint.parameters(), joint.layout
    command = by_muscle('command', command, clock, command_t.size, layout.muscles)
    warn_of_unit('command', command, joint.muscles)
    first = _acting(command_t, command, delays_of(layout, q), t[0])
    x = start_state(layout, q, first, 0.0, 0.0, joint.all_present)
    kernel = bind(layout, joint.active)
    out = run_pressures(kernel, layout, x, t, q, command_t, command, step)
    pressure: Array = out[:, at.RUN_P :: 2]
    return pressure[:, 0] if layout.muscles == 1 else pressure


def _acting(
    command_t: Array, command: Array, delays: Sequence[float], start: float
) -> list[float]:
    """Return the command (muscles,) in Pa of each muscle that acts just before *start* s."""
    return [
        float(command[max(np.searchsorted(command_t + delay, start) - 1, 0), i])
        for i, delay in enumerate(delays)
    ]


def simulate_held(
    joint: Joint,
    t: ArrayLike,
    pressure: ArrayLike,
    position: ArrayLike,
    velocity: ArrayLike | None = None,
    step: float = 1e-3,
) -> Trajectory:
    """Simulate a joint whose coordinate is prescribed: pressure and position in, force out.

    t, position, velocity (n,): s, ascending, no two equal; m, m/s or rad, rad/s (default: the
    gradient of the position, which needs two stamps). pressure: gauge Pa, (n, muscles), for one
    muscle also (n,). All are linear between stamps, in steps of at most *step* s. The force of
    one muscle in line with its coordinate includes the friction on the joint, against the motion.
    This is the force that a machine measures which moves the actuator: muscle force - damping -
    friction while it shortens, and muscle force + damping + friction while it lengthens. A payload
    and end stops are not included. Raises ParameterError if an effect has an onset, shapes do not
    fit, stamps do not ascend, a number is not finite, the muscles cannot have a position, or
    pressures are so high that a force is not finite.
    """
    instance('joint', joint, Joint, 'a Joint')
    refuse_onsets(joint, 'simulate_held')
    if number('step', step) <= 0.0:
        refuse('step', step, 'more than 0 s')
    t = stamps('t', t, strict=True)
    position = along('position', position, 't', t.size)
    for end in (position.min(), position.max()):
        refuse_position('position', float(end), joint)
    v = _rate(t, position) if velocity is None else along('velocity', velocity, 't', t.size)
    q, layout = joint.parameters(), joint.layout
    pressure = by_muscle('pressure', pressure, 't', t.size, layout.muscles)
    warn_of_unit('pressure', pressure, joint.muscles)
    present = behind_reservoir(joint.all_present)
    x = start_state(layout, q, pressure[0], float(position[0]), float(v[0]), present)
    out = np.empty((len(t), layout.run_columns))
    bind(layout, joint.active).simulate_held(
        x, layout.scratch(), q, t, pressure, position, v, step, out
    )
    return trajectory(t, out, joint, 'pressure', pressure)


def trajectory(t: Array, out: Array, joint: Joint, name: str, pressure: Array) -> Trajectory:
    """Return the columns of a run by name; refuse one that is not finite.

    The *pressure* in Pa that was its input is called *name* in the sentence.
    """
    is_finite = np.isfinite(out).all(axis=1)
    if not is_finite.all():
        p_max = max(muscle.p_max for muscle in joint.muscles)
        raise ParameterError(
            f'the motion is not finite from {t[np.argmin(is_finite)]:g} s on: {name} reaches '
            f'{np.max(np.abs(pressure)):g} Pa, and p_max is {p_max:g} Pa'
        )
    p, f = out[:, at.RUN_P :: 2], out[:, at.RUN_F :: 2]
    if p.shape[1] == 1:
        p, f = p[:, 0], f[:, 0]
    return Trajectory(t, out[:, at.RUN_S], out[:, at.RUN_V], p, f)


def by_muscle(name: str, value: ArrayLike, clock: str, count: int, muscles: int) -> Array:
    """Return *value* as (count, muscles): a row for each of *count* stamps of *clock*.

    The shapes (count,) for one muscle and (muscles,) for one stamp are accepted, too. Others
    raise ParameterError, since the muscle for each number would not be known.
    """
    found, wanted = array(name, value), (count, muscles)
    if (found.shape == (count,) and muscles == 1) or (found.shape == (muscles,) and count == 1):
        return found.reshape(wanted)
    if found.shape != wanted:
        allowed = f'{(count,)}, one number for each stamp of {clock}'
        if muscles > 1:
            allowed = f'{wanted}, a row for each stamp of {clock} and a column for each muscle'
        refuse_shape(name, found, allowed)
    return found


def _rate(t: Array, position: Array) -> Array:
    """Return the gradient of the *position* (n,) over the stamps t."""
    if t.size < 2:
        refuse_shape('t', t, 'at least two stamps, or one stamp and the velocity')
    rate: Array = np.gradient(position, t)
    return rate
