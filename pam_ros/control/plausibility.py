# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Separate plausible measurements from faults of a sensor or of a line.

A position law acts on its measurements: one false sample throws or drops a load. A position is
plausible within the travel of the joint, and if its distance from the last plausible one is not
more than the force of the muscles can have moved the nominal inertia:

    |s - s_last| <= v (t + J) + a t^2 / 2 + n

t is the time between the two measurements, and v the highest speed measured recently: v allows a
load to stop at once or to bounce back, and covers the noise of the sensor. J allows for jitter of
the stamps, a is the greatest acceleration and n an allowance of 0.5 % of the travel.
A measured velocity is plausible up to v + a (t + J).
"""

from dataclasses import dataclass
from math import exp

import numpy as np

from pam_ros.control.allocation import Allocation
from pam_ros.control.model import ControlModel
from pam_ros.rig import statics

# Contraction beyond the permitted range that a load may reach: overshoot, and an offset of the
# zero position.
BEYOND = 0.1
# Times the nominal acceleration: for a load half as heavy, or pushed as strongly from outside.
LIGHTER = 2.0
# Of the permitted travel, at any time: five times the noise of the sensors in use.
ALLOWANCE = 0.005
JITTER = 0.01  # s, of a stamp: one time slice of a loaded computer
LATELY = 0.05  # s, in which the influence of a measured speed falls to 1/e
SHORTEST = 1e-3  # s between two measurements: times of receipt may be closer together
# Pa by which a measured pressure may be below the lowest that the muscle permits. Weather and an
# altitude of 1000 m lower the ambient pressure by up to 15 kPa, and a sensor for 10 bar has an
# error of 5 kPa. A larger margin is not useful: a value in kPa must remain outside.
UNDERPRESSURE = 20e3
OVERPRESSURE = 1.25  # times the highest permitted pressure: overshoot of valves, sensor errors
PLACES = 41  # at which the force over the travel is evaluated


@dataclass(frozen=True)
class MotionBounds:
    """Limits of the motion of a joint.

    For a revolute joint, read rad for m.

    low, high
        the travel, m
    acceleration
        the greatest, m/s^2
    allowance
        distance that is always plausible, m
    unit
        of the coordinate, for messages
    """

    low: float
    high: float
    acceleration: float
    allowance: float
    unit: str


def bounds_of(allocation: Allocation) -> MotionBounds:
    """Return the limits of motion of the nominal joint with the pressures within the limits."""
    model = allocation.model
    joint, unit = model.joint, model.joint.transmission.equations.unit
    low, high = statics.span(joint, BEYOND, BEYOND)
    permitted = statics.span(joint)
    places = np.linspace(*permitted, PLACES)
    greatest = max(_greatest_effort(model, allocation, float(s)) for s in places)
    return MotionBounds(
        low,
        high,
        LIGHTER * greatest / model.inertia,
        ALLOWANCE * (permitted[1] - permitted[0]),
        unit,
    )


def _greatest_effort(model: ControlModel, allocation: Allocation, s: float) -> float:
    """Return the greatest effort on the load at s, of the muscles and gravity together."""
    total = abs(model.gravity(s))
    for muscle, range_ in zip(model.at(s).muscles, allocation.ranges, strict=True):
        total += abs(muscle.arm) * max(abs(muscle.force(p)) for p in range_)
    return total


def fault_of_pressure(absolute: float, ambient: float, permitted: tuple[float, float]) -> str:
    """Return why a measured *absolute* pressure in Pa is not plausible, or '' if it is plausible.

    No chamber holds much less than the lowest or much more than the highest gauge pressure in Pa
    that is *permitted* for the muscle; *ambient* Pa is the absolute pressure around it.
    """
    low, high = ambient + permitted[0] - UNDERPRESSURE, ambient + OVERPRESSURE * permitted[1]
    if low <= absolute <= high:
        return ''
    question = ' (is it in kPa?)' if low <= 1e3 * absolute <= high else ''
    return f'{absolute:.6g} Pa, but only {low:.6g} to {high:.6g} Pa absolute is possible{question}'


class Plausibility:
    """Separates plausible measurements from those that are not, one after the other.

    The first position after :meth:`forget` is only compared with the travel. If the second one is
    too far from it, either of them may be false: the second one then counts as the first, and
    :attr:`is_first` is true again, so that a caller can start again.
    """

    def __init__(self, bounds: MotionBounds) -> None:
        """Make it for a joint of these bounds."""
        self.bounds = bounds
        self.forget()

    def forget(self) -> None:
        """Start again: the next measurement is the first."""
        self._last: float | None = None
        self._speed = 0.0
        self._is_confirmed = False  # by a second one

    @property
    def is_first(self) -> bool:
        """Whether the last plausible measurement is not confirmed by one before it."""
        return not self._is_confirmed

    def fault_of(self, passed: float, position: float, velocity: float | None = None) -> str:
        """Return why a measurement is not plausible, or '' if it is plausible.

        It was taken *passed* s after the last plausible one. Only plausible ones are remembered.
        """
        bounds, unit = self.bounds, self.bounds.unit
        if not bounds.low <= position <= bounds.high:
            return (
                f'position {position:.4g} {unit}, which is beyond the travel of the joint, '
                f'{bounds.low:.4g} to {bounds.high:.4g} {unit}'
            )
        passed, a = max(passed, SHORTEST), bounds.acceleration
        fastest = self._speed + a * (passed + JITTER)
        if velocity is not None and not abs(velocity) <= fastest:
            return (
                f'velocity {velocity:.4g} {unit}/s, but the joint can have reached '
                f'{fastest:.3g} {unit}/s at most'
            )
        if self._last is None:
            self._begin(position)
            return ''
        speed = self._speed * exp(-passed / LATELY)
        moved = abs(position - self._last)
        most = speed * (passed + JITTER) + 0.5 * a * passed * passed + bounds.allowance
        if moved > most:
            if not self._is_confirmed:
                self._begin(position)
                return ''
            return (
                f'position {position:.4g} {unit}, which is {moved:.3g} {unit} from the one '
                f'{passed:.3g} s before, but the joint can have moved {most:.3g} {unit} at most'
            )
        self._last, self._is_confirmed = position, True
        self._speed = max(speed, moved / passed)
        return ''

    def _begin(self, position: float) -> None:
        self._last, self._speed, self._is_confirmed = position, 0.0, False
