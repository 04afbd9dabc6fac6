# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The transmissions that connect muscles to the one coordinate that they move.

The coordinate s is a position in m or an angle in rad. Muscle i is at

    y_i = y_i(0) + travel(s, i),    y_i' = arm(s, i) s',    arm = d travel / d s,

contraction positive. Antagonistic muscles alternate: a positive angle shortens the first, the
third and so on, and lengthens the others.

A transmission is a dataclass of the parameters that a user sets, and
:class:`TransmissionEquations`: plain scalar functions that are compiled into the stepping kernel
if numba is installed. For a custom transmission, write both as below; no registration is needed.
"""

from collections.abc import Callable
from dataclasses import astuple, dataclass
from math import acos, cos, pi, sin, sqrt
from typing import Any, ClassVar

from pam_ros.constructors import RefusesUnknownNames
from pam_ros.parameters import check_all, parameter_field

# Least radius, crank and distance of an anchor, m: far below any that is built. Products of
# lengths that are smaller by many decades are 0 in floating-point numbers.
LEAST = 1e-4

Row = Any  # float64 row; numba's and numpy's types differ, both index to float


@dataclass(frozen=True, eq=False)
class TransmissionEquations:
    """The geometry of a transmission; q[j], q[j + 1], ... are its *numbers* numbers.

    ``travel(s, i, q, j) -> m``
        Displacement of the end of muscle i at the coordinate s, contraction positive, 0 at s = 0.
    ``arm(s, i, q, j) -> m/rad, or 1``
        Its derivative with respect to s: the shortening of muscle i per unit of s. Never 0.
    ``arm_slope(s, i, q, j) -> m/rad^2, or 0``
        The derivative of the arm with respect to s.
    ``coordinate(travel, i, q, j) -> m or rad``
        The inverse of ``travel``. It is called by Python, not by the kernel.
    """

    name: str
    revolute: bool
    numbers: int
    travel: Callable[..., float]
    arm: Callable[..., float]
    arm_slope: Callable[..., float]
    coordinate: Callable[..., float]

    @property
    def unit(self) -> str:
        """Unit of the coordinate."""
        return 'rad' if self.revolute else 'm'

    @property
    def effort_unit(self) -> str:
        """Unit of the effort of the muscles."""
        return 'N m' if self.revolute else 'N'


@dataclass(frozen=True)
class Transmission(metaclass=RefusesUnknownNames):
    """The parameters of a transmission: a dataclass of numbers."""

    equations: ClassVar[TransmissionEquations]

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)

    @property
    def numbers(self) -> tuple[float, ...]:
        """The numbers of its equations, SI."""
        return astuple(self)


# Straight --------------------------------------------------------------------------------------


def _same(s: float, i: int, q: Row, j: int) -> float:
    """Return s: the load moves with the muscles' ends."""
    return s


def _one(s: float, i: int, q: Row, j: int) -> float:
    """Return 1."""
    return 1.0


def _none(s: float, i: int, q: Row, j: int) -> float:
    """Return 0: the arm does not depend on the coordinate."""
    return 0.0


def _back(travel: float, i: int, q: Row, j: int) -> float:
    """Return the travel."""
    return travel


@dataclass(frozen=True)
class Straight(Transmission):
    """The muscles' ends are fixed to the load and all move with it."""

    equations: ClassVar = TransmissionEquations(
        'straight', False, 0, travel=_same, arm=_one, arm_slope=_none, coordinate=_back
    )


# Pulley ----------------------------------------------------------------------------------------


def _belt(s: float, i: int, q: Row, j: int) -> float:
    """Return r s, for every second muscle -r s."""
    travel: float = (1 - 2 * (i % 2)) * q[j] * s
    return travel


def _radius(s: float, i: int, q: Row, j: int) -> float:
    """Return r, for every second muscle -r."""
    arm: float = (1 - 2 * (i % 2)) * q[j]
    return arm


def _turned(travel: float, i: int, q: Row, j: int) -> float:
    """Return the angle."""
    s: float = travel / ((1 - 2 * (i % 2)) * q[j])
    return s


@dataclass(frozen=True)
class Pulley(Transmission):
    """A pulley that the muscles rotate by belts or chains."""

    radius: float = parameter_field(0.04, 'radius of the pulley', 'm', low=LEAST, high=1.0)

    equations: ClassVar = TransmissionEquations(
        'pulley', True, 1, travel=_belt, arm=_radius, arm_slope=_none, coordinate=_turned
    )


# Lever -----------------------------------------------------------------------------------------
# The line of the muscle is one side of a triangle. The other two sides meet at the pivot: the
# crank b and the distance a of the anchor, with the angle phi = phi_0 - s between them. So the
# line has the length L = sqrt(a^2 + b^2 - 2 a b cos phi), and dL/dphi = a b sin phi / L.


def _drawn(s: float, i: int, q: Row, j: int) -> float:
    """Return L(phi_0) - L(phi_0 - s), for every second muscle with -s."""
    crank, anchor, zero = q[j], q[j + 1], q[j + 2]
    squares = crank * crank + anchor * anchor
    product = 2.0 * crank * anchor
    phi = zero - (1 - 2 * (i % 2)) * s
    return sqrt(squares - product * cos(zero)) - sqrt(squares - product * cos(phi))


def _moment_arm(s: float, i: int, q: Row, j: int) -> float:
    """Return a b sin(phi) / L, for every second muscle the negative of that."""
    crank, anchor = q[j], q[j + 1]
    side = 1 - 2 * (i % 2)
    phi = q[j + 2] - side * s
    length = sqrt(crank * crank + anchor * anchor - 2.0 * crank * anchor * cos(phi))
    arm: float = side * crank * anchor * sin(phi) / length
    return arm


def _moment_arm_slope(s: float, i: int, q: Row, j: int) -> float:
    """Return (arm^2 - a b cos(phi)) / L."""
    crank, anchor = q[j], q[j + 1]
    phi = q[j + 2] - (1 - 2 * (i % 2)) * s
    length = sqrt(crank * crank + anchor * anchor - 2.0 * crank * anchor * cos(phi))
    arm = crank * anchor * sin(phi) / length
    slope: float = (arm * arm - crank * anchor * cos(phi)) / length
    return slope


def _swung(travel: float, i: int, q: Row, j: int) -> float:
    """Return the angle, limited at the dead centres, where the triangle is flat."""
    crank, anchor, zero = q[j], q[j + 1], q[j + 2]
    squares = crank * crank + anchor * anchor
    product = 2.0 * crank * anchor
    length = sqrt(squares - product * cos(zero)) - travel
    cosine = (squares - length * abs(length)) / product
    phi = acos(min(max(cosine, -DEAD_CENTRE), DEAD_CENTRE))
    s: float = (1 - 2 * (i % 2)) * (zero - phi)
    return s


DEAD_CENTRE = 0.995  # cosine of the limit of the angle near a dead centre, where the arm is 0


@dataclass(frozen=True)
class Lever(Transmission):
    """A lever that the muscles rotate at a crank, so that their arms change with the angle."""

    crank: float = parameter_field(
        0.04, 'distance of the attachment from the pivot', 'm', low=LEAST, high=1.0
    )
    anchor: float = parameter_field(
        0.45, 'distance of the fixed end of the muscle from the pivot', 'm', low=LEAST, high=20.0
    )
    angle: float = parameter_field(
        0.5 * pi, 'angle between crank and anchor at coordinate 0', 'rad', low=0.1, high=3.0
    )

    equations: ClassVar = TransmissionEquations(
        'lever',
        True,
        3,
        travel=_drawn,
        arm=_moment_arm,
        arm_slope=_moment_arm_slope,
        coordinate=_swung,
    )
