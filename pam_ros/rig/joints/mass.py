# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One muscle and a mass that hangs on it or slides: the paper's rig, as one joint among others."""

from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joints.base import Joint, Row
from pam_ros.rig.model import Load


def row(load: Load, muscles: tuple[Muscle, ...]) -> tuple[float, ...]:
    """Return mass in kg and gravity in m/s^2."""
    return load.mass, load.gravity


def position(s: float, i: int, g: Row) -> float:
    """Return s: the load moves with the muscle's end."""
    return s


def arm(s: float, i: int, g: Row) -> float:
    """Return 1."""
    return 1.0


def coordinate(y: float, i: int, g: Row) -> float:
    """Return y."""
    return y


def inertia(m: float, g: Row) -> float:
    """Return the moved mass."""
    return m


def fall(s: float, m: float, j: float, g: Row) -> float:
    """Return the acceleration of gravity, which stretches the muscle."""
    acceleration: float = g[1]
    return acceleration


def fall_slope(s: float, m: float, j: float, g: Row) -> float:
    """Return 0: gravity is the same everywhere."""
    return 0.0


JOINT = Joint(
    name='mass',
    text='a mass that hangs on one muscle, or slides',
    muscles=1,
    revolute=False,
    declared=Load,
    row=row,
    position=position,
    arm=arm,
    coordinate=coordinate,
    inertia=inertia,
    fall=fall,
    fall_slope=fall_slope,
)
