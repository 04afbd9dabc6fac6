# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs in which effects begin to act after the start.

Before their onset these effects are absent. At the onset their memories are at rest at the present
state of the rig, and the run continues from this state: no pressure and no position jumps. The run
is divided exactly at the onset, independently of the samples, so that it is smooth there.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.errors import ParameterError
from pam_ros.rig.bind import Kernel
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import Layout, delays_of
from pam_ros.rig.start import begin_effects

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Change:
    """A change at ``time`` s: the parameters become ``q`` (rows, parameters).

    ``begun`` are the effects that begin to act, those on the joint, then those in each muscle.
    """

    time: float
    q: Array
    begun: Sequence[Sequence[type[Effect]]]


def changes_of(joint: Joint, start: float) -> list[Change]:
    """Return the changes in a run of *joint* that begins at *start* s, in the order of time."""
    return [
        Change(time, after.parameters(), appeared(before, after))
        for (_, before), (time, after) in pairwise(joint.stages)
        if time > start
    ]


def refuse_onsets(joint: Joint, who: str) -> None:
    """Raise ParameterError if an effect of *joint* has an onset above 0: *who* allows none."""
    for effects in (joint.effects, *(actuator.effects for actuator in joint.actuators)):
        for effect in effects:
            if effect.onset > 0.0:
                raise ParameterError(
                    f'effects.{effect.name}.onset = {effect.onset:g} s is not allowed: {who} '
                    'takes effects that act from the start, give 0 or leave the effect out'
                )


def appeared(before: Joint, after: Joint) -> tuple[tuple[type[Effect], ...], ...]:
    """Return the effects that *after* has and *before* does not have, by row as in ``present``."""
    return tuple(
        tuple(effect for effect in now if effect not in then)
        for then, now in zip(before.present, after.present, strict=True)
    )


def run_over(
    kernel: Kernel,
    layout: Layout,
    x: Array,
    t: Array,
    q: Array,
    changes: Sequence[Change],
    command_t: Array,
    command: Array,
    step: float,
    *,
    forces: bool,
) -> Array:
    """Return the run over the stamps t from the state x, with *changes* after the first stamp.

    x becomes the state at the end, *q* are the parameters (rows, parameters) at the beginning.
    The other arguments and the columns are those of :func:`pam_ros.rig.run_kernel.simulate`, but
    the stamps of the commands do not include delays. A command that has acted before a change
    remains active, even if a longer delay begins there.
    """
    out = np.empty((t.size, layout.run_columns))
    acts = [command_t + delay for delay in delays_of(layout, q)]
    first, lead = 0, t[:0]
    for change in changes:
        if change.time >= t[-1]:
            break
        n = int(np.searchsorted(t, change.time, side='right'))
        until = np.concatenate([lead, t[first:n], [change.time]])
        run = _part(kernel, layout, x, q, until, acts, command, step, forces)
        out[first:n] = run[lead.size : -1]
        begin_effects(layout, q, x, change.begun)
        q, first, lead = change.q, n, until[-1:]
        acts = [
            np.where(then <= change.time, then, np.maximum(command_t + delay, change.time))
            for then, delay in zip(acts, delays_of(layout, q), strict=True)
        ]
    rest = np.concatenate([lead, t[first:]])
    out[first:] = _part(kernel, layout, x, q, rest, acts, command, step, forces)[lead.size :]
    return out


def run_pressures(
    kernel: Kernel,
    layout: Layout,
    x: Array,
    t: Array,
    q: Array,
    command_t: Array,
    command: Array,
    step: float,
) -> Array:
    """Return the run of the chambers alone over the stamps t, from the state x.

    The arguments are those of :func:`run_over`, without changes. The joint stays where it is.
    """
    out = np.empty((t.size, layout.run_columns))
    acts = [command_t + delay for delay in delays_of(layout, q)]
    kernel.simulate_pressures(
        x, layout.scratch(), q, t, *acting_commands(acts, command), step, out
    )
    return out


def _part(
    kernel: Kernel,
    layout: Layout,
    x: Array,
    q: Array,
    t: Array,
    acts: list[Array],
    command: Array,
    step: float,
    forces: bool,
) -> Array:
    out = np.empty((t.size, layout.run_columns))
    kernel.simulate(x, layout.scratch(), q, t, *acting_commands(acts, command), step, out, forces)
    return out


def acting_commands(acts: Sequence[Array], command: Array) -> tuple[Array, Array]:
    """Return the stamps at which a command changes, and the commands (m, muscles) from each on.

    *acts* are the times (m,) at which the rows of *command* (m, muscles) act in each muscle.
    If they differ between muscles, the result has a stamp for each change of any muscle's command.
    """
    if all(np.array_equal(own, acts[0]) for own in acts[1:]):
        return acts[0], command
    stamps = np.unique(np.concatenate(acts))
    columns = [
        command[np.maximum(np.searchsorted(own, stamps, side='right') - 1, 0), i]
        for i, own in enumerate(acts)
    ]
    return stamps, np.ascontiguousarray(np.stack(columns, axis=1))
