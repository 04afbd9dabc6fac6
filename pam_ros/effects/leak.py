# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Leak: the chamber loses pressure in proportion to it, and the valve gives it back, or not."""

from math import exp, expm1, log, log1p

from pam_ros.effects.base import Compensation, Effect, EffectParameter, HiddenState, Row

SHORTEST = 1e-6  # s; a faster refill than any rig's is as good as immediate
LEAST = 1e-12  # 1/s; a leak that takes thousands of years is none


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return the pressure of a leaking chamber, exact for p_in constant over h.

    With the rate r = q[j] and the refill time T = q[j + 1] > 0 the valve stays open. Below p_in
    dp/dt = (p_in - p) / T - r p, the first term at most R = q[j + 3], what the valve lets
    through when it is fully open; above it dp/dt = (p_in - p) / V - r p with V = q[j + 4], or at
    once with V = 0, since an exhaust needs no supply. With T = 0 the valve is closed between
    changes of p_in: the chamber follows p_in less what it has lost, dp/dt = -r p, and every
    change of p_in by q[j + 2] gives back all but 1/e of the loss. x[i] is the chamber pressure,
    x[i + 1] the p_in before.
    """
    r = q[j]
    if r < LEAST:
        return p
    if q[j + 1] > 0.0:
        now, left = x[i], h
        if now > p:
            # It vents until it meets p_in, or for all of h.
            if q[j + 4] > SHORTEST:
                out = 1.0 / q[j + 4] + r
                rest = p / q[j + 4] / out
                spent = h if p <= rest else min(h, -log((p - rest) / (now - rest)) / out)
                now = rest + (now - rest) * exp(-spent * out)
                left -= spent
            else:
                now = p
        fill = 1.0 / max(q[j + 1], SHORTEST)
        if left > 0.0 and (p - now) * fill > q[j + 3]:
            # Fully open until the valve begins to close, or for all of the rest.
            slope = q[j + 3] - r * now
            closing = p - q[j + 3] / fill - now
            is_reached = slope > r * closing
            spent = min(left, -log1p(-r * closing / slope) / r) if is_reached else left
            now -= slope * expm1(-r * spent) / r
            left -= spent
        rest = p * fill / (fill + r)
        xn[i] = rest + (now - rest) * exp(-left * (fill + r)) if left > 0.0 else now
    else:
        lost = (x[i + 1] - x[i]) * exp(-abs(p - x[i + 1]) / q[j + 2])
        xn[i] = (p - lost) * exp(-h * r)
    xn[i + 1] = p
    return xn[i]


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the balance of leak and refill, or of a valve that closes what is not lost yet."""
    return ((1.0 - q[j + 5]) * p / (1.0 + q[j] * q[j + 1]), p)


EFFECT = Effect(
    name='leak',
    text='chamber that loses pressure with time',
    source='Isothermal chamber with a laminar leak; refill through the conductance of the valve',
    parameters=(
        EffectParameter(
            'rate',
            0.0,
            'share of the gauge pressure that is lost each second',
            '1/s',
            0.0,
            10.0,
            scale=0.02,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'refill',
            0.0,
            'time constant of refilling; 0: the valve is closed between changes of the command',
            's',
            0.0,
            10.0,
            scale=0.1,
        ),
        EffectParameter(
            'reopening',
            2e3,
            'change of the command that refills a closed chamber but for 1/e',
            'Pa',
            1.0,
            1e5,
            scale=2e3,
        ),
        EffectParameter(
            'supply',
            1e9,
            'fastest change of pressure by refilling, where the valve is fully open',
            'Pa/s',
            1e3,
            1e9,
            scale=1e6,
        ),
        EffectParameter(
            'vent',
            0.0,
            'time constant of venting beside an open valve; 0: at once',
            's',
            0.0,
            10.0,
            scale=0.05,
        ),
        EffectParameter(
            'lost',
            0.0,
            'share of the pressure that is lost already when a run begins',
            '',
            0.0,
            1.0,
            scale=0.05,
        ),
    ),
    signature='pressure that sinks while the command rests, and is back after its next change',
    experiment='long holds at a high pressure with the pressure measured',
    fit_starts=(
        {'rate': 0.003},
        {'rate': 0.03},
        {'rate': 0.03, 'lost': 0.05},
        {'rate': 0.3, 'refill': 0.1},
        {'rate': 0.3, 'refill': 0.1, 'vent': 0.05},
        {'rate': 0.3, 'refill': 0.7, 'vent': 0.05},
        {'rate': 0.3, 'refill': 0.1, 'supply': 5e5},
    ),
    example={'rate': 0.1, 'refill': 0.2},
    compensation=Compensation.FEEDBACK,
    states=(HiddenState('pressure', 'Pa', 2e4), HiddenState('upstream pressure', 'Pa')),
    start=start,
    rivals=('pressure_lag', 'pressure_offset', 'creep', 'softening'),
    contains={'pressure_lag': {'fill': 'refill', 'vent': 'vent', 'fastest': 'supply'}},
    pressure=pressure,
    needs_muscle=True,
)
