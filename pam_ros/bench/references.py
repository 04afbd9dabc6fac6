# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Desired positions over time, and how a YAML file describes them.

All positions are relative to the position at which the rig starts at rest. Before its first motion
each reference is 0, and after its last one it stays where it is. Except for the jumps of ``Step``
and ``Staircase``, position and velocity are continuous.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import MISSING, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from pam_ros.arguments import refuse
from pam_ros.cached_property import cached_property
from pam_ros.errors import ParameterError, printable
from pam_ros.parameters import Parameter, described, field_about, parameter_field

Array = NDArray[np.float64]

FARTHEST = 10.0  # m or rad
LONGEST = 3600.0  # s
SHORTEST = 1e-3  # s between two points or levels, and of a motion
SOONEST = 0.1  # s: a jump in the first period could not be told from another start
ROUNDING = 1e-9  # s: the stamps of ROS are whole nanoseconds


def _given(text: str, unit: str, low: float, high: float) -> Any:
    """Return a dataclass field for a number that must be given, or for a list of numbers."""
    return field_about(MISSING, Parameter(text, unit, low=low, high=high, live=False))


def _position(text: str) -> Any:
    return _given(text, 'm', -FARTHEST, FARTHEST)


def _frequency(text: str) -> Any:
    return _given(text, 'Hz', 1e-3, 100.0)


def _time(text: str, *, low: float = 0.0) -> Any:
    """Return a dataclass field for the time of the first motion."""
    return parameter_field(1.0, text, 's', low=low, high=LONGEST, live=False)


@dataclass(frozen=True)
class Reference(ABC):
    """A desired position over time. Raises ParameterError for a value that is not allowed."""

    def __post_init__(self) -> None:
        """Check every field; lists become tuples of floats."""
        for name, (kind, _, about) in described(type(self)).items():
            value = getattr(self, name)
            one = about.check(name, value, float) if kind is float else _list(name, value, about)
            object.__setattr__(self, name, one)

    @abstractmethod
    def at(self, t: Array) -> Array:
        """Return the desired position in m or rad at the times *t* in s, in the shape of *t*.

        It is relative to the position at the start, where t = 0.
        """


def _list(name: str, values: Any, about: Parameter) -> tuple[float, ...]:
    """Return *values* as floats, or raise ParameterError: each must be allowed by *about*."""
    allowed = f'a list of numbers, each {about.allowed()}'
    if not isinstance(values, list | tuple | np.ndarray) or not len(values):
        refuse(name, values, allowed)
    return tuple(about.check(f'{name}[{i}]', value, float) for i, value in enumerate(values))


def _smooth(s: Array) -> Array:
    """Return 0 for s <= 0, 1 for s >= 1, and between them the minimum-jerk polynomial.

    Its first and second derivatives are 0 at both ends: Flash and Hogan 1985, J. Neuroscience 5,
    1688-1703.
    """
    s = np.clip(s, 0.0, 1.0)
    rise: Array = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    return rise


@dataclass(frozen=True)
class Hold(Reference):
    """The position at the start, for the whole time."""

    def at(self, t: Array) -> Array:
        """Return zeros in the shape of *t*."""
        return np.zeros(np.shape(t))


@dataclass(frozen=True)
class Step(Reference):
    """One jump."""

    size: float = _position('height of the step, negative for a step down')
    time: float = _time('time of the step', low=SOONEST)

    def at(self, t: Array) -> Array:
        """Return the desired position in m or rad at the times *t* in s."""
        return np.where(np.asarray(t) >= self.time - ROUNDING, self.size, 0.0)


@dataclass(frozen=True)
class Staircase(Reference):
    """Jumps from level to level at equal intervals; the last level is kept."""

    sizes: tuple[float, ...] = _position('levels in their order, each relative to the start')
    time: float = _time('time of the jump to the first level', low=SOONEST)
    every: float = parameter_field(
        3.0, 'time from jump to jump', 's', low=SHORTEST, high=LONGEST, live=False
    )

    def at(self, t: Array) -> Array:
        """Return the desired position in m or rad at the times *t* in s."""
        passed = np.floor((np.asarray(t) - self.time + ROUNDING) / self.every)
        levels = np.array([0.0, *self.sizes])
        level: Array = levels[np.clip(passed + 1.0, 0.0, len(self.sizes)).astype(int)]
        return level


@dataclass(frozen=True)
class Sine(Reference):
    """A sine without end; its amplitude grows smoothly over the first period.

    Position, velocity and acceleration are continuous, so that nothing is excited at the start
    but by the sine itself.
    """

    amplitude: float = _position('amplitude; negative if it begins downwards')
    frequency: float = _frequency('frequency')
    time: float = _time('time at which it begins')

    def at(self, t: Array) -> Array:
        """Return the desired position in m or rad at the times *t* in s."""
        cycles = self.frequency * np.maximum(np.asarray(t) - self.time, 0.0)
        wave: Array = self.amplitude * _smooth(cycles) * np.sin(2.0 * np.pi * cycles)
        return wave


@dataclass(frozen=True)
class Chirp(Reference):
    """A sine whose frequency rises exponentially from the lowest to the highest.

    Exponentially, because what a muscle and its valve can follow changes with the ratio of
    frequencies: each octave lasts equally long. In a linear sweep most of the time would belong to
    the highest octave, which few muscles can follow. The amplitude grows smoothly over the first
    cycle, and falls smoothly to 0 over the last one.
    """

    amplitude: float = _position('amplitude; negative if it begins downwards')
    frequency_low: float = _frequency('frequency at the start')
    frequency_high: float = _frequency('frequency at the end, above frequency_low')
    sweep_time: float = _given(
        'duration of the sweep, at least two cycles', 's', SHORTEST, LONGEST
    )
    time: float = _time('time at which it begins')

    def __post_init__(self) -> None:
        """Check every field, then the frequencies, and the duration in cycles."""
        super().__post_init__()
        if self.frequency_high <= self.frequency_low:
            refuse(
                'frequency_high',
                self.frequency_high,
                f'a frequency above frequency_low = {self.frequency_low:g} Hz',
            )
        if self._cycles(1.0) < 2.0:
            shortest = 2.0 * self.sweep_time / self._cycles(1.0)
            refuse(
                'sweep_time',
                self.sweep_time,
                f'at least {shortest:.4g} s, in which the sweep has two cycles',
            )

    def _cycles(self, share: Any) -> Any:
        """Return the cycles in a *share* of the sweep from its start: integrated frequency."""
        growth = np.log(self.frequency_high / self.frequency_low)
        return self.frequency_low * self.sweep_time * np.expm1(growth * share) / growth

    def at(self, t: Array) -> Array:
        """Return the desired position in m or rad at the times *t* in s."""
        share = np.clip((np.asarray(t) - self.time) / self.sweep_time, 0.0, 1.0)
        cycles = self._cycles(share)
        window = _smooth(cycles) * _smooth(self._cycles(1.0) - cycles)
        wave: Array = self.amplitude * window * np.sin(2.0 * np.pi * cycles)
        return wave


@dataclass(frozen=True)
class MinimumJerk(Reference):
    """One motion from rest to rest with the least mean square of the jerk.

    Flash and Hogan 1985, J. Neuroscience 5, 1688-1703.
    """

    size: float = _position('length of the motion, negative for a motion down')
    travel_time: float = _given('duration of the motion', 's', SHORTEST, LONGEST)
    time: float = _time('time at which it begins')

    def at(self, t: Array) -> Array:
        """Return the desired position in m or rad at the times *t* in s."""
        return self.size * _smooth((np.asarray(t) - self.time) / self.travel_time)


@dataclass(frozen=True)
class Trajectory(Reference):
    """A motion through points, from rest at the start to rest at the last point.

    Between the points it is a piecewise cubic Hermite interpolating polynomial (PCHIP; Fritsch and
    Butland 1984, SIAM J. Sci. Stat. Comput. 5, 300-304). It stays between the positions of
    neighbouring points, while a cubic spline overshoots them, perhaps beyond what the muscles can
    reach. Its velocity is continuous, and 0 at both ends and wherever the direction changes.
    As in a ``JointTrajectory``, the motion to the first point begins at time 0.
    """

    times: tuple[float, ...] = _given('times of the points, ascending', 's', 0.0, LONGEST)
    positions: tuple[float, ...] = _position('positions of the points, one for each time')

    def __post_init__(self) -> None:
        """Check every field, then the lists against each other."""
        super().__post_init__()
        if len(self.positions) != len(self.times):
            refuse(
                'positions',
                list(self.positions),
                f'as many as times: {len(self.times)}, not {len(self.positions)}',
            )
        if self.times[0] == 0.0 and self.positions[0] != 0.0:
            refuse('positions[0]', self.positions[0], '0 at time 0, where the rig starts')
        earlier = (0.0, *self.times)
        for i, time in enumerate(self.times):
            is_start = i == 0 and time == 0.0
            if not is_start and time - earlier[i] < SHORTEST - ROUNDING:
                before = f'times[{i - 1}] = {earlier[i]:g} s' if i else 'the start'
                allowed = f'ascending times: at least {SHORTEST:g} s after {before}'
                refuse(f'times[{i}]', time, allowed)

    @cached_property
    def _curve(self) -> PchipInterpolator:
        """The curve through the points, and points of rest before and after, for no velocity."""
        skip = 1 if self.times[0] == 0.0 else 0
        t = [-1.0, 0.0, *self.times[skip:], self.times[-1] + 1.0]
        positions = [0.0, 0.0, *self.positions[skip:], self.positions[-1]]
        with np.errstate(over='ignore'):  # it divides by slopes, which may be tiny
            return PchipInterpolator(t, positions)

    def at(self, t: Array) -> Array:
        """Return the desired position in m or rad at the times *t* in s."""
        position: Array = self._curve(np.clip(t, 0.0, self.times[-1]))
        return position


REFERENCES: dict[str, type[Reference]] = {
    'hold': Hold,
    'step': Step,
    'staircase': Staircase,
    'sine': Sine,
    'chirp': Chirp,
    'minimum_jerk': MinimumJerk,
    'trajectory': Trajectory,
}


def reference_of(values: Mapping[str, object], what: str) -> Reference:
    """Return the reference that the mapping of a YAML file describes: ``kind`` and its fields.

    Raises ParameterError, with *what* in front, for a kind, a key or a value that is not allowed,
    and for a key that is missing.
    """
    try:
        return _reference(values)
    except ParameterError as error:
        raise ParameterError(f'{what}: {error}') from error


def _reference(values: Any) -> Reference:
    kinds = ', '.join(REFERENCES)
    if not isinstance(values, Mapping):
        raise ParameterError(
            f'{printable(repr(values))} is not a mapping: give {{kind: ...}}, one of {kinds}'
        )
    if 'kind' not in values:
        raise ParameterError(f'kind is missing: give one of {kinds}')
    kind = values['kind']
    if not isinstance(kind, str) or kind not in REFERENCES:
        refuse('kind', kind, f'one of {kinds}')
    cls = REFERENCES[kind]
    table = described(cls)
    for name, value in values.items():
        if name != 'kind' and name not in table:
            keys = f'one of {", ".join(table)}' if table else 'no other key'
            refuse(str(name), value, f'{keys} for the kind {kind}')
    for name, (number, default, about) in table.items():
        if default is MISSING and name not in values:
            allowed = about.allowed() if number is float else f'a list, each {about.allowed()}'
            raise ParameterError(f'{name} is missing: give {allowed} ({about.text})')
    return cls(**{str(name): value for name, value in values.items() if name != 'kind'})
