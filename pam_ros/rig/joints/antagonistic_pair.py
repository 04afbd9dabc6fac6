# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Two muscles that pull a pulley in opposite ways, and an arm on it.

The equations, with positions along the muscles' lines and J = I + m l^2:

    J theta'' = r (F_1 - c_1 y_1') - r (F_2 - c_2 y_2') + outside - m g l sin(theta - theta_h)
    y_1 = kappa_1 l0_1 + r theta,    y_2 = kappa_2 l0_2 - r theta
"""

from dataclasses import dataclass
from math import cos, pi, sin

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import check_all, parameter
from pam_ros.rig.joints.base import Joint, Row
from pam_ros.rig.model import GRAVITY


@dataclass(frozen=True)
class PulleyArm:
    """Pulley and arm that an antagonistic pair turns, and how the muscles are hung up.

    A positive angle shortens the first muscle. The angle is 0 where the muscles have their
    stated contractions. Friction of the pivot and stops are effects on the load.
    """

    radius: float = parameter(0.04, 'radius of the pulley', 'm', low=0.0, high=1.0, above_low=True)
    inertia: float = parameter(
        0.02, 'moment of inertia of pulley and arm about the pivot', 'kg m^2', low=0.0, high=1e3
    )
    mass: float = parameter(1.0, 'mass of the load on the arm', 'kg', low=0.0, high=1e3)
    arm: float = parameter(0.25, 'distance of the load from the pivot', 'm', low=0.0, high=10.0)
    hanging_at: float = parameter(
        0.0, 'angle at which the arm points straight down', 'rad', low=-pi, high=pi
    )
    plane: str = parameter(
        'vertical',
        'vertical: the arm swings up and down; horizontal: it swings without gravity',
        choices=('vertical', 'horizontal'),
    )
    contraction_1: float = parameter(
        0.1, 'contraction of the first muscle at angle 0', 'fraction', low=-0.5, high=0.9
    )
    contraction_2: float = parameter(
        0.1, 'contraction of the second muscle at angle 0', 'fraction', low=-0.5, high=0.9
    )

    def __post_init__(self) -> None:
        """Check every field, then that there is something to move."""
        check_all(self)
        if self.inertia + self.mass * self.arm**2 <= 0.0:
            raise ParameterError(
                'inertia = 0 kg m^2 and no mass on the arm leave nothing to move: give '
                'inertia above 0, or mass and arm'
            )

    @property
    def gravity(self) -> float:
        """Acceleration in m/s^2 with which gravity pulls on the load."""
        return GRAVITY if self.plane == 'vertical' else 0.0


# The row: mass, r, I, l, theta_h, g, and the muscles' positions at angle 0.
R, INERTIA, ARM, HANGING_AT, G, AT_ZERO = range(1, 7)


def row(load: PulleyArm, muscles: tuple[Muscle, ...]) -> tuple[float, ...]:
    """Return the row, SI."""
    y1, y2 = load.contraction_1 * muscles[0].l0, load.contraction_2 * muscles[1].l0
    return (
        load.mass,
        load.radius,
        load.inertia,
        load.arm,
        load.hanging_at,
        load.gravity,
        y1,
        y2,
    )


def position(s: float, i: int, g: Row) -> float:
    """Return where the belt has drawn the muscle: the second one the other way."""
    y: float = g[AT_ZERO + i] + (1 - 2 * i) * g[R] * s
    return y


def arm(s: float, i: int, g: Row) -> float:
    """Return r for the first muscle, -r for the second."""
    r: float = (1 - 2 * i) * g[R]
    return r


def coordinate(y: float, i: int, g: Row) -> float:
    """Return the angle."""
    s: float = (y - g[AT_ZERO + i]) / ((1 - 2 * i) * g[R])
    return s


def inertia(m: float, g: Row) -> float:
    """Return I + m l^2."""
    j: float = g[INERTIA] + m * g[ARM] * g[ARM]
    return j


def fall(s: float, m: float, j: float, g: Row) -> float:
    """Return m g l sin(theta - theta_h) / J: a pendulum's acceleration."""
    a: float = m * g[G] * g[ARM] * sin(s - g[HANGING_AT]) * (1.0 / j)
    return a


def fall_slope(s: float, m: float, j: float, g: Row) -> float:
    """Return m g l cos(theta - theta_h) / J."""
    slope: float = m * g[G] * g[ARM] * cos(s - g[HANGING_AT]) * (1.0 / j)
    return slope


JOINT = Joint(
    name='antagonistic_pair',
    text='two muscles that turn a pulley against each other',
    muscles=2,
    revolute=True,
    declared=PulleyArm,
    row=row,
    position=position,
    arm=arm,
    coordinate=coordinate,
    inertia=inertia,
    fall=fall,
    fall_slope=fall_slope,
)
