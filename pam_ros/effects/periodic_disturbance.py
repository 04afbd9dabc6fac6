# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Periodic disturbance: a sinusoid in the force on the load, or in the supply pressure."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import cos, pi, sin
from typing import ClassVar

import numpy as np

from pam_ros.effects.base import (
    Array,
    Compensation,
    Effect,
    EffectEquations,
    Interval,
    Row,
    Starts,
)
from pam_ros.effects.parameter import effect_parameter, start_from, strength

FORCE_SIN, FORCE_COS, PRESSURE_SIN, PRESSURE_COS, FREQUENCY = range(5)
PERIODS = 3  # fewest in a recording; a slow error with fewer of them may be a drift


def force(
    f: float,
    p: float,
    kappa: float,
    v: float,
    t: float,
    h: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return f + a sin(w t) + b cos(w t), a force_sin, b force_cos, w = 2 pi frequency."""
    if q[j + FORCE_SIN] == 0.0 and q[j + FORCE_COS] == 0.0:
        return f
    angle = 2.0 * pi * q[j + FREQUENCY] * t
    return f + (q[j + FORCE_SIN] * sin(angle) + q[j + FORCE_COS] * cos(angle))


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return p + a sin(w t) + b cos(w t), with a pressure_sin and b pressure_cos."""
    if q[j + PRESSURE_SIN] == 0.0 and q[j + PRESSURE_COS] == 0.0:
        return p
    angle = 2.0 * pi * q[j + FREQUENCY] * t
    return p + (q[j + PRESSURE_SIN] * sin(angle) + q[j + PRESSURE_COS] * cos(angle))


def tallest_lines(t: Array, residual: Array) -> list[float]:
    """Return the frequencies in Hz of the two tallest lines in the residual's spectrum.

    Each is a maximum of a zero-padded periodogram with a Hann window, refined by the parabola
    through its logarithm. So a fit begins with an error well below 1/duration.
    """
    n = t.size
    even = np.linspace(t[0], t[-1], n)
    values = np.interp(even, t, residual)
    trend = np.polynomial.Polynomial.fit(even, values, 3)
    size = 8 * n
    power = np.abs(np.fft.rfft((values - trend(even)) * np.hanning(n), size)) ** 2
    step = (n - 1) / (size * (t[-1] - t[0]))
    least = 8 * PERIODS
    power[:least] = 0.0
    found = []
    for _ in range(2):
        k = int(np.argmax(power[:-1]))
        if k < least or power[k] <= 0.0:
            break
        left, peak, right = np.log(power[k - 1 : k + 2] + 1e-300)
        bend = left - 2.0 * peak + right
        shift = 0.5 * (left - right) / bend if bend < 0.0 else 0.0
        found.append((k + float(np.clip(shift, -0.5, 0.5))) * step)
        power[max(k - 32, 0) : k + 33] = 0.0
    return found


def guess(t: Array, p: Array, kappa: Array, residual: Array) -> Starts:
    """Return a start in the force, and one in the pressure, for each of the tallest lines."""
    lines = tallest_lines(t, residual)
    in_force = (
        start_from(PeriodicDisturbance, force_sin=1.0, force_cos=1.0, frequency=line)
        for line in lines
    )
    in_pressure = (
        start_from(PeriodicDisturbance, pressure_sin=500.0, pressure_cos=500.0, frequency=line)
        for line in lines
    )
    return (*in_force, *in_pressure)


@dataclass(frozen=True)
class PeriodicDisturbance(Effect):
    """Sinusoid in the force between muscle and load, or ripple of the supply pressure."""

    force_sin: float = strength('sine part of the force', 'N', low=-1e4, high=1e4, scale=5.0)
    force_cos: float = strength('cosine part of the force', 'N', low=-1e4, high=1e4, scale=5.0)
    pressure_sin: float = strength(
        'sine part of the supply pressure', 'Pa', low=-2e5, high=2e5, scale=2e3
    )
    pressure_cos: float = strength(
        'cosine part of the supply pressure', 'Pa', low=-2e5, high=2e5, scale=2e3
    )
    frequency: float = effect_parameter(1.0, 'frequency', 'Hz', low=0.0, high=500.0, scale=1.0)

    name: ClassVar = 'periodic_disturbance'
    text: ClassVar = (
        'sinusoid in the force between muscle and load, or ripple of the supply pressure'
    )
    source: ClassVar = 'Harmonic disturbance; linear in its sine and cosine amplitudes'
    equation: ClassVar = (
        'F = F_in + force_sin sin(w t) + force_cos cos(w t)\n'
        'p = p_in + pressure_sin sin(w t) + pressure_cos cos(w t)\n'
        'w = 2 π frequency'
    )
    signature: ClassVar = 'a narrow line in the spectrum of the residual'
    experiment: ClassVar = (
        'a rest at constant pressure shows it alone; record the supply pressure, too'
    )
    excitation: ClassVar = {'segments': ('steps',), 'pressure_min': 199e3, 'pressure_max': 200e3}
    compensation: ClassVar = Compensation.FEEDBACK
    moves_by_itself: ClassVar = True
    equations: ClassVar = EffectEquations(pressure=pressure, force=force, guess=guess)

    @classmethod
    def fit_bounds(
        cls, near: Mapping[str, float], fitted: Collection[str], mass: float, duration: float
    ) -> dict[str, Interval]:
        """Return the bounds with which it is periodic in a recording of *duration* s."""
        return {'frequency': (PERIODS / duration, np.inf)}

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, force_sin=2.0, force_cos=2.0, frequency=1.0),
            start_from(cls, pressure_sin=1e3, pressure_cos=1e3, frequency=1.0),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return the effect clearly present."""
        return cls(force_sin=3.0, pressure_cos=2e3, frequency=2.3)
