# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of the commanded pressure, and the positions at which a load can be held."""

from dataclasses import dataclass

from pam_ros.constructors import RefusesUnknownNames
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle.muscle import Muscle
from pam_ros.muscle.pressure_unit import is_low
from pam_ros.parameters import check_all, parameter_field

MARGIN = 0.02  # share of the range of pressure that is kept for control at each end


@dataclass(frozen=True)
class Limits(metaclass=RefusesUnknownNames):
    """Limits of the commanded pressure, within those of the muscle."""

    pressure_low: float = parameter_field(
        0.0, 'lowest gauge pressure that is commanded', 'Pa', low=0.0, high=5e6
    )
    pressure_high: float = parameter_field(
        5e6,
        'highest gauge pressure that is commanded, but at most the p_max of the muscle',
        'Pa',
        low=0.0,
        high=5e6,
        above_low=True,
    )
    pressure_rate: float = parameter_field(
        20e6, 'fastest change of the commanded pressure', 'Pa/s', low=1e3, high=1e9
    )

    def __post_init__(self) -> None:
        """Check every field, then that the range is not empty."""
        check_all(self)
        if self.pressure_low >= self.pressure_high:
            raise ParameterError(
                f'pressure_low = {self.pressure_low:g} Pa is not below pressure_high = '
                f'{self.pressure_high:g} Pa'
            )

    def range_for(self, muscle: Muscle) -> tuple[float, float]:
        """Return the lowest and highest pressure in Pa for a muscle; raises ParameterError."""
        low = max(self.pressure_low, muscle.p_min)
        high = min(self.pressure_high, muscle.p_max)
        if low >= high:
            raise ParameterError(
                f'pressure_low = {self.pressure_low:g} Pa leaves no range below the p_max = '
                f'{muscle.p_max:g} Pa of the muscle'
            )
        if is_low(high, muscle.p_max):
            raise ParameterError(
                f'pressure_high = {high:g} Pa is not allowed, with p_max = {muscle.p_max:g} Pa: '
                'pressures are in Pa, is it in kPa or bar?'
            )
        return low, high


def clamp(value: float, low: float, high: float) -> float:
    """Return the number nearest to *value* in the range from *low* to *high*."""
    return low if value < low else high if value > high else value


class Limiter:
    """Keeps commands within a range and a rate."""

    def __init__(self, low: float, high: float, rate: float) -> None:
        """Keep them within *low* to *high* Pa and *rate* Pa/s."""
        self.low, self.high, self.rate = low, high, rate
        self.last = low

    def start(self, pressure: float) -> None:
        """Begin at a *pressure* in Pa."""
        self.last = min(max(pressure, self.low), self.high)

    def limit(self, wanted: float, dt: float) -> float:
        """Return the allowed pressure in Pa nearest to *wanted*, *dt* s after the last one."""
        last, step = self.last, self.rate * dt
        self.last = clamp(clamp(wanted, last - step, last + step), self.low, self.high)
        return self.last


def refuse_unreachable(position: float, reach: tuple[float, float], unit: str = 'm') -> None:
    """Raise RangeError, with the range, if the load cannot be held at this reference."""
    low, high = reach
    if not low <= position <= high:
        raise unreachable(f'reference {position:.6g} {unit}', reach, unit)


def unreachable(what: str, reach: tuple[float, float], unit: str) -> RangeError:
    """Return the error, with the range, for a position that *what* describes."""
    return RangeError(f'{what} is out of reach: {range_text(reach, unit)}')


def range_text(reach: tuple[float, float], unit: str) -> str:
    """Return a sentence on the range of the references."""
    return f'this rig can hold its load at {reach[0]:.4g} to {reach[1]:.4g} {unit}'
