# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Equations of motion and integrator of joints with several muscles, as templates.

They stand beside those of :mod:`pam_ros.rig.kernel`, whose muscle and integrator they use: the
muscles are what they are there, each with its row, its effects and its hidden states, but one
coordinate moves all of them (see :mod:`pam_ros.rig.joints.base`). A joint has a row a muscle and,
behind these, one for its load: [s, v, mean pressure, hidden states of effects on the load]. For
one muscle on a mass both are the same row, and all is to the bit what the other kernel gives.

The names ``*_of`` choose among the kinds of joint and are bound by :mod:`pam_ros.rig.bind`;
called unbound, all is a mass on one muscle. kind
(joints,) is an index into the joints' list, first and load (joints,) are rows, g (joints, width)
the joints' own numbers. Where a scratch row xn is not taken by hidden states, it holds the
muscle's pressure at the stages of a step: at its start, in the middle, at its end.
"""

from math import exp
from typing import Any

from pam_ros.muscle.law import slope_at
from pam_ros.rig.kernel import (
    coefficient,
    contraction_chain,
    delay_chain,
    mass_chain,
    outside_chain,
    pressure_chain,
    pull,
)
from pam_ros.rig.layout import A1, A2, A3, A4, L0, P, V, Y

Row = Any
START, MIDDLE, END = 0, 1, 2
MEMORY_FROM = 3  # bound with the chains


def position_of(kind: int, s: float, i: int, g: Row) -> float:
    """Return where muscle i is, in m."""
    return s


def arm_of(kind: int, s: float, i: int, g: Row) -> float:
    """Return how fast muscle i shortens with the coordinate."""
    return 1.0


def inertia_of(kind: int, m: float, g: Row) -> float:
    """Return what resists the coordinate's acceleration."""
    return m


def fall_of(kind: int, s: float, m: float, j: float, g: Row) -> float:
    """Return the acceleration against the coordinate that gravity alone gives."""
    acceleration: float = g[1]
    return acceleration


def share(arm: float, j: float, n: int) -> float:
    """Return the mass in kg that each of n muscles moves: the m of equation (4).

    Along its line a muscle feels j / arm^2, and it shares that with the others: a joint of
    equal muscles so has their damping ratio zeta.
    """
    return j / (n * arm * arm)


def joint_acceleration(
    s: float,
    v: float,
    stage: int,
    t: float,
    h: float,
    m: float,
    j: float,
    kind: int,
    first: int,
    n: int,
    load: int,
    x: Row,
    xn: Row,
    q: Row,
    g: Row,
) -> float:
    """Return s'' of a joint with the moved mass m, the inertia j and n muscles from row first."""
    f, p = 0.0, 0.0
    for i in range(n):
        r = first + i
        arm, y = arm_of(kind, s, i, g), position_of(kind, s, i, g)
        w, at_muscle = arm * v, xn[r, stage]
        force = pull(y, w, at_muscle, t, h, x[r], xn[r], q[r])
        f += arm * (force - coefficient(y, w, at_muscle, share(arm, j, n), q[r]) * w)
        p += at_muscle
    f += outside_chain(0.0, p / n, s, v, t, h, x[load], xn[load], q[load])
    net: float = f * (1.0 / j) - fall_of(kind, s, m, j, g)
    return net


def joint_step(
    x: Row,
    xn: Row,
    q: Row,
    g: Row,
    u: Row,
    kind: int,
    first: int,
    n: int,
    load: int,
    t: float,
    h: float,
) -> None:
    """Advance one joint from t by h seconds with its pressure commands u held, in place.

    Nyström's scheme as in ``kernel.step``.
    """
    s, v = x[load, Y], x[load, V]
    half, sixth = 0.5 * h, h / 6.0
    m = mass_chain(g[0], q[load])
    j = inertia_of(kind, m, g)
    for r in range(first, first + n):
        p0 = pressure_chain(u[r], t, 0.0, x[r], xn[r], q[r])
        p1 = pressure_chain(u[r], t + half, half, x[r], xn[r], q[r])
        p2 = pressure_chain(u[r], t + h, half, xn[r], x[r], q[r])
        xn[r, START], xn[r, MIDDLE], xn[r, END] = p0, p1, p2
    a1 = joint_acceleration(s, v, START, t, 0.0, m, j, kind, first, n, load, x, xn, q, g)
    mid, tm = s + half * v + 0.5 * half * half * a1, t + half
    vm = v + half * a1
    a2 = joint_acceleration(mid, vm, MIDDLE, tm, half, m, j, kind, first, n, load, x, xn, q, g)
    vm = v + half * a2
    a3 = joint_acceleration(mid, vm, MIDDLE, tm, half, m, j, kind, first, n, load, x, xn, q, g)
    end, te = s + h * v + 0.5 * h * h * a3, t + h
    ve = v + h * a3
    a4 = joint_acceleration(end, ve, END, te, h, m, j, kind, first, n, load, x, xn, q, g)
    s = s + h * v + h * sixth * (a1 + a2 + a3)
    v = v + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    if x.shape[1] > MEMORY_FROM:
        # Once more at the end that was reached: what the memories have become there.
        joint_acceleration(s, v, END, te, h, m, j, kind, first, n, load, x, xn, q, g)
        for r in range(first, load + 1):
            for i in range(MEMORY_FROM, x.shape[1]):
                x[r, i] = xn[r, i]
    mean = 0.0
    for i in range(n):
        r = first + i
        x[r, Y] = position_of(kind, s, i, g)
        x[r, V] = arm_of(kind, s, i, g) * v
        x[r, P] = xn[r, END]
        mean += xn[r, END]
    x[load, Y], x[load, V], x[load, P] = s, v, mean / n


def advance_joints(
    x: Row,
    xn: Row,
    q: Row,
    g: Row,
    u: Row,
    at: Row,
    queue: Row,
    count: Row,
    done: Row,
    kind: Row,
    first: Row,
    load: Row,
    k: int,
    steps: int,
    h: float,
) -> None:
    """Advance every joint by a counted number of steps of exactly h seconds, in place.

    As ``kernel.advance``, with u, at, queue and count by row; done (rows,) is scratch.
    """
    for a in range(kind.shape[0]):
        n = max(load[a] - first[a], 1)
        for r in range(first[a], load[a] + 1):
            done[r] = 0
            for i in range(x.shape[1]):
                xn[r, i] = x[r, i]
        for i in range(k, k + steps):
            t = i * h
            for r in range(first[a], first[a] + n):
                delay = delay_chain(q[r])
                while done[r] < count[r] and at[r, done[r]] + delay <= t + 1e-6 * h:
                    u[r] = queue[r, done[r]]
                    done[r] += 1
            joint_step(x, xn, q, g[a], u, kind[a], first[a], n, load[a], t, h)
        for r in range(first[a], first[a] + n):
            for i in range(done[r], count[r]):
                at[r, i - done[r]] = at[r, i]
                queue[r, i - done[r]] = queue[r, i]
            count[r] -= done[r]


def outputs_of_joints(
    x: Row,
    xn: Row,
    q: Row,
    g: Row,
    kind: Row,
    first: Row,
    load: Row,
    t: float,
    out: Row,
    joint_out: Row,
) -> None:
    """Fill out by row and joint_out by joint with what ``Rig.outputs`` and so on return."""
    for a in range(kind.shape[0]):
        n = max(load[a] - first[a], 1)
        s, v = x[load[a], Y], x[load[a], V]
        m = mass_chain(g[a, 0], q[load[a]])
        j = inertia_of(kind[a], m, g[a])
        effort, stiffness = 0.0, 0.0
        for i in range(n):
            r = first[a] + i
            p = x[r, P]
            xn[r, START] = p
            arm, y = arm_of(kind[a], s, i, g[a]), position_of(kind[a], s, i, g[a])
            w = arm * v
            kappa = contraction_chain(y * (1.0 / q[r, L0]), q[r])
            e = exp(q[r, A3] * kappa)
            out[r, 0] = pull(y, w, p, t, 0.0, x[r], xn[r], q[r])
            out[r, 1] = -slope_at(e, p, q[r, A1], q[r, A2], q[r, A3], q[r, A4]) / q[r, L0]
            out[r, 2] = coefficient(y, w, p, share(arm, j, n), q[r])
            effort += arm * out[r, 0]
            stiffness += arm * arm * out[r, 1]
        acceleration = joint_acceleration(
            s, v, START, t, 0.0, m, j, kind[a], first[a], n, load[a], x, xn, q, g[a]
        )
        for i in range(n):
            out[first[a] + i, 3] = arm_of(kind[a], s, i, g[a]) * acceleration
        joint_out[a, 0], joint_out[a, 1], joint_out[a, 2] = effort, stiffness, acceleration
