# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Where a joint with all its effects comes to rest: slack muscles, stops, offsets."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.bind import bind_joints
from pam_ros.rig.model import start_row

if TYPE_CHECKING:
    from pam_ros.rig.joint_model import JointModel

STEPS = 100  # over the span in which a rest is sought


def rest(model: JointModel, p: ArrayLike) -> float:
    """Return the coordinate at which the joint rests when *p* Pa has long been commanded.

    The nearest to the equilibrium of the declared model in the direction in which its effects
    drive it from there; without effects, that equilibrium.
    """
    start = statics.equilibrium(model, p)
    if not model.active:
        return start
    acceleration = held(model, p)
    last, a = start, acceleration(start)
    low, high = statics.span(model, *statics.BEYOND)
    for s in np.linspace(start, high if a > 0.0 else low, STEPS)[1:]:
        if acceleration(float(s)) * a <= 0.0:
            return _root(acceleration, last, float(s))
        last = float(s)
    return start


def held(model: JointModel, p: ArrayLike) -> Callable[[float], float]:
    """Return s'' as a function of s, for the joint that has long been held there at *p* Pa."""
    q, n, pressures = model.rows(), len(model.muscles), model.each(p)
    g = np.array([model.geometry])
    kind, first, load = (np.array([each], dtype=np.int64) for each in (model.kind, 0, n))
    outputs = bind_joints(model.layout, model.active).outputs_of_joints
    x = np.zeros((n + 1, model.layout.width))
    scratch, out, joint_out = np.zeros_like(x), np.zeros((n + 1, 4)), np.zeros((1, 3))

    def acceleration(s: float) -> float:
        for i, each in enumerate(pressures):
            y = model.joint.position(s, i, model.geometry)
            x[i] = start_row(model.layout, q[i], each, y, 0.0)
        x[n] = start_row(model.layout, q[n], float(np.mean(x[:n, at.P])), s, 0.0)
        scratch[:] = x
        outputs(x, scratch, q, g, kind, first, load, 0.0, out, joint_out)
        return float(joint_out[0, 2])

    return acceleration


def _root(f: Callable[[float], float], a: float, b: float) -> float:
    """Return where f changes its sign between a and b, by halving."""
    sign = f(a)
    while abs(b - a) > 1e-13:
        middle = 0.5 * (a + b)
        if f(middle) * sign > 0.0:
            a = middle
        else:
            b = middle
    return 0.5 * (a + b)
