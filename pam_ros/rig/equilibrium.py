# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The rest position of a joint whose effects may include slack muscles, stops and offsets."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.arguments import instance, one_each
from pam_ros.muscle.pressure_unit import warn_of_unit
from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.bind import bind
from pam_ros.rig.joint import Joint
from pam_ros.rig.start import start_state

Array = NDArray[np.float64]
STEPS = 100  # over the span in which a rest position is searched
PRECISION = 1e-13  # m or rad


def equilibrium(joint: Joint, p: ArrayLike) -> float:
    """Return the coordinate at which the joint rests when *p* Pa has long been commanded.

    p is gauge, (muscles,) or one number for all. For one muscle on a mass the coordinate is the
    equilibrium of the paper's static model with the moved mass, and 0 if a known force replaces
    the muscle. For any other joint it is the rest position nearest to the static equilibrium, in
    the direction in which the effects drive the joint from there.

    Raises RangeError if there is no equilibrium, and ParameterError for a p of another shape or
    one that is not finite. Warns of a p that seems to be in kPa or bar, or is far above p_max.
    """
    p = one_each('p', p, len(instance('joint', joint, Joint, 'a Joint').actuators), 'muscle')
    warn_of_unit('p', p, joint.muscles)
    return rest_position(joint, p)


def rest_position(joint: Joint, p: ArrayLike) -> float:
    """Return :func:`equilibrium` for pressures of the package itself, which need no warning."""
    p = statics.each(joint, p)
    if joint.is_driven:
        return 0.0
    start = statics.equilibrium(joint, p)
    if not joint.active or statics.is_direct(joint):
        return start
    return rest_from(joint, p, start)


def rest_from(joint: Joint, p: ArrayLike, start: float) -> float:
    """Return the rest position nearest to *start*, in the direction in which the joint is driven.

    The muscles have *p* Pa. If there is none within the travel, it is *start*.
    """
    acceleration = held(joint, p)
    last, a = start, acceleration(start)
    low, high = statics.span(joint, *statics.BEYOND)
    for s in np.linspace(start, high if a > 0.0 else low, STEPS)[1:]:
        if acceleration(float(s)) * a <= 0.0:
            return _root(acceleration, last, float(s))
        last = float(s)
    return start


def held(joint: Joint, p: ArrayLike) -> Callable[[float], float]:
    """Return s'' as a function of s, for the joint after a long rest at s with *p* Pa."""
    acceleration, pressures = acceleration_of(joint), np.array(statics.each(joint, p))
    return lambda s: acceleration(s, 0.0, pressures)


def acceleration_of(joint: Joint) -> Callable[[float, float, Array], float]:
    """Return s'' as a function of s, v and the commands in Pa (muscles,), after a long rest."""
    layout, q = joint.layout, joint.parameters()
    outputs = bind(layout, joint.active).outputs
    scratch = layout.scratch()[None]
    out = np.zeros((1, layout.muscles, at.OUTPUTS))
    joint_out = np.zeros((1, at.JOINT_OUTPUTS))

    def acceleration(s: float, v: float, pressures: Array) -> float:
        x = start_state(layout, q, pressures, s, v)
        scratch[0, :, : layout.width] = x
        outputs(x[None], scratch, q[None], 0.0, out, joint_out)
        return float(joint_out[0, 2])

    return acceleration


def _root(f: Callable[[float], float], a: float, b: float) -> float:
    """Return the point between a and b at which f changes its sign, by bisection."""
    sign = f(a)
    while abs(b - a) > PRECISION:
        middle = 0.5 * (a + b)
        if f(middle) * sign > 0.0:
            a = middle
        else:
            b = middle
    return 0.5 * (a + b)
