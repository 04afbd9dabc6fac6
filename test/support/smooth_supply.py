# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A pressure that is a smooth function of time, fed to the kernel through an effect of its own.

Commands are held between stamps; this is how the order of the integrator can be seen.
"""

from math import sin

from pam_ros.effects.base import Compensation, Effect, EffectParameter

MEAN, AMPLITUDE, RATE = 350e3, 200e3, 5.0  # Pa, Pa, rad/s


def pressure(p, t, h, x, i, xn, q, j):
    """Return the pressure at t, whatever is commanded."""
    return q[j] + q[j + 1] * sin(q[j + 2] * t)


def at(t):
    """Return the same in bar, for the paper's equations."""
    return (MEAN + AMPLITUDE * sin(RATE * t)) / 1e5


def _number(name, default, strength=False):
    return EffectParameter(name, default, name, '', -1e6, 1e6, scale=1.0, strength=strength)


EFFECT = Effect(
    name='smooth_supply',
    text='a pressure that swings',
    source='none: a test',
    parameters=(
        _number('mean', MEAN, strength=True),
        _number('amplitude', AMPLITUDE),
        _number('rate', RATE),
    ),
    signature='',
    experiment='',
    fit_starts=(),
    example={'mean': MEAN},
    compensation=Compensation.FEEDBACK,
    pressure=pressure,
)
