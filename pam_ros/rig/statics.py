# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints at rest, in closed form: efforts, equilibrium, stiffness, and pressures for both.

Force and stiffness are affine in pressure, so that at a coordinate s

    effort tau = sum_i (a_i + b_i p_i),    stiffness K = sum_i (c_i + d_i p_i)

with a = arm F(0, kappa), b = arm dF/dp, c = arm^2 k(0, kappa), d = arm^2 dk/dp. Both wanted
together are two linear equations for the pressures of two muscles.

All of it is the declared model: the force law, the geometry, and gravity with the moved mass;
no other effects. Coordinates are m or rad, efforts N or N m, stiffness N/m or N m/rad, as the
joint has them; pressures p are gauge Pa, one a muscle or one for all.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from pam_ros.compiled import broadcast
from pam_ros.errors import RangeError
from pam_ros.muscle import law
from pam_ros.rig import pair

if TYPE_CHECKING:
    from pam_ros.rig.joint_model import JointModel

BAR = 1e5  # Pa
BEYOND = 0.1, 0.25  # contraction below and above the rated one to which equilibria are sought
_on_arrays = cache(broadcast)


def effort(model: JointModel, p: ArrayLike, s: ArrayLike) -> Any:
    """Return what the muscles pull the joint with; *s* may be an array."""
    lines = [_effort(model, i, s) for i in range(len(model.muscles))]
    return sum(a + b * each for (a, b), each in zip(lines, model.each(p), strict=True))


def pull(model: JointModel, p: ArrayLike, s: ArrayLike) -> Any:
    """Return :func:`effort` without what muscles push where the law lets them."""
    total: Any = 0.0
    for i, (muscle, each) in enumerate(zip(model.muscles, model.each(p), strict=True)):
        force = law.force_v(each, contraction(model, i, s), *muscle.si)
        total = total + arm(model, i, s) * np.maximum(force, 0.0)
    return total


def stiffness(model: JointModel, p: ArrayLike, s: ArrayLike) -> Any:
    """Return the stiffness K that the muscles give the joint; *s* may be an array.

    Two muscles set it by co-contraction. What returns the joint to its equilibrium is this
    and the :func:`weight_stiffness`.
    """
    lines = [_stiffness(model, i, s) for i in range(len(model.muscles))]
    return sum(c + d * each for (c, d), each in zip(lines, model.each(p), strict=True))


def weight(model: JointModel, s: ArrayLike) -> Any:
    """Return the effort that holds the load against gravity; *s* may be an array."""
    fall = _on_arrays(model.joint.fall)
    return model.inertia * fall(_array(s), model.moved_mass, model.inertia, model.geometry)


def weight_stiffness(model: JointModel, s: ArrayLike) -> Any:
    """Return the stiffness that gravity adds, negative for a load that stands; also arrays."""
    slope = _on_arrays(model.joint.fall_slope)
    return model.inertia * slope(_array(s), model.moved_mass, model.inertia, model.geometry)


def contraction(model: JointModel, i: int, s: ArrayLike) -> Any:
    """Return the contraction of muscle i as a fraction; *s* may be an array."""
    position = _on_arrays(model.joint.position)
    return position(_array(s), i, model.geometry) / model.muscles[i].l0


def arm(model: JointModel, i: int, s: ArrayLike) -> Any:
    """Return how fast muscle i shortens with the coordinate; *s* may be an array."""
    return _on_arrays(model.joint.arm)(_array(s), i, model.geometry)


def equilibrium(model: JointModel, p: ArrayLike) -> float:
    """Return the coordinate at which the muscles hold the load, stably.

    Of several, as a load that stands on soft muscles has, the one nearest to 0. Raises
    RangeError when there is none at lengths that muscles have.
    """
    s = np.linspace(*span(model, *BEYOND), 200)
    net = effort(model, p, s) - weight(model, s)
    down = np.flatnonzero((net[:-1] > 0.0) & (net[1:] <= 0.0))
    if not down.size:
        pressures = ' and '.join(f'{each / 1e3:g}' for each in model.each(p))
        raise RangeError(
            f'no equilibrium: with {pressures} kPa the effort left over is {net[0]:.4g} '
            f'{model.joint.effort_unit} at {s[0]:.4g} {model.joint.unit} and {net[-1]:.4g} at '
            f'{s[-1]:.4g}'
        )
    i = down[np.argmin(np.abs(s[down]))]
    low, high = float(s[i]), float(s[i + 1])
    at = 0.5 * (low + high)
    for _ in range(100):  # Newton's method in a bracket
        excess = float(effort(model, p, at) - weight(model, at))
        low, high = (at, high) if excess > 0.0 else (low, at)
        slope = float(stiffness(model, p, at) + weight_stiffness(model, at))
        last, at = at, at + excess / slope if slope > 0.0 else np.inf
        if not low <= at <= high:
            at = 0.5 * (low + high)
        if abs(at - last) < 1e-15:
            break
    return at


def pressures(
    model: JointModel, s: float, stiffness: float, effort: float | None = None
) -> tuple[float, float]:
    """Return the pressures at which two muscles give *effort* and *stiffness* at s.

    The default effort holds the load there. Raises RangeError where the stiffness is outside
    :func:`stiffness_range`.
    """
    low, high = stiffness_range(model, s, effort)
    if not low * (1.0 - 1e-9) <= stiffness <= high * (1.0 + 1e-9):
        raise RangeError(
            f'a stiffness of {stiffness:.6g} {model.joint.effort_unit}/{model.joint.unit} at '
            f'{s:.4g} {model.joint.unit} is out of reach: {low:.6g} to {high:.6g} can be had there'
        )
    tau = float(weight(model, s)) if effort is None else effort
    return pair.pressures(_line(model, 0, s), _line(model, 1, s), tau, stiffness)


def stiffness_range(
    model: JointModel, s: float, effort: float | None = None
) -> tuple[float, float]:
    """Return the least and the greatest stiffness with which two muscles give *effort* at s.

    The default effort holds the load there. Within the range both muscles pull, or just do not
    push, and their pressures are within p_min and p_max. Raises RangeError where there is no
    such pair of pressures, and for two muscles that pull the same way with the same gains,
    whose effort settles their stiffness.
    """
    one, two = _line(model, 0, s), _line(model, 1, s)
    tau = float(weight(model, s)) if effort is None else effort
    unit = f'{tau:.4g} {model.joint.effort_unit} at {s:.4g} {model.joint.unit}'
    if pair.is_settled(one, two):
        raise RangeError(f'the muscles have one stiffness for {unit}: there is none to choose')
    within = _limits(model, 0, one), _limits(model, 1, two)
    low, high = pair.piece(one, two, tau, within)
    if low > high:
        raise RangeError(
            f'an effort of {unit} is out of reach: there are no pressures within p_min and '
            'p_max that give it and leave no muscle pushing'
        )
    k1, k2 = sorted(pair.stiffness_at(one, two, tau, p) for p in (low, high))
    return k1, k2


def span(model: JointModel, below: float = 0.0, above: float = 0.0) -> tuple[float, float]:
    """Return the least and the greatest coordinate at which all muscles are within their range.

    That is kappa_min - below to kappa_max + above, never above 0.95. Where the first is above
    the second there is no such coordinate.
    """
    low, high = -np.inf, np.inf
    for i, m in enumerate(model.muscles):
        kappa = m.kappa_min - below, min(m.kappa_max + above, 0.95)
        ends = [model.joint.coordinate(k * m.l0, i, model.geometry) for k in kappa]
        low, high = max(low, min(ends)), min(high, max(ends))
    return float(low), float(high)


def _effort(model: JointModel, i: int, s: ArrayLike) -> tuple[Any, Any]:
    """Return a and b of muscle i."""
    muscle, kappa = model.muscles[i], contraction(model, i, s)
    a1, _, a3, a4, a5, _ = muscle.si
    r = arm(model, i, s)
    return r * law.force_v(0.0, kappa, *muscle.si), r * law.gain_v(kappa, a1, a3, a4, a5)


def _stiffness(model: JointModel, i: int, s: ArrayLike) -> tuple[Any, Any]:
    """Return c and d of muscle i."""
    muscle, kappa = model.muscles[i], contraction(model, i, s)
    a1, a2, a3, a4, _, _ = muscle.si
    square = arm(model, i, s) ** 2
    at_0, at_1 = (
        square * law.stiffness_v(p, kappa, a1, a2, a3, a4, muscle.l0) for p in (0.0, BAR)
    )
    return at_0, (at_1 - at_0) / BAR


def _line(model: JointModel, i: int, s: float) -> pair.Line:
    """Return a, b, c, d of muscle i at s."""
    return pair.Line(*(float(x) for x in (*_effort(model, i, s), *_stiffness(model, i, s))))


def _limits(model: JointModel, i: int, line: pair.Line) -> pair.Limits:
    """Return the pressures of muscle i from where it begins to pull to its greatest."""
    m = model.muscles[i]
    return max(m.p_min, line.slack), m.p_max


def _array(s: ArrayLike) -> Any:
    return np.asarray(s, dtype=float)
