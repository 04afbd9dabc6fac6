# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The loads of muscles: a mass that moves in a straight line, or an arm about a pivot.

As with transmissions, a load is a dataclass of the parameters that a user sets, and equations that
are compiled into the stepping kernel.
"""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any, ClassVar

from pam_ros.constructors import RefusesUnknownNames
from pam_ros.errors import ParameterError
from pam_ros.parameters import check_all, parameter_field

Row = Any  # float64 row; numba's and numpy's types differ, both index to float
GRAVITY = 9.80665  # m/s^2, standard


@dataclass(frozen=True, eq=False)
class LoadEquations:
    """The dynamics of a load; q[j], q[j + 1], ... are its *numbers* numbers.

    ``inertia(m, q, j) -> kg, kg m^2``
        Inertia of the coordinate for the moved mass m in kg, which is the nominal mass after the
        effects that change it. It does not depend on the coordinate.
    ``fall(s, m, inertia, q, j) -> m/s^2, rad/s^2``
        Acceleration by gravity alone, positive against the coordinate.
    ``fall_slope(s, m, inertia, q, j)``
        Its derivative with respect to s: times the inertia, it is the stiffness that gravity adds.
    """

    revolute: bool
    numbers: int
    inertia: Callable[..., float]
    fall: Callable[..., float]
    fall_slope: Callable[..., float]


class Load(metaclass=RefusesUnknownNames):
    """The parameters of a load: its mass in kg, and the other numbers of its equations."""

    equations: ClassVar[LoadEquations]
    mass: float

    @property
    @abstractmethod
    def numbers(self) -> tuple[float, ...]:
        """The numbers of its equations in addition to the mass, SI."""


# A mass ----------------------------------------------------------------------------------------


def _mass(m: float, q: Row, j: int) -> float:
    """Return the moved mass."""
    return m


def _gravity(s: float, m: float, inertia: float, q: Row, j: int) -> float:
    """Return the gravitational acceleration, which stretches the muscles."""
    acceleration: float = q[j]
    return acceleration


def _even(s: float, m: float, inertia: float, q: Row, j: int) -> float:
    """Return 0: gravity does not depend on the position."""
    return 0.0


@dataclass(frozen=True)
class Mass(Load):
    """The mass that the muscles move, and how it is mounted.

    ``vertical``: the mass hangs on the muscle, as the paper's pendulum. ``horizontal``: it slides
    without gravity (the paper's future work; friction of its guide is an effect).
    """

    mass: float = parameter_field(
        20.0, 'mass of the load', 'kg', low=0.0, high=1e4, above_low=True
    )
    mount: str = parameter_field(
        'vertical',
        'vertical: the load hangs on the muscle; horizontal: it slides without gravity',
        choices=('vertical', 'horizontal'),
    )

    equations: ClassVar = LoadEquations(False, 1, inertia=_mass, fall=_gravity, fall_slope=_even)

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)

    @property
    def gravity(self) -> float:
        """Gravitational acceleration in m/s^2 that stretches the muscles."""
        return GRAVITY if self.mount == 'vertical' else 0.0

    @property
    def numbers(self) -> tuple[float, ...]:
        """The gravitational acceleration."""
        return (self.gravity,)


# An arm ----------------------------------------------------------------------------------------

_INERTIA, _ARM, _HANGING_AT, _G = range(4)


def _arm_inertia(m: float, q: Row, j: int) -> float:
    """Return I + m l^2."""
    inertia: float = q[j + _INERTIA] + m * q[j + _ARM] * q[j + _ARM]
    return inertia


def _pendulum(s: float, m: float, inertia: float, q: Row, j: int) -> float:
    """Return m g l sin(theta - theta_h) / J: the acceleration of a pendulum."""
    a: float = m * q[j + _G] * q[j + _ARM] * sin(s - q[j + _HANGING_AT]) * (1.0 / inertia)
    return a


def _pendulum_slope(s: float, m: float, inertia: float, q: Row, j: int) -> float:
    """Return m g l cos(theta - theta_h) / J."""
    slope: float = m * q[j + _G] * q[j + _ARM] * cos(s - q[j + _HANGING_AT]) * (1.0 / inertia)
    return slope


@dataclass(frozen=True)
class Arm(Load):
    """An arm that rotates about a pivot, with a mass at its end."""

    inertia: float = parameter_field(
        0.02, 'moment of inertia of pulley and arm about the pivot', 'kg m^2', low=0.0, high=1e3
    )
    mass: float = parameter_field(1.0, 'mass of the load on the arm', 'kg', low=0.0, high=1e3)
    arm: float = parameter_field(
        0.25, 'distance of the load from the pivot', 'm', low=0.0, high=10.0
    )
    hanging_at: float = parameter_field(
        0.0, 'angle at which the arm points straight down', 'rad', low=-pi, high=pi
    )
    plane: str = parameter_field(
        'vertical',
        'vertical: the arm swings up and down; horizontal: it swings without gravity',
        choices=('vertical', 'horizontal'),
    )

    equations: ClassVar = LoadEquations(
        True, 4, inertia=_arm_inertia, fall=_pendulum, fall_slope=_pendulum_slope
    )

    def __post_init__(self) -> None:
        """Check every field, then that the inertia is above 0."""
        check_all(self)
        if self.inertia + self.mass * self.arm**2 <= 0.0:
            raise ParameterError(
                'inertia = 0 kg m^2 and no mass on the arm leave nothing to move: give '
                'inertia above 0, or mass and arm'
            )

    @property
    def gravity(self) -> float:
        """Gravitational acceleration in m/s^2 that acts on the load."""
        return GRAVITY if self.plane == 'vertical' else 0.0

    @property
    def numbers(self) -> tuple[float, ...]:
        """Moment of inertia, length of the arm, the angle at which it hangs, and gravity."""
        return self.inertia, self.arm, self.hanging_at, self.gravity
