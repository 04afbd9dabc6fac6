# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The truth plant's integrator: symmetric splitting, second order, one force a substep.

A substep of d seconds drifts the position and the chamber by d/2, kicks the speed with the
forces of mid step (implicit midpoint in the speed, by fixed point), and drifts by d/2 again:
position Verlet with the dissipative parts solved implicitly. Memory elements follow the path
exactly. P is the record of parameters, S of states (layout.py).
"""

from __future__ import annotations

import math

from .compiled import jit
from .forces import bend_bristle, creep, damping, friction, gain, law, memory, rig_force, tendon
from .pneumatics import chamber, push_command, receive, working_pressure


@jit
def substep(P, S, force_out, d):
    """Advance all states by d seconds; force_out is a force on the load from outside, N."""
    t_mid = S.t + 0.5 * d
    mass = P.mass_kg + P.payload_kg
    receive(S)
    chamber(P, S, S.t, 0.5 * d)
    S.y += 0.5 * d * S.v
    S.second += 0.5 * d * S.second_v
    if P.bristle_n_m > 0.0:
        bend_bristle(P, S, S.v, 0.5 * d)

    p = working_pressure(P, S, d)
    kappa = S.y / P.l0_m + P.kappa_offset
    static, slope = law(P, p, kappa)
    factor = gain(P, S, t_mid)
    static = static * factor + P.cross_n_pa * kappa * kappa * p
    static = creep(P, S, static, d) - memory(P, S, d)
    second_k = P.second_kg * (2.0 * math.pi * P.second_hz) ** 2
    second_c = 4.0 * math.pi * P.second_hz * P.second_zeta * P.second_kg

    v = S.v
    second_v = S.second_v
    pull = 0.0
    for _ in range(3):
        pull = tendon(P, static - damping(P, mass, p, slope * factor, v) * v)
        if P.held != 0.0:
            break
        force = pull - friction(P, S, v) + rig_force(P, S.y, v, t_mid) - mass * P.gravity
        coupling = second_k * S.second + second_c * second_v
        a = (force + force_out + coupling) / (mass - P.second_kg)
        v = S.v + 0.5 * d * a
        if P.second_kg > 0.0:
            second_v = S.second_v + 0.5 * d * (-coupling / P.second_kg - a)

    if P.soft_share != 0.0:
        if P.soft_work_j > 0.0:
            S.wear += abs(pull * v) * d / P.soft_work_j
        if P.soft_path_pa > 0.0:
            S.wear += abs(S.p - S.p_mem) / P.soft_path_pa
    S.y_mem = S.y
    S.p_mem = S.p
    S.pull = pull
    S.v = 2.0 * v - S.v
    S.second_v = 2.0 * second_v - S.second_v

    if P.bristle_n_m > 0.0:
        bend_bristle(P, S, S.v, 0.5 * d)
    S.second += 0.5 * d * S.second_v
    S.y += 0.5 * d * S.v
    chamber(P, S, t_mid, 0.5 * d)
    S.link = min(S.y + P.play_m, max(S.y - P.play_m, S.link))
    S.t += d


@jit
def advance(P, S, u, force_out, h):
    """Hold a command (Pa) for h seconds, in equal substeps no longer than P.dt."""
    start = S.t
    push_command(P, S, u)
    count = max(1, math.ceil(h / P.dt - 1e-6))
    d = h / count
    for _ in range(count):
        substep(P, S, force_out, d)
    S.t = start + h


@jit
def hold(parameters, states, u, force_out, h):
    """Advance; return the time and the position of the sensor's linkage."""
    advance(parameters[0], states[0], u, force_out, h)
    return states[0].t, states[0].link


@jit
def run(parameters, states, t, u, force_out, y_path, out):
    """Play a programme; row k of out is y, v, pull, p, linked y at t[k], before u[k] acts.

    A held run (P.held) moves along y_path, else y_path is not looked at.
    """
    P, S = parameters[0], states[0]
    for k in range(t.size):
        out[k, 0] = S.y
        out[k, 1] = S.v
        out[k, 2] = S.pull
        out[k, 3] = S.p
        out[k, 4] = S.link
        if k + 1 < t.size:
            h = t[k + 1] - t[k]
            if P.held != 0.0:
                S.v = (y_path[k + 1] - y_path[k]) / h
            advance(P, S, u[k], force_out[k], h)
