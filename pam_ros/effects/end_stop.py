# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""End stops: the load meets a stiff pad at the top, and another at the bottom."""

from math import hypot

import numpy as np

from pam_ros.effects.base import Array, Compensation, Effect, EffectParameter, HiddenState, Row
from pam_ros.effects.rows import INERTIA, LENGTH


def outside(
    f: float,
    p: float,
    y: float,
    v: float,
    t: float,
    h: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return f with the push of the pads: k d (1 + b d') for d > 0 deep in one, never a pull.

    The upper pad begins at the contraction q[j] and has k = q[j + 1], the lower at q[j + 2]
    and has q[j + 3]; b = q[j + 4]. Hunt and Crossley's law: no jump at contact. What a step of
    length h = x[i] cannot resolve, stiffness near m/h^2 and damping beyond m/4h, is softened:
    between two pads even a moved mass of a fifth of the declared m stays stable.
    """
    if q[j + 1] == 0.0 and q[j + 3] == 0.0:
        return f
    xn[i] = h
    most_k = q[INERTIA] / (x[i] * x[i])
    most_c = 0.25 * q[INERTIA] / x[i]
    d = y - q[j] * q[LENGTH]
    if d > 0.0 and q[j + 1] > 0.0:
        spring = d * q[j + 1] / hypot(1.0, q[j + 1] / most_k)
        c = q[j + 4] * spring
        push = spring + min(c, most_c) * v
        f -= max(push, 0.0)
    d = q[j + 2] * q[LENGTH] - y
    if d > 0.0 and q[j + 3] > 0.0:
        spring = d * q[j + 3] / hypot(1.0, q[j + 3] / most_k)
        c = q[j + 4] * spring
        push = spring - min(c, most_c) * v
        f += max(push, 0.0)
    return f


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the usual step."""
    return (1e-3,)


def guess(t: Array, p: Array, kappa: Array, residual: Array) -> tuple[dict[str, float], ...]:
    """Return starts with a pad just within the travel that was recorded, at either end."""
    low, high = np.nanquantile(kappa, [0.02, 0.98])
    inside = 0.02 * (high - low)
    return (
        {'upper': float(high - inside), 'stiffness': 3e4},
        {'upper': float(high - 10.0 * inside), 'stiffness': 1e4},
        {'lower': float(low + inside), 'lower_stiffness': 3e4},
    )


EFFECT = Effect(
    name='end_stop',
    text='stiff one-sided pads at the ends of the travel',
    source='Hunt & Crossley 1975; maker: at most 25 % contraction',
    parameters=(
        EffectParameter(
            'upper',
            0.25,
            'contraction at which the upper pad begins',
            'fraction',
            -0.5,
            1.0,
            scale=0.1,
        ),
        EffectParameter(
            'stiffness',
            0.0,
            'stiffness of the upper pad; 0: there is none',
            'N/m',
            0.0,
            1e8,
            scale=1e5,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'lower',
            0.0,
            'contraction at which the lower pad begins',
            'fraction',
            -0.5,
            1.0,
            scale=0.1,
        ),
        EffectParameter(
            'lower_stiffness',
            0.0,
            'stiffness of the lower pad; 0: there is none',
            'N/m',
            0.0,
            1e8,
            scale=1e5,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'damping', 2.0, 'relative growth of the push with speed', 's/m', 0.0, 1e3, scale=2.0
        ),
    ),
    signature='residual only beyond a position, pushing back',
    experiment='touch it slowly, and touch it with another load',
    fit_starts=(
        {'upper': 0.2, 'stiffness': 3e4},
        {'upper': 0.12, 'stiffness': 3e4},
        {'lower': 0.02, 'lower_stiffness': 3e4},
    ),
    example={'upper': 0.2, 'stiffness': 3e4},
    compensation=Compensation.FEEDBACK,
    states=(HiddenState('step', 's'),),
    start=start,
    rivals=('slack', 'length_offset'),
    outside=outside,
    guess=guess,
)
