# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a joint is: one coordinate that several muscles drive, and its equation of motion.

A joint is one file that ends in one :class:`Joint`; ``joints/__init__.py`` lists it. The equations
are plain scalar functions, compiled into the stepping kernel when numba is there.

The coordinate s is a position in m (prismatic) or an angle in rad (revolute); muscle i is at

    y_i = position(s, i, g),    y_i' = arm(s, i, g) s',    arm = d position / d s,

contraction positive, and by virtual work the muscles' forces move the joint:

    J s'' = sum_i arm_i (F_i - c_i y_i') + outside - J fall(s)

Functions of a joint; g is its row of numbers, g[0] always the mass of the load in kg:

``position(s, i, g) -> m``
    Where muscle i is.
``arm(s, i, g) -> m/rad, or 1 for a prismatic joint``
    How fast muscle i shortens with s; never 0. Where it changes with s, it turns stiffness into
    the joint's as it is there: what its change adds, force times slope, is not counted.
``coordinate(y, i, g) -> s``
    The inverse of ``position``. Python calls it, not the kernel.
``inertia(m, g) -> kg, kg m^2``
    What resists s'' when m is moved: the mass in g[0] after the effects that change it.
``fall(s, m, j, g) -> m/s^2, rad/s^2``
    Acceleration against s that gravity alone gives, j being the inertia.
``fall_slope(s, m, j, g)``
    Its derivative over s: times the inertia, the stiffness that gravity adds.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from pam_ros.effects.base import Effect, EffectParameter
from pam_ros.muscle.muscle import Muscle

Row = Any  # float64 row; numba's and numpy's types differ, both index to float

# Units of an effect on a load that slides, and what they are on one that turns. A contraction,
# which places end stops, becomes the angle itself.
_TURNED = {
    'm': 'rad',
    'm/s': 'rad/s',
    'N': 'N m',
    'N/m': 'N m/rad',
    'N s/m': 'N m s/rad',
    'N/Pa': 'N m/Pa',
    's/m': 's/rad',
    'fraction': 'rad',
}


@dataclass(frozen=True, eq=False)
class Joint:
    """A kind of joint.

    ``declared`` is the dataclass of what a user gives; ``row(declared, muscles)`` makes g of it.
    """

    name: str
    text: str
    muscles: int
    revolute: bool
    declared: type
    row: Callable[[Any, tuple[Muscle, ...]], tuple[float, ...]]
    position: Callable[..., float]
    arm: Callable[..., float]
    coordinate: Callable[..., float]
    inertia: Callable[..., float]
    fall: Callable[..., float]
    fall_slope: Callable[..., float]

    @property
    def unit(self) -> str:
        """Unit of the coordinate."""
        return 'rad' if self.revolute else 'm'

    @property
    def effort_unit(self) -> str:
        """Unit of what moves it."""
        return 'N m' if self.revolute else 'N'

    def on_load(self, effect: Effect) -> Effect:
        """Return *effect* with the units and ranges that it has on this joint's load."""
        if not self.revolute:
            return effect
        return replace(effect, parameters=tuple(_turned(p) for p in effect.parameters))


def _turned(p: EffectParameter) -> EffectParameter:
    unit = _TURNED.get(p.unit, p.unit)
    if p.unit == 'fraction':
        return replace(p, unit=unit, low=-math.pi, high=math.pi)
    return replace(p, unit=unit)


def acts_on_load(effect: Effect) -> bool:
    """Say whether *effect* acts on the load, and not within a muscle."""
    return effect.outside is not None or effect.mass is not None


def acts_in_muscle(effect: Effect) -> bool:
    """Say whether *effect* acts within a muscle or its pressure path."""
    places = (effect.delay, effect.pressure, effect.contraction, effect.force, effect.damping)
    return any(place is not None for place in places)
