# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints at rest, in closed form: efforts, equilibrium, stiffness.

Force and stiffness are affine in pressure, so that at a coordinate s

    effort tau = sum_i (a_i + b_i p_i),    stiffness K = sum_i (c_i + d_i p_i)

with a = arm F(0, kappa), b = arm dF/dp, c = arm^2 k(0, kappa) - arm' F(0, kappa), and
d = arm^2 dk/dp - arm' dF/dp, where arm' is the derivative of the arm with respect to s.

All of it is the nominal model: the force law, the geometry, and gravity with the moved mass; other
effects are not included. Coordinates are m or rad, efforts N or N m, stiffness N/m or N m/rad, as
the joint has them; pressures p are gauge Pa, one for each muscle or one for all.
"""

from functools import cache
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from pam_ros.compiled import broadcast
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle import law
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.loads import Load
from pam_ros.rig.transmissions import Straight, Transmission

BAR = 1e5  # Pa
BEYOND = 0.1, 0.25  # contraction below and above the rated range that is searched for equilibria
HIGHEST_CONTRACTION = 0.95  # largest contraction that is considered for any muscle
START = (-0.2, HIGHEST_CONTRACTION)  # range of contractions in which a simulation may start
_on_arrays = cache(broadcast)


class Mechanism(Protocol):
    """The parts of a joint that statics need: its muscles, its transmission and its load."""

    @property
    def muscles(self) -> tuple[Muscle, ...]:
        """The muscles in order."""

    @property
    def at_zero(self) -> tuple[float, ...]:
        """The position of each muscle's end at the coordinate 0, m."""

    @property
    def transmission(self) -> Transmission:
        """The transmission from the muscles to the coordinate."""

    @property
    def load(self) -> Load:
        """The load of the muscles."""

    @property
    def moved_mass(self) -> float:
        """Mass in kg with the payload of its effects."""

    @property
    def inertia(self) -> float:
        """Inertia of the coordinate, kg or kg m^2."""


def each(joint: Mechanism, p: ArrayLike) -> list[float]:
    """Return pressures in Pa, one for each muscle; *p* has one for each, or one for all."""
    return [float(one) for one in np.broadcast_to(np.asarray(p, float), len(joint.muscles))]


def effort(joint: Mechanism, p: ArrayLike, s: ArrayLike) -> Any:
    """Return the effort of the muscles on the joint; *s* may be an array."""
    total: Any = 0
    for i, pressure in enumerate(each(joint, p)):
        a, b, _, _ = line(joint, i, s)
        total = total + (a + b * pressure)
    return total


def pull(joint: Mechanism, p: ArrayLike, s: ArrayLike) -> Any:
    """Return :func:`effort` without the pushing forces that the force law may give."""
    total: Any = 0.0
    for i, (muscle, pressure) in enumerate(zip(joint.muscles, each(joint, p), strict=True)):
        force = law.force_v(pressure, contraction(joint, i, s), *muscle.si)
        total = total + arm(joint, i, s) * np.maximum(force, 0.0)
    return total


def stiffness(joint: Mechanism, p: ArrayLike, s: ArrayLike) -> Any:
    """Return the stiffness K of the joint by its muscles; *s* may be an array.

    With two muscles it can be set by co-contraction. The sum of this and :func:`weight_stiffness`
    returns the joint to its equilibrium.
    """
    total: Any = 0
    for i, pressure in enumerate(each(joint, p)):
        _, _, c, d = line(joint, i, s)
        total = total + (c + d * pressure)
    return total


def weight(joint: Mechanism, s: ArrayLike) -> Any:
    """Return the effort that holds the load against gravity; *s* may be an array."""
    fall = _on_arrays(joint.load.equations.fall)
    return joint.inertia * fall(_array(s), joint.moved_mass, joint.inertia, joint.load.numbers, 0)


def weight_stiffness(joint: Mechanism, s: ArrayLike) -> Any:
    """Return the stiffness that gravity adds, negative for an inverted pendulum; also arrays."""
    slope = _on_arrays(joint.load.equations.fall_slope)
    return joint.inertia * slope(_array(s), joint.moved_mass, joint.inertia, joint.load.numbers, 0)


def position(joint: Mechanism, i: int, s: ArrayLike) -> Any:
    """Return the position of muscle i's end in m, contraction positive; *s* may be an array."""
    travel = _on_arrays(joint.transmission.equations.travel)
    return joint.at_zero[i] + travel(_array(s), i, joint.transmission.numbers, 0)


def contraction(joint: Mechanism, i: int, s: ArrayLike) -> Any:
    """Return the contraction of muscle i as a fraction; *s* may be an array."""
    return position(joint, i, s) / joint.muscles[i].l0


def arm(joint: Mechanism, i: int, s: ArrayLike) -> Any:
    """Return the arm of muscle i: its shortening per unit of s; *s* may be an array."""
    return _on_arrays(joint.transmission.equations.arm)(
        _array(s), i, joint.transmission.numbers, 0
    )


def middle_arms(joint: Mechanism) -> Any:
    """Return the arm of each muscle in the middle of the travel (muscles,)."""
    middle = float(np.mean(span(joint)))
    return np.array([float(arm(joint, i, middle)) for i in range(len(joint.muscles))])


def arm_slope(joint: Mechanism, i: int, s: ArrayLike) -> Any:
    """Return the derivative of the arm with respect to s; *s* may be an array."""
    return _on_arrays(joint.transmission.equations.arm_slope)(
        _array(s), i, joint.transmission.numbers, 0
    )


def coordinate(joint: Mechanism, i: int, kappa: float) -> float:
    """Return the coordinate at which muscle i has the contraction *kappa*."""
    y = kappa * joint.muscles[i].l0 - joint.at_zero[i]
    return joint.transmission.equations.coordinate(y, i, joint.transmission.numbers, 0)


def position_range(joint: Mechanism) -> tuple[float, float]:
    """Return the least and the greatest position, m or rad, that the muscles can have.

    Between them the contractions of all muscles are within ``START``. Without a spring every
    position is allowed.
    """
    if is_direct(joint) and joint.muscles[0].is_load_only:
        return -np.inf, np.inf
    ends = [
        sorted(coordinate(joint, i, kappa) for kappa in START) for i in range(len(joint.muscles))
    ]
    return max(low for low, _ in ends), min(high for _, high in ends)


def refuse_position(
    name: str, position: float, joint: Mechanism, kind: str = 'this joint'
) -> None:
    """Raise ParameterError for a *position*, m or rad, at which no simulation may start.

    The sentence calls a joint *kind*.
    """
    low, high = position_range(joint)
    if not low <= position <= high:
        unit = joint.transmission.equations.unit
        whose = f'a muscle of {joint.muscles[0].l0:g} m' if is_direct(joint) else kind
        raise ParameterError(
            f'{name} = {position:g} {unit} is not possible with {whose}: give {low:g} to '
            f'{high:g} {unit}'
        )


def line(joint: Mechanism, i: int, s: ArrayLike) -> tuple[Any, Any, Any, Any]:
    """Return a, b, c and d of muscle i; *s* may be an array."""
    muscle, kappa = joint.muscles[i], contraction(joint, i, s)
    a1, a2, a3, a4, a5, _ = muscle.si
    r, turn = arm(joint, i, s), arm_slope(joint, i, s)
    force, gain = law.force_v(0.0, kappa, *muscle.si), law.gain_v(kappa, a1, a3, a4, a5)
    at_0, at_1 = (law.stiffness_v(p, kappa, a1, a2, a3, a4, muscle.l0) for p in (0.0, BAR))
    slope = (r * r * at_1 - r * r * at_0) / BAR
    return (r * force, r * gain, r * r * at_0 - turn * force, slope - turn * gain)


def equilibrium(joint: Mechanism, p: ArrayLike) -> float:
    """Return the coordinate at which the muscles hold the load in a stable equilibrium.

    If there are several, as for an inverted pendulum with soft muscles, it is the one nearest to
    0. Raises RangeError if there is none at the contractions that are searched (BEYOND, and up to
    HIGHEST_CONTRACTION).
    """
    if is_direct(joint):
        # The same for one muscle on a mass, from the force law itself and about 100 times as fast.
        muscle = joint.muscles[0]
        return muscle.equilibrium(each(joint, p)[0], float(weight(joint, 0.0))) * muscle.l0
    s = np.linspace(*span(joint, *BEYOND), 200)
    net = effort(joint, p, s) - weight(joint, s)
    down = np.flatnonzero((net[:-1] > 0.0) & (net[1:] <= 0.0))
    if not down.size:
        pressures = ' and '.join(f'{pressure / 1e3:g}' for pressure in each(joint, p))
        geometry = joint.transmission.equations
        raise RangeError(
            f'no equilibrium: with {pressures} kPa the resulting effort is {net[0]:.4g} '
            f'{geometry.effort_unit} at {s[0]:.4g} {geometry.unit} and {net[-1]:.4g} at '
            f'{s[-1]:.4g}'
        )
    i = down[np.argmin(np.abs(s[down]))]
    low, high = float(s[i]), float(s[i + 1])
    at = 0.5 * (low + high)
    for _ in range(100):  # Newton's method in a bracket
        excess = float(effort(joint, p, at) - weight(joint, at))
        low, high = (at, high) if excess > 0.0 else (low, at)
        slope = float(stiffness(joint, p, at) + weight_stiffness(joint, at))
        last, at = at, at + excess / slope if slope > 0.0 else np.inf
        if not low <= at <= high:
            at = 0.5 * (low + high)
        if abs(at - last) < 1e-15:
            break
    return at


def is_direct(joint: Mechanism) -> bool:
    """Return whether the coordinate is the shortening of one muscle from its length at rest."""
    return isinstance(joint.transmission, Straight) and joint.at_zero == (0.0,)


def span(joint: Mechanism, below: float = 0.0, above: float = 0.0) -> tuple[float, float]:
    """Return the least and the greatest coordinate at which all muscles are within their range.

    The range is kappa_min - below to kappa_max + above, never above HIGHEST_CONTRACTION. If the
    least is above the greatest, there is no such coordinate.
    """
    low, high = -np.inf, np.inf
    for i, m in enumerate(joint.muscles):
        ends = [
            coordinate(joint, i, kappa)
            for kappa in (m.kappa_min - below, min(m.kappa_max + above, HIGHEST_CONTRACTION))
        ]
        low, high = max(low, min(ends)), min(high, max(ends))
    return float(low), float(high)


def _array(s: ArrayLike) -> Any:
    return np.asarray(s, dtype=float)
