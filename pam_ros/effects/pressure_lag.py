# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressure lag: valve, tube and chamber fill and vent with time constants of their own."""

from math import exp, sqrt

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectParameter, HiddenState, Row

SHORTEST = 1e-6  # s; a faster chamber than any rig's is immediate
ATMOSPHERE = 1.013e5  # Pa
CRITICAL = 0.35  # pressure ratio below which a flow is choked; valves have 0.2 to 0.5
P_REFERENCE = 3e5  # Pa, where the times are as given, however much is choked


@scalar
def conductance(upstream: float, downstream: float) -> float:
    """Return the flow from *upstream* to *downstream* (Pa, absolute) relative to a choked one.

    ISO 6358: an ellipse between the critical ratio and equal pressures.
    """
    over = (downstream / upstream - CRITICAL) / (1.0 - CRITICAL)
    if over <= 0.0:
        return upstream
    if over >= 1.0:
        return 0.0
    return upstream * sqrt(1.0 - over * over)


@scalar
def pace(p_in: float, x: float, supply: float, choking: float) -> float:
    """Return how much faster than at 300 kPa a chamber of pressure x fills or vents."""
    now, reference = max(x, 0.0) + ATMOSPHERE, P_REFERENCE + ATMOSPHERE
    if p_in > x:
        source = max(supply, P_REFERENCE + 1.0) + ATMOSPHERE
        share = conductance(source, now) / conductance(source, reference)
    else:
        share = conductance(now, ATMOSPHERE) / conductance(reference, ATMOSPHERE)
    return 1.0 + choking * (share - 1.0)


@scalar
def approached(p_in: float, x: float, h: float, tau: float, fastest: float) -> float:
    """Return the pressure that x becomes in h: at most so fast, in the end with tau."""
    left = abs(p_in - x)
    choked = min(h, max(left - fastest * tau, 0.0) / fastest)
    left -= choked * fastest
    if tau > SHORTEST:
        left *= exp(-(h - choked) / tau)
    elif choked < h:
        left = 0.0
    return p_in - left if p_in > x else p_in + left


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return the chamber pressure of dp/dt = g (p_in - p)/tau, for p_in constant over h.

    tau is q[j] while the chamber fills and q[j + 1] while it vents; x[i] is its pressure. It
    never crosses p_in, so that tau is one or the other for all of h. Neither is faster than
    q[j + 2] and q[j + 3] in Pa/s times g: a valve that is fully open lets no more through.
    g is 1 with q[j + 4] = 0, and the result exact; with 1 the flow is that of ISO 6358 from a
    supply of q[j + 5] Pa and into the atmosphere, relative to that at 300 kPa, g being taken at
    mid way.
    """
    if q[j] == 0.0 and q[j + 1] == 0.0:
        return p
    way = 0 if p > x[i] else 1
    tau, fastest = q[j + way], q[j + 2 + way]
    if q[j + 4] > 0.0:
        g = pace(p, x[i], q[j + 5], q[j + 4])
        g = pace(p, approached(p, x[i], 0.5 * h * g, tau, fastest), q[j + 5], q[j + 4])
        h = h * g
    xn[i] = approached(p, x[i], h, tau, fastest)
    return xn[i]


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the pressure that came in long enough."""
    return (p,)


def lag(q: Row, j: int) -> tuple[float, float]:
    """Return the time constants of filling and venting in s, which a controller inverts."""
    return q[j], q[j + 1]


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
        EffectParameter(
            'choking',
            0.0,
            'how far flows depend on the pressures beside the valve; 1: as an orifice, ISO 6358',
            '',
            0.0,
            1.0,
            scale=0.3,
        ),
        EffectParameter(
            'supply',
            8e5,
            'gauge pressure in front of the valve, which counts with choking',
            'Pa',
            1e5,
            3e6,
            scale=1e5,
        ),
    ),
    signature='phase that rolls off with frequency; rounded answers to steps',
    experiment='steps up and down with the pressure measured, or a chirp',
    fit_starts=(
        {'fill': 0.02, 'vent': 0.02},
        {'fill': 0.1, 'vent': 0.1},
        {'fill': 0.5, 'vent': 0.5},
        {'fill': 0.05, 'vent': 0.05, 'fastest': 5e5},
        {'fill': 0.05, 'vent': 0.05, 'fastest': 5e5, 'fastest_vent': 5e5, 'choking': 0.5},
    ),
    example={'fill': 0.05, 'vent': 0.09},
    compensation=Compensation.PATH,
    states=(HiddenState('pressure', 'Pa', 2e4),),
    start=start,
    rivals=('dead_time', 'leak'),
    pressure=pressure,
    lag=lag,
)
