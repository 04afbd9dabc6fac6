# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressure lag: valve, tube and chamber fill and vent with time constants of their own."""

from math import exp

from pam_ros.effects.base import Effect, EffectParameter, Row

SHORTEST = 1e-6  # s; a faster chamber than any rig's is immediate


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return the chamber pressure of dp/dt = (p_in - p)/tau, exact for p_in constant over h.

    tau is q[j] while the chamber fills and q[j + 1] while it vents; x[i] is its pressure. It
    never crosses p_in, so that tau is one or the other for all of h. Neither is faster than
    q[j + 2] and q[j + 3] in Pa/s: a valve that is fully open, or choked, lets no more through.
    """
    if q[j] == 0.0 and q[j + 1] == 0.0:
        return p
    way = 0 if p > x[i] else 1
    tau = q[j + way]
    fastest = q[j + 2 + way]
    left = abs(p - x[i])
    choked = min(h, max(left - fastest * tau, 0.0) / fastest)
    left -= choked * fastest
    if tau > SHORTEST:
        left *= exp(-(h - choked) / tau)
    elif choked < h:
        left = 0.0
    xn[i] = p - left if p > x[i] else p + left
    return xn[i]


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the pressure that came in long enough."""
    return (p,)


EFFECT = Effect(
    name='pressure_lag',
    text='first-order lag of the chamber behind the command, filling and venting apart',
    source='ISO 6358 orifice, linear below choking; 20 to 130 ms with servo valves',
    parameters=(
        EffectParameter(
            'fill',
            0.0,
            'time constant of filling',
            's',
            0.0,
            10.0,
            scale=0.05,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'vent',
            0.0,
            'time constant of venting',
            's',
            0.0,
            10.0,
            scale=0.05,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'fastest',
            1e9,
            'fastest rise of pressure, where the valve is fully open or choked',
            'Pa/s',
            1e3,
            1e9,
            scale=1e6,
        ),
        EffectParameter(
            'fastest_vent',
            1e9,
            'fastest fall of pressure, likewise',
            'Pa/s',
            1e3,
            1e9,
            scale=1e6,
        ),
    ),
    signature='phase that rolls off with frequency; rounded answers to steps',
    experiment='steps up and down with the pressure measured, or a chirp',
    fit_starts=(
        {'fill': 0.02, 'vent': 0.02},
        {'fill': 0.1, 'vent': 0.1},
        {'fill': 0.5, 'vent': 0.5},
        {'fill': 0.05, 'vent': 0.05, 'fastest': 5e5},
        {'fill': 0.05, 'vent': 0.05, 'fastest': 5e5, 'fastest_vent': 5e5},
    ),
    states=('pressure',),
    start=start,
    rivals=('dead_time', 'leak'),
    pressure=pressure,
)
