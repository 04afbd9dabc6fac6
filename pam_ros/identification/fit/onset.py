# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs in which effects begin to act in the middle, at a moment that may be unknown.

Until then they are absent. At the moment their memories begin as they do in a rig that has none
of them yet, and the rig goes on from where it is: no pressure and no position jumps. The run is
cut exactly there, wherever the samples are, so that it is smooth in the moment.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.identification.data.segment import FreeSegment
from pam_ros.rig.bind import Kernel
from pam_ros.rig.layout import Layout
from pam_ros.rig.run import acting_commands, delays_of
from pam_ros.rig.start import begin_effects

Array = NDArray[np.float64]


@dataclass(frozen=True)
class OnsetTime:
    """The moment in s, on the clock of the recording, at which all unknown effects begin."""

    name: str = 'onset'


@dataclass(frozen=True, eq=False)
class Change:
    """What changes at ``time`` s: parameters (rows, parameters) *before* become those *after*.

    ``effects`` are those that begin to act.
    """

    time: float
    before: Array
    after: Array
    effects: Sequence[Effect]


def run_over(
    kernel: Kernel,
    layout: Layout,
    x: Array,
    segment: FreeSegment,
    step: float,
    change: Change,
) -> Array:
    """Return the run over the stamps of *segment* with a *change* after its first, from x on.

    The state x becomes that at the end. The columns are those of
    :func:`pam_ros.rig.run_kernel.simulate`, without forces.
    """
    t, time = segment.t, change.time
    n = int(np.searchsorted(t, time, side='right'))
    if n == t.size:
        return _run(kernel, layout, x, segment, t, change.before, step)
    early = _run(kernel, layout, x, segment, np.append(t[:n], time), change.before, step)
    begin_effects(layout, change.before, x, change.effects)
    late = _run(kernel, layout, x, segment, np.insert(t[n:], 0, time), change.after, step)
    return np.concatenate([early[:n], late[1:]])


def _run(
    kernel: Kernel,
    layout: Layout,
    x: Array,
    segment: FreeSegment,
    t: Array,
    q: Array,
    step: float,
) -> Array:
    out = np.empty((t.size, layout.run_columns))
    act_t, acting = acting_commands(segment.drive_t, segment.drive, delays_of(layout, q))
    kernel.simulate(x, layout.scratch(), q, t, act_t, acting, step, out, False)
    return out
