# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The equation of motion of a joint and its integrator, as templates.

By virtual work, the forces of the muscles accelerate the joint's coordinate s:

    J s'' = sum_i arm_i (F_i - c_i y_i') + outside - J fall(s),    kappa_i = y_i / l0_i

For one muscle on a mass this is equation (3) of Sárosi (2015) with contraction positive (the load
moves up): m y'' = F(p, kappa) - c y' + outside - m g.

These functions are plain scalar Python and can be run without compilation. The names that they
import from :mod:`pam_ros.rig.unbound` are bound to the effects in use and to the kind of joint by
:mod:`pam_ros.rig.bind`, which also compiles them. If they are called unbound, the joint is one
muscle on a mass, without effects. x, xn and q are the matrices of one joint (see
:mod:`pam_ros.rig.layout`). With the form ``* (1.0 / m)`` a division is done once per step and not
at every stage.

Integrator: Nyström's fourth-order scheme for second-order equations with a fixed step (Hairer,
Nørsett & Wanner, Solving Ordinary Differential Equations I, section II.14). It is the classical
Runge-Kutta scheme with better positions inside the step. This halves the error. Both middle
stages have the same position, so that the exponential there is computed once. A step of 1 ms
resolves a period of the muscle's 4 Hz with 250 steps: an explicit scheme is stable, and its error
(below 1e-9 m) is far below that of any sensor. Effects with stiff memory have their own exact or
implicit update.
"""

from math import exp

from pam_ros.effects.base import ENOUGH
from pam_ros.muscle.law import damping, force_at, slope_at
from pam_ros.rig.filling import supplied
from pam_ros.rig.layout import (
    A1,
    A2,
    A3,
    A4,
    A5,
    A6,
    AT_ZERO,
    CONTRACTION,
    END,
    JOINT,
    JOINT_HIDDEN,
    L0,
    MASS,
    MIDDLE,
    MUSCLE,
    START,
    ZETA,
    P,
    S,
    V,
)
from pam_ros.rig.unbound import (
    HAS_OUTSIDE,
    HAS_RESERVOIR,
    LOAD,
    MEMORY_FROM,
    MUSCLES,
    TRANSMISSION,
    WIDTH,
    Row,
    arm_of,
    arm_slope_of,
    contraction_chain,
    damping_chain,
    delay_chain,
    fall_of,
    force_chain,
    inertia_of,
    joint_remembers,
    mass_chain,
    muscle_remembers,
    outside_chain,
    pressure_chain,
    travel_of,
)


def effective_contraction(s: float, i: int, q: Row) -> float:
    """Return the effective contraction of muscle i at the coordinate s."""
    y = q[MUSCLE + i, AT_ZERO] + travel_of(s, i, q[JOINT], TRANSMISSION)
    kappa: float = contraction_chain(y * (1.0 / q[MUSCLE + i, L0]), q[MUSCLE + i])
    return kappa


def share(arm: float, inertia: float) -> float:
    """Return the mass in kg that each muscle moves: the m of equation (4).

    Along the line of a muscle, J acts as the mass J / arm^2, which all muscles share equally. So
    a joint of equal muscles has their damping ratio zeta.
    """
    return inertia / (MUSCLES * arm * arm)


def pull(
    kappa: float, e: float, v: float, p: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return a muscle's force in N, effects included, h seconds after its state x.

    x, xn and q are the rows of the muscle; e = exp(a3 kappa).
    """
    f = force_at(e, p, kappa, q[A1], q[A2], q[A4], q[A5], q[A6])
    return force_chain(f, p, kappa, v, t, h, x, xn, q)


def coefficient(kappa: float, e: float, v: float, p: float, m: float, q: Row) -> float:
    """Return a muscle's damping coefficient c in N s/m: equation (4), effects included."""
    k = -slope_at(e, p, q[A1], q[A2], q[A3], q[A4]) * (1.0 / q[L0])
    return damping_chain(damping(k, m, q[ZETA]), p, kappa, v, q)


def net_force(
    s: float,
    v: float,
    i: int,
    p: float,
    t: float,
    h: float,
    inertia: float,
    x: Row,
    xn: Row,
    q: Row,
) -> float:
    """Return the force of muscle i at *p* Pa minus its damping, in N: the force at its end."""
    r = MUSCLE + i
    arm = arm_of(s, i, q[JOINT], TRANSMISSION)
    w = arm * v
    kappa = effective_contraction(s, i, q)
    e = exp(q[r, A3] * kappa)
    force = pull(kappa, e, w, p, t, h, x[r], xn[r], q[r])
    return force - coefficient(kappa, e, w, p, share(arm, inertia), q[r]) * w


def acceleration(
    s: float,
    v: float,
    stage: int,
    t: float,
    h: float,
    m: float,
    inertia: float,
    x: Row,
    xn: Row,
    q: Row,
) -> float:
    """Return s'' for the moved mass m; *stage* selects one of the stored pressures."""
    mean = xn[MUSCLE, WIDTH + stage]
    arm = arm_of(s, 0, q[JOINT], TRANSMISSION)
    f = arm * net_force(s, v, 0, mean, t, h, inertia, x, xn, q)
    for i in range(1, MUSCLES):
        p = xn[MUSCLE + i, WIDTH + stage]
        arm = arm_of(s, i, q[JOINT], TRANSMISSION)
        f += arm * net_force(s, v, i, p, t, h, inertia, x, xn, q)
        mean += p
    if HAS_OUTSIDE:  # otherwise not even a sum with 0, which would delay each stage
        f += outside_chain(0.0, mean / MUSCLES, s, v, t, h, x[JOINT], xn[JOINT], q[JOINT])
    net: float = f * (1.0 / inertia) - fall_of(s, m, inertia, q[JOINT], LOAD)
    return net


def remembers(q: Row) -> bool:
    """Return whether any present effect has a memory that is not a pressure."""
    any_of_them: bool = joint_remembers(q[JOINT])
    for i in range(MUSCLES):
        any_of_them = any_of_them or muscle_remembers(q[MUSCLE + i])
    return any_of_them


def keep_memories(x: Row, xn: Row) -> None:
    """Copy the new values of hidden states that are not pressures from xn to x."""
    for c in range(JOINT_HIDDEN, WIDTH):
        x[JOINT, c] = xn[JOINT, c]
    for r in range(MUSCLE, MUSCLE + MUSCLES):
        for c in range(MEMORY_FROM, WIDTH):
            x[r, c] = xn[r, c]


def begin(x: Row, xn: Row) -> None:
    """Copy the state to the scratch matrix."""
    for r in range(MUSCLE + MUSCLES):
        for c in range(WIDTH):
            xn[r, c] = x[r, c]


def step(x: Row, xn: Row, q: Row, u: Row, t: float, h: float) -> None:
    """Advance the state x from t by h seconds with constant pressure commands u, in place."""
    s, v = x[JOINT, S], x[JOINT, V]
    half, sixth = 0.5 * h, h / 6.0
    m = mass_chain(q[JOINT, MASS], q[JOINT])
    inertia = inertia_of(m, q[JOINT], LOAD)
    limit = ENOUGH
    if HAS_RESERVOIR:
        limit = supplied(u, t, h, x, xn, q)
    for i in range(MUSCLES):
        r = MUSCLE + i
        p_in = min(u[i], limit)
        p0 = pressure_chain(p_in, t, 0.0, x[r], xn[r], q[r])
        p1 = pressure_chain(p_in, t + half, half, x[r], xn[r], q[r])
        p2 = pressure_chain(p_in, t + h, half, xn[r], x[r], q[r])
        xn[r, WIDTH + START], xn[r, WIDTH + MIDDLE], xn[r, WIDTH + END] = p0, p1, p2
    a1 = acceleration(s, v, START, t, 0.0, m, inertia, x, xn, q)
    middle = s + half * v + 0.5 * half * half * a1
    a2 = acceleration(middle, v + half * a1, MIDDLE, t + half, half, m, inertia, x, xn, q)
    a3 = acceleration(middle, v + half * a2, MIDDLE, t + half, half, m, inertia, x, xn, q)
    end = s + h * v + 0.5 * h * h * a3
    a4 = acceleration(end, v + h * a3, END, t + h, h, m, inertia, x, xn, q)
    s = s + h * v + h * sixth * (a1 + a2 + a3)
    v = v + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    x[JOINT, S], x[JOINT, V] = s, v
    for r in range(MUSCLE, MUSCLE + MUSCLES):
        x[r, P] = xn[r, WIDTH + END]
    if remembers(q):
        # Evaluate once more at the end of the step, for the new values of the memories.
        acceleration(s, v, END, t + h, h, m, inertia, x, xn, q)
        keep_memories(x, xn)


def advance(
    x: Row,
    xn: Row,
    q: Row,
    u: Row,
    at: Row,
    queue: Row,
    count: Row,
    done: Row,
    k: int,
    steps: int,
    h: float,
) -> None:
    """Advance every joint by *steps* steps of exactly h seconds, in place.

    x, xn, q: one matrix for each joint. u (joints, muscles): commands that act now. at, queue
    (joints, muscles, room): stamps and values of later commands, in order; the first count[a, i]
    of them are valid, and those that have begun to act are removed. done (joints, muscles) is
    scratch. A command acts from the first step that starts at or after its stamp plus the delay of
    the pressure path. Steps are numbered from k: time is k h, never a sum.
    """
    for a in range(x.shape[0]):
        begin(x[a], xn[a])
        for i in range(MUSCLES):
            done[a, i] = 0
        n = k
        while n < k + steps:
            end = k + steps
            for i in range(MUSCLES):
                late = delay_chain(q[a, MUSCLE + i])
                while done[a, i] < count[a, i] and at[a, i, done[a, i]] + late <= n * h + 1e-6 * h:
                    u[a, i] = queue[a, i, done[a, i]]
                    done[a, i] += 1
                if done[a, i] < count[a, i]:
                    end = n + 1  # a command waits: check again after the next step
            for now in range(n, end):
                step(x[a], xn[a], q[a], u[a], now * h, h)
            n = end
        for i in range(MUSCLES):
            for n in range(done[a, i], count[a, i]):
                at[a, i, n - done[a, i]] = at[a, i, n]
                queue[a, i, n - done[a, i]] = queue[a, i, n]
            count[a, i] -= done[a, i]


def outputs(x: Row, xn: Row, q: Row, t: float, out: Row, joint_out: Row) -> None:
    """Fill *out* for each joint and muscle, and *joint_out* for each joint.

    out (joints, muscles, OUTPUTS): force N, stiffness N/m, damping N s/m, acceleration m/s^2 of
    the muscle's end, and contraction as a fraction of the length at rest, which effects do not
    change. The stiffness is -dF/dkappa / l0 of the force law (2) at the effective contraction.
    joint_out (joints, JOINT_OUTPUTS): effort, stiffness and acceleration of the coordinate.
    """
    for a in range(x.shape[0]):
        s, v = x[a, JOINT, S], x[a, JOINT, V]
        m = mass_chain(q[a, JOINT, MASS], q[a, JOINT])
        inertia = inertia_of(m, q[a, JOINT], LOAD)
        total, stiffness = 0.0, 0.0
        for i in range(MUSCLES):
            r = MUSCLE + i
            p = x[a, r, P]
            xn[a, r, WIDTH + START] = p
            arm = arm_of(s, i, q[a, JOINT], TRANSMISSION)
            w = arm * v
            kappa = effective_contraction(s, i, q[a])
            e = exp(q[a, r, A3] * kappa)
            force = pull(kappa, e, w, p, t, 0.0, x[a, r], xn[a, r], q[a, r])
            slope = slope_at(e, p, q[a, r, A1], q[a, r, A2], q[a, r, A3], q[a, r, A4])
            k = -slope / q[a, r, L0]
            out[a, i, 0], out[a, i, 1] = force, k
            out[a, i, 2] = coefficient(kappa, e, w, p, share(arm, inertia), q[a, r])
            y = q[a, r, AT_ZERO] + travel_of(s, i, q[a, JOINT], TRANSMISSION)
            out[a, i, CONTRACTION] = y / q[a, r, L0]
            total += arm * force
            turn = arm_slope_of(s, i, q[a, JOINT], TRANSMISSION) * force
            stiffness += arm * arm * k - turn
        net = acceleration(s, v, START, t, 0.0, m, inertia, x[a], xn[a], q[a])
        for i in range(MUSCLES):
            bend = arm_slope_of(s, i, q[a, JOINT], TRANSMISSION) * v * v
            out[a, i, 3] = arm_of(s, i, q[a, JOINT], TRANSMISSION) * net + bend
        joint_out[a, 0], joint_out[a, 1], joint_out[a, 2] = total, stiffness, net
