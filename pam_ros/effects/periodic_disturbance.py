# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Periodic disturbance: a sinusoid in the force on the load, or in the supply pressure."""

from math import cos, pi, sin

import numpy as np

from pam_ros.effects.base import Array, Compensation, Effect, EffectParameter, Row


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
    """Return f + a sin(w t) + b cos(w t), a, b = q[j], q[j + 1], w = 2 pi q[j + 4]."""
    if q[j] == 0.0 and q[j + 1] == 0.0:
        return f
    angle = 2.0 * pi * q[j + 4] * t
    return f + (q[j] * sin(angle) + q[j + 1] * cos(angle))


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return p + a sin(w t) + b cos(w t), with a, b = q[j + 2], q[j + 3] in Pa."""
    if q[j + 2] == 0.0 and q[j + 3] == 0.0:
        return p
    angle = 2.0 * pi * q[j + 4] * t
    return p + (q[j + 2] * sin(angle) + q[j + 3] * cos(angle))


def guess(t: Array, p: Array, kappa: Array, residual: Array) -> tuple[dict[str, float], ...]:
    """Return a start for each of the two tallest lines in the residual's spectrum.

    Each is the best of a zero-padded Hann periodogram, refined by the parabola through its
    logarithm, so that a fit begins well within 1/duration of it.
    """
    n = t.size
    even = np.linspace(t[0], t[-1], n)
    values = np.interp(even, t, residual)
    trend = np.polynomial.Polynomial.fit(even, values, 3)
    size = 8 * n
    power = np.abs(np.fft.rfft((values - trend(even)) * np.hanning(n), size)) ** 2
    step = (n - 1) / (size * (t[-1] - t[0]))
    least = 8 * 3  # a line slower than three periods in the record is a drift
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
    force = tuple({'force_sin': 1.0, 'force_cos': 1.0, 'frequency': f} for f in found)
    return force + tuple(
        {'pressure_sin': 500.0, 'pressure_cos': 500.0, 'frequency': f} for f in found
    )


EFFECT = Effect(
    name='periodic_disturbance',
    text='sinusoid in the force between muscle and load, or ripple of the supply pressure',
    source='Harmonic disturbance; linear in its sine and cosine amplitudes',
    parameters=(
        EffectParameter(
            'force_sin',
            0.0,
            'sine part of the force',
            'N',
            -1e4,
            1e4,
            scale=5.0,
            strength=True,
        ),
        EffectParameter(
            'force_cos',
            0.0,
            'cosine part of the force',
            'N',
            -1e4,
            1e4,
            scale=5.0,
            strength=True,
        ),
        EffectParameter(
            'pressure_sin',
            0.0,
            'sine part of the supply pressure',
            'Pa',
            -2e5,
            2e5,
            scale=2e3,
            strength=True,
        ),
        EffectParameter(
            'pressure_cos',
            0.0,
            'cosine part of the supply pressure',
            'Pa',
            -2e5,
            2e5,
            scale=2e3,
            strength=True,
        ),
        EffectParameter('frequency', 1.0, 'frequency', 'Hz', 0.0, 500.0, scale=1.0),
    ),
    signature='a narrow line in the spectrum of the residual',
    experiment='a rest at constant pressure: what is left moves by itself; log the supply',
    fit_starts=(
        {'force_sin': 2.0, 'force_cos': 2.0, 'frequency': 1.0},
        {'pressure_sin': 1e3, 'pressure_cos': 1e3, 'frequency': 1.0},
    ),
    example={'force_sin': 3.0, 'pressure_cos': 2e3, 'frequency': 2.3},
    compensation=Compensation.FEEDBACK,
    force=force,
    pressure=pressure,
    guess=guess,
    moves_by_itself=True,
)
