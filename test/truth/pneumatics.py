# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From the pressure command to the pressure that makes force, in closed form over a short time.

P is the record of parameters, S of states (layout.py). All pressures are gauge, in Pa.
"""

from __future__ import annotations

import math

from .compiled import jit
from .layout import ELEMENTS, QUEUE

ATMOSPHERE = 1.013e5
SUPPLY = 8.0e5  # gauge pressure in front of the valve
CRITICAL = 0.3  # pressure ratio below which the flow is choked (ISO 6358)
POLYTROPIC = 1.2
KNEE_WIDTH = 20e3  # Pa over which the gain falls where it saturates
NORMAL = 1.0e5  # ISO 6358 reference pressure, absolute


@jit
def push_command(P, S, u):
    """Send a command at the state's time; it arrives after the dead time."""
    slot = int(S.tail) % QUEUE
    S.queue_t[slot] = S.t + P.dead_time_s
    S.queue_u[slot] = u
    S.tail += 1.0


@jit
def receive(S):
    """Take every command that has arrived (to a nanosecond); a new value opens the valve."""
    while S.head < S.tail and S.queue_t[int(S.head) % QUEUE] <= S.t + 1e-9:
        u = S.queue_u[int(S.head) % QUEUE]
        if u != S.u:
            S.valve_time = S.t
        S.u = u
        S.head += 1.0


@jit
def flow(upstream, downstream):
    """Return upstream pressure times the ISO 6358 flow function (absolute pressures)."""
    ratio = downstream / upstream
    if ratio <= CRITICAL:
        return upstream
    if ratio >= 1.0:
        return 0.0
    # Laminar near equal pressures, where the ellipse would have an infinite slope.
    if ratio > 0.999:
        edge = math.sqrt(1.0 - ((0.999 - CRITICAL) / (1.0 - CRITICAL)) ** 2)
        return upstream * edge * (1.0 - ratio) / 0.001
    return upstream * math.sqrt(1.0 - ((ratio - CRITICAL) / (1.0 - CRITICAL)) ** 2)


@jit
def valve_rate(P, p, target):
    """Rate in Pa/s that a proportional valve of finite conductance gives a chamber."""
    opening = min(1.0, max(-1.0, (target - p) / P.valve_band_pa))
    scale = POLYTROPIC * NORMAL / 1e5 / P.volume_l
    if opening > 0.0:
        return scale * opening * P.conductance_fill * flow(SUPPLY + ATMOSPHERE, p + ATMOSPHERE)
    return scale * opening * P.conductance_vent * flow(p + ATMOSPHERE, ATMOSPHERE)


@jit
def regulated(P, S, t):
    """Return the pressure that the regulator would give at time t."""
    target = S.u * P.regulator_gain + P.regulator_pa - P.overlap_pa
    target = min(max(target, 0.0), 1.0e6, S.supply_pa)
    if P.ripple_pa != 0.0:
        target += P.ripple_pa * math.sin(2.0 * math.pi * P.ripple_hz * t + P.ripple_rad)
    if P.dead_zone_pa != 0.0:
        # The valve opens only while the pressure is further than this from what is wanted.
        target = min(max(S.p, target - P.dead_zone_pa), target + P.dead_zone_pa)
    return target


@jit
def chamber(P, S, t, d):
    """Advance the chamber pressure by d seconds from t; the target keeps its value of mid way."""
    t_mid = t + 0.5 * d
    target = regulated(P, S, t_mid)
    leak = P.leak_per_s
    if P.valve_open_s > 0.0 and t_mid - S.valve_time > P.valve_open_s:
        S.p *= math.exp(-leak * d)  # closed: nothing flows in, the chamber only loses
    elif P.conductance_fill > 0.0:
        mid = S.p + 0.5 * d * (valve_rate(P, S.p, target) - leak * S.p)
        S.p += d * (valve_rate(P, mid, target) - leak * mid)
    else:
        # At the very target the valve holds it against the leak, as it does while it fills.
        tau = P.fill_s if target >= S.p else P.vent_s
        if tau <= 0.0:
            S.p = regulated(P, S, t + d)
        elif P.refill_pa_s > 0.0 and abs(target - S.p) > P.refill_pa_s * tau:
            supply = math.copysign(P.refill_pa_s, target - S.p)
            S.p += (supply - leak * S.p) * -math.expm1(-leak * d) / leak
        else:
            rate = 1.0 / tau + leak
            rest = target / tau / rate
            S.p = rest + (S.p - rest) * math.exp(-rate * d)


@jit
def working_pressure(P, S, d):
    """Return the pressure that makes force, at the middle of a step of d seconds.

    The chamber's, less what slips (hysteresis), what comes late (creep), what saturates and what
    stretches the bladder until it meets the braid.
    """
    p = S.p
    if P.hyst_pa != 0.0:
        dp = p - S.p_mem
        held = 0.0
        for i in range(ELEMENTS):
            reach = S.pslip_reach[i]
            q = min(reach, max(-reach, S.pslip[i] + dp))
            S.pslip[i] = q
            held += q / reach
        p -= P.hyst_pa * held / ELEMENTS
    if P.late_1 != 0.0:
        a = 0.5 * d / P.creep_1_s
        new = ((1.0 - a) * S.plag_1 + 2.0 * a * S.p) / (1.0 + a)
        p -= P.late_1 * (S.p - 0.5 * (S.plag_1 + new))
        S.plag_1 = new
    if P.late_2 != 0.0:
        a = 0.5 * d / P.creep_2_s
        new = ((1.0 - a) * S.plag_2 + 2.0 * a * S.p) / (1.0 + a)
        p -= P.late_2 * (S.p - 0.5 * (S.plag_2 + new))
        S.plag_2 = new
    if P.saturation != 0.0:
        over = S.p - P.knee_pa
        p -= P.saturation * 0.5 * (over + math.sqrt(over * over + KNEE_WIDTH * KNEE_WIDTH))
    if P.bladder_pa != 0.0:
        p = max(p - P.bladder_pa, 0.0)
    return p
