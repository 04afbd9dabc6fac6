# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Forces on the load: the muscle's pull (upwards, N) and what the guide and the rig add.

P is the record of parameters, S of states (layout.py).
"""

from __future__ import annotations

import math

from .compiled import jit
from .layout import ELEMENTS


@jit
def law(P, p, kappa):
    """Return the static force in N and its slope over kappa (Sarosi 2015, equations 1 and 2)."""
    grown = (P.a1 * p + P.a2) * math.exp(P.a3 * kappa)
    force = grown + P.a4 * kappa * p + P.a5 * p + P.a6
    return force, grown * P.a3 + P.a4 * p


@jit
def tendon(P, pull):
    """Pull that reaches the load: all of it, none below zero, or a parabola within the toe."""
    if P.slack == 0.0:
        return pull
    if pull >= P.toe_n:
        return pull
    if pull <= -P.toe_n:
        return 0.0
    return (pull + P.toe_n) ** 2 / (4.0 * P.toe_n)


@jit
def gain(P, S, t):
    """Factor on the static force: softening with wear, and a drift in time."""
    factor = 1.0
    if P.soft_share != 0.0:
        factor += P.soft_share * math.expm1(-S.wear)
    if P.drift_share != 0.0:
        factor += P.drift_share * math.tanh((t - P.drift_mid_s) / P.drift_width_s)
    return factor


@jit
def creep(P, S, force, d):
    """Force less two shares that follow late (trapezoidal over d); its value at mid step."""
    out = force
    if P.creep_1 != 0.0:
        a = 0.5 * d / P.creep_1_s
        new = ((1.0 - a) * S.lag_1 + 2.0 * a * force) / (1.0 + a)
        out -= P.creep_1 * (force - 0.5 * (S.lag_1 + new))
        S.lag_1 = new
    if P.creep_2 != 0.0:
        a = 0.5 * d / P.creep_2_s
        new = ((1.0 - a) * S.lag_2 + 2.0 * a * force) / (1.0 + a)
        out -= P.creep_2 * (force - 0.5 * (S.lag_2 + new))
        S.lag_2 = new
    return out


@jit
def memory(P, S, d):
    """Force in N by which the muscle's wall resists: Maxwell slip, Maxwell creep branches."""
    resist = 0.0
    if P.hyst_n != 0.0:
        dy = S.y - S.y_mem
        for i in range(ELEMENTS):
            reach = S.slip_reach[i]
            q = min(reach, max(-reach, S.slip[i] + dy))
            S.slip[i] = q
            resist += q / reach
        resist *= P.hyst_n / ELEMENTS
    if P.maxwell_1_n_m != 0.0:
        a = 0.5 * d / P.creep_1_s
        new = ((1.0 - a) * S.strain_1 + 2.0 * a * S.y) / (1.0 + a)
        resist += P.maxwell_1_n_m * (S.y - 0.5 * (S.strain_1 + new))
        S.strain_1 = new
    if P.maxwell_2_n_m != 0.0:
        a = 0.5 * d / P.creep_2_s
        new = ((1.0 - a) * S.strain_2 + 2.0 * a * S.y) / (1.0 + a)
        resist += P.maxwell_2_n_m * (S.y - 0.5 * (S.strain_2 + new))
        S.strain_2 = new
    return resist


@jit
def damping(P, mass, p, slope, v):
    """Muscle's damping coefficient in N s/m: equation 4 with the stiffness -slope / l0."""
    stiffness = max(-slope / P.l0_m, 0.0)
    c = 2.0 * P.zeta * math.sqrt(mass * stiffness)
    if v > 0.0:
        return c + P.damping_up_ns_m_bar * p * 1e-5
    return c + P.damping_down_ns_m_bar * p * 1e-5


@jit
def stribeck(P, v):
    """Level g(v) in N of the bristles: static force at rest, Coulomb's when sliding."""
    return P.coulomb_n + (P.static_n - P.coulomb_n) * math.exp(-((v / P.stribeck_m_s) ** 2))


@jit
def bend_bristle(P, S, v, d):
    """Advance the bristle over d at constant speed, in closed form (LuGre, Canudas 1995)."""
    if v != 0.0:
        limit = math.copysign(stribeck(P, v) / P.bristle_n_m, v)
        S.bristle = limit + (S.bristle - limit) * math.exp(-abs(v / limit) * d)


@jit
def friction(P, S, v):
    """Force in N by which the guide resists at speed v: LuGre and viscous."""
    resist = P.viscous_ns_m * v
    if P.bristle_n_m > 0.0:
        rate = v - abs(v) * S.bristle * P.bristle_n_m / stribeck(P, v)
        resist += P.bristle_n_m * S.bristle + P.bristle_ns_m * rate
    return resist


@jit
def rig_force(P, y, v, t):
    """Force in N, upwards, of the rig: end stop (Hunt, Crossley 1975), cogging, drag, ripple."""
    force = 0.0
    if P.stop_n_m15 > 0.0 and y > P.stop_m:
        force -= P.stop_n_m15 * (y - P.stop_m) ** 1.5 * max(0.0, 1.0 + P.stop_s_m * v)
    if P.cog_n != 0.0:
        force += P.cog_n * math.sin(2.0 * math.pi * y / P.cog_m)
    if P.drag_ns2_m2 != 0.0:
        force -= P.drag_ns2_m2 * abs(v) * v
    if P.ripple_n != 0.0:
        force += P.ripple_n * math.sin(2.0 * math.pi * P.ripple_hz * t + P.ripple_rad)
    return force
