# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How far a joint can swing, and so how stiff its muscles become, and how short steps must be."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pam_ros.rig import statics
from pam_ros.rig.model import start_row

if TYPE_CHECKING:
    from pam_ros.rig.joint_model import JointModel

Array = NDArray[np.float64]
BELOW, ABOVE = 0.3, 0.7  # contraction beyond the rated one that is looked at
POINTS = 500
LONGEST_WITH_EFFECTS = 0.01  # s: stops that are softened for longer steps hold nothing
FAST = 10.0  # m/s or rad/s, at which dry friction counts for nothing beside a drag


def longest_step(model: JointModel) -> float:
    """Return the step in s at which the joint's fastest motion turns by 1 rad.

    That is where its muscles are stiffest: where the joint can be permissibly, and where it
    swings to, undamped, when it is let go there at the pressures that throw it furthest.
    """
    low, high = statics.span(model, BELOW, ABOVE)
    s = np.linspace(low, high, POINTS)
    far = np.zeros(POINTS, dtype=bool)
    k = np.zeros(POINTS)
    for p in itertools.product(*((m.p_min, m.p_max) for m in model.muscles)):
        far |= _swung(model, s, statics.effort(model, p, s))
        far |= _swung(model, s, statics.pull(model, p, s))
        k = np.maximum(k, statics.stiffness(model, p, s))
    square = float(np.max(k[far])) / model.inertia
    zeta = max(m.zeta for m in model.muscles)
    decay = zeta * math.sqrt(square) + 0.5 * _drag(model) / model.inertia
    fastest = max(math.sqrt(square), decay + math.sqrt(max(decay * decay - square, 0.0)))
    return min(1.0 / fastest, LONGEST_WITH_EFFECTS) if model.active else 1.0 / fastest


def _drag(model: JointModel) -> float:
    """Return the largest effort per velocity that effects add to the muscles' damping."""
    *muscles, load = model.rows()
    travel = np.linspace(*model.travel, POINTS)
    *in_muscles, on_load = model.present
    total = 0.0
    for i, (muscle, q, effects) in enumerate(zip(model.muscles, muscles, in_muscles, strict=True)):
        most = 0.0
        for p, v in itertools.product((muscle.p_min, muscle.p_max), (-FAST, FAST)):
            c = 0.0
            for effect in effects:
                if effect.damping is not None:
                    j = model.layout.parameter_at[effect.name]
                    c = float(effect.damping(c, p, 0.0, v, q, j))
            most = max(most, c)
        total += most * float(np.max(statics.arm(model, i, travel) ** 2))
    x = start_row(model.layout, load, 0.0, 0.0, 0.0)
    most = 0.0
    for v in (-FAST, FAST):
        f = 0.0
        for effect in on_load:
            if effect.outside is not None:
                i, j = model.layout.state_at[effect.name], model.layout.parameter_at[effect.name]
                f = float(effect.outside(f, 0.0, 0.0, v, 0.0, 0.0, x, i, x.copy(), load, j))
        most = max(most, -f / v)
    return total + most


def _swung(model: JointModel, s: Array, effort: Array) -> NDArray[np.bool_]:
    """Say which of the coordinates s are reached from a rest within the joint's travel."""
    net = effort - statics.weight(model, s)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (net[1:] + net[:-1]) * np.diff(s))])
    low, high = model.travel
    inside = np.flatnonzero((s >= low) & (s <= high))
    first, last = int(inside[0]), int(inside[-1])
    # What is let go has no energy beyond that of its place, minus the work done from there.
    least = float(np.min(work[inside]))
    reached = np.zeros(len(s), dtype=bool)
    reached[first : last + 1] = True
    above = np.flatnonzero(work[last:] < least)
    reached[last : last + int(above[0]) + 1 if above.size else None] = True
    below = np.flatnonzero(work[: first + 1] < least)
    reached[int(below[-1]) if below.size else 0 : first] = True
    return reached
