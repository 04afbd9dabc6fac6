# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Coulomb and Stribeck friction of the guide, with true sticking of the load.

A controller feeds forward the friction of a load that slides. The additional friction at rest has
gone as soon as the load moves; fed forward along the reference, which moves on while the load
sticks, it comes too late and makes the load slip.
"""

from dataclasses import dataclass, replace
from math import exp, hypot, sqrt
from typing import ClassVar

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectEquations, HiddenState, Row, Starts
from pam_ros.effects.parameter import effect_parameter, start_from, strength
from pam_ros.effects.rows import INERTIA

LEVEL, BREAKAWAY, STRIBECK_SPEED, PER_PRESSURE, ASYMMETRY, PRESLIDING = range(6)
CONTACT, POSITION, STEP = range(3)  # hidden states


def outside(
    f: float,
    p: float,
    y: float,
    v: float,
    t: float,
    h: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return f less the friction, which opposes motion and holds a load at rest.

    The contact has a damper. If a step of length h cannot resolve the contact's spring, the spring
    is made longer, so that its natural frequency with the load stays below 1/h.
    """
    if q[j + LEVEL] == 0.0 and q[j + BREAKAWAY] == 0.0 and q[j + PER_PRESSURE] == 0.0:
        return f
    xn[i + STEP] = h
    return f - resistance(p, y, v, x[i + STEP], 1.0, x, i, xn, q, j)


def drag(
    f: float,
    p: float,
    y: float,
    v: float,
    t: float,
    h: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return f less the friction along a prescribed motion, where no load oscillates."""
    if q[j + LEVEL] == 0.0 and q[j + BREAKAWAY] == 0.0 and q[j + PER_PRESSURE] == 0.0:
        return f
    return f - resistance(p, y, v, 0.0, 0.0, x, i, xn, q, j)


@scalar
def resistance(
    p: float,
    y: float,
    v: float,
    step: float,
    damping: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return the friction in N against an upward motion, and store the state of the contact.

    Level: g = C + (S - C) exp(-(v / w)^2) + B p, with C the level, S the breakaway, but not below
    C, w the stribeck_speed and B per_pressure; (1 + A) g upwards and (1 - A) g downwards, A the
    asymmetry. Below this level the contact is a spring that slips at the length presliding; for a
    *step* in s that cannot resolve it, this length is larger. A damper of *damping* sqrt(k m) acts
    with it; k is the stiffness of the spring and m the inertia. The sum of both never exceeds
    the level (Prandtl's element: no drift under loads that change).
    """
    level = q[j + LEVEL] + q[j + PER_PRESSURE] * max(p, 0.0)
    if q[j + BREAKAWAY] > q[j + LEVEL]:
        relative = v / q[j + STRIBECK_SPEED]
        level += (q[j + BREAKAWAY] - q[j + LEVEL]) * exp(-relative * relative)
    up, down = (1.0 + q[j + ASYMMETRY]) * level, (1.0 - q[j + ASYMMETRY]) * level
    k = level / hypot(q[j + PRESLIDING], level * step * step / q[INERTIA])
    spring = min(max(x[i + CONTACT] + k * (y - x[i + POSITION]), -down), up)
    xn[i + CONTACT] = spring
    xn[i + POSITION] = y
    return min(max(spring + damping * sqrt(k * q[INERTIA]) * v, -down), up)


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the states of a contact without force."""
    return (0.0, y, 1e-3)


@dataclass(frozen=True)
class CoulombFriction(Effect):
    """Dry friction of the guide with stiction and Stribeck effect."""

    level: float = strength('friction while it slides', 'N', high=1e4, scale=5.0)
    breakaway: float = strength(
        'friction at rest; used if it is above the level', 'N', high=1e4, scale=5.0
    )
    stribeck_speed: float = effect_parameter(
        0.01,
        'speed at which the additional friction at rest has fallen to 1/e',
        'm/s',
        low=1e-4,
        high=10.0,
        scale=0.01,
    )
    per_pressure: float = strength(
        'growth of the friction with pressure', 'N/Pa', high=1e-2, scale=1e-5
    )
    asymmetry: float = effect_parameter(
        0.0,
        'upward minus downward friction, relative to their sum',
        low=-1.0,
        high=1.0,
        scale=0.1,
    )
    presliding: float = effect_parameter(
        1e-5,
        'displacement of the contact until it slides',
        'm',
        low=1e-6,
        high=2e-4,
        scale=1e-5,
        needs_fine_steps=True,
    )

    name: ClassVar = 'coulomb_friction'
    text: ClassVar = 'dry friction of the guide with stiction and Stribeck effect'
    source: ClassVar = (
        'Coulomb, Stribeck; Prandtl element for presliding; Dupont et al. 2002 on drift'
    )
    equation: ClassVar = (
        'F = F_in - R,  with -(1 - asymmetry) L <= R <= (1 + asymmetry) L\n'
        'L = level + per_pressure p + max(breakaway - level, 0) exp(-(v / stribeck_speed)^2)\n'
        'Between these limits R is the force of a spring, L / presliding, with a damper.\n'
        'At a limit the contact slides.'
    )
    signature: ClassVar = (
        'residual force that jumps with the sign of velocity; standstill at reversals'
    )
    experiment: ClassVar = 'slow triangles with minor loops: the force reverses within micrometres'
    excitation: ClassVar = {'segments': ('slow_triangle', 'fast_triangle'), 'duration': 300.0}
    compensation: ClassVar = Compensation.FEED_FORWARD
    states: ClassVar = (
        HiddenState('contact force', 'N', 5.0),
        HiddenState('position', 'm'),
        HiddenState('step', 's'),
    )
    rivals: ClassVar = ('hysteresis', 'viscous_friction')
    equations: ClassVar = EffectEquations(outside=outside, drag=drag, start=start)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, level=3.0),
            start_from(cls, level=15.0, asymmetry=0.0),
            start_from(cls, level=5.0, breakaway=8.0, stribeck_speed=0.01),
            start_from(cls, level=10.0, breakaway=13.0, stribeck_speed=0.02),
        )

    def fed_forward(self) -> Effect:
        """Return it without the additional friction at rest."""
        return replace(self, breakaway=0.0)

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(level=4.0, breakaway=5.0)
