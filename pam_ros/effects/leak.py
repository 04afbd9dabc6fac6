# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Leak: the chamber loses pressure in proportion to it, and the valve gives it back, or not."""

from math import exp, log

from pam_ros.effects.base import Effect, EffectParameter, Row

SHORTEST = 1e-6  # s; a faster refill than any rig's is as good as immediate


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return the pressure of a leaking chamber, exact for p_in constant over h.

    With the rate r = q[j] and the refill time T = q[j + 1] > 0 the valve stays open:
    dp/dt = (p_in - p) / T - r p, the first term between -R and R with R = q[j + 3], what the
    valve lets through when it is fully open. With T = 0 it is closed between changes of p_in:
    the chamber follows p_in less what it has lost, dp/dt = -r p, and every change of p_in by
    q[j + 2] gives back all but 1/e of the loss. x[i] is the chamber pressure, x[i + 1] the p_in
    before.
    """
    r = q[j]
    if r == 0.0:
        return p
    if q[j + 1] > 0.0:
        fill = 1.0 / max(q[j + 1], SHORTEST)
        now = x[i]
        left = h
        if abs(p - now) * fill > q[j + 3]:
            # Fully open until the valve begins to close, or for all of h.
            supply = q[j + 3] if p > now else -q[j + 3]
            ratio = (p - supply / fill - supply / r) / (now - supply / r)
            open_for = min(h, -log(ratio) / r) if 0.0 < ratio < 1.0 else h
            now = supply / r + (now - supply / r) * exp(-r * open_for)
            left -= open_for
        rest = p * fill / (fill + r)
        xn[i] = rest + (now - rest) * exp(-left * (fill + r)) if left > 0.0 else now
    else:
        lost = (x[i + 1] - x[i]) * exp(-abs(p - x[i + 1]) / q[j + 2])
        xn[i] = (p - lost) * exp(-h * r)
    xn[i + 1] = p
    return xn[i]


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the balance of leak and refill, or a chamber freshly filled if the valve closes."""
    return (p / (1.0 + q[j] * q[j + 1]), p)


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
    ),
    signature='pressure that sinks while the command rests, and is back after its next change',
    experiment='long holds at a high pressure with the pressure measured',
    fit_starts=(
        {'rate': 0.003},
        {'rate': 0.03},
        {'rate': 0.3, 'refill': 0.1},
        {'rate': 0.3, 'refill': 0.7},
        {'rate': 0.3, 'refill': 0.1, 'supply': 5e5},
    ),
    states=('pressure', 'upstream pressure'),
    start=start,
    rivals=('pressure_lag', 'pressure_offset', 'creep', 'softening'),
    contains=('pressure_lag',),
    pressure=pressure,
    needs_muscle=True,
)
