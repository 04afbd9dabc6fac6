# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The equation of motion of a joint and its integrator, as templates.

By virtual work, the forces of the muscles accelerate the joint's coordinate s:

    J s'' = sum_i arm_i (F_i - c_i y_i') + outside - J fall(s),    kappa_i = y_i / l0_i

For one muscle on a mass this is equation (3) of Sárosi (2015) with contraction positive (the load
moves up): m y'' = F(p, kappa) - c y' + outside - m g.

These functions are plain scalar Python and can be run without compilation. The names ``*_chain``,
``*_remembers`` and ``*_of`` and the constants at the top are bound to the effects in use and to
the kind of joint by :mod:`pam_ros.rig.bind`, which also compiles them. If they are called unbound,
the joint is one muscle on a mass, without effects. x, xn and q are the matrices of one joint (see
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
from typing import Any

from pam_ros.effects.base import ENOUGH
from pam_ros.muscle.law import damping, force_at, slope_at
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
    JOINT_EFFECTS,
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

PRECISION = 1e-6  # Pa, of the pressure of a reservoir
TURNS = 50  # at most, of the search for it, which needs fewer than ten

Row = Any  # float64 array; numba's and numpy's types differ, both index to float

# Bound to the joint's layout.
MUSCLES = 1
HAS_RESERVOIR = True  # whether an effect that limits the supply of air is in use
HAS_OUTSIDE = True  # whether an effect that acts from outside the muscles is in use
IS_DRAGGED = True  # whether an effect in use is measured by a machine that moves the joint
MEMORY_FROM = 1  # first hidden state of a muscle that is not in its pressure path
WIDTH = 2  # of a state
LOAD, TRANSMISSION = JOINT_EFFECTS, JOINT_EFFECTS + 1  # first indices of their numbers


def delay_chain(q: Row) -> float:
    """Return the delay of the commands in s: 0 without effects."""
    return 0.0


def reservoir_chain(taken: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the pressure of the supply after the chambers took *taken*: enough, without effects.

    x, xn and q are the rows of the joint.
    """
    return ENOUGH


def pressure_chain(p: float, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the chamber pressure at t: the upstream pressure, without effects."""
    return p


def contraction_chain(kappa: float, q: Row) -> float:
    """Return the effective contraction of the muscle, after its effects."""
    return kappa


def mass_chain(m: float, q: Row) -> float:
    """Return the moved mass."""
    return m


def force_chain(
    f: float, p: float, kappa: float, v: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return the muscle's force after its effects."""
    return f


def damping_chain(c: float, p: float, kappa: float, v: float, q: Row) -> float:
    """Return the muscle's damping coefficient after its effects."""
    return c


def outside_chain(
    f: float, p: float, s: float, v: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return the effort on the joint from outside the muscles."""
    return f


def drag_chain(
    f: float, p: float, s: float, v: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return the friction on the joint, without loads, as measured by a machine that moves it."""
    return f


def muscle_remembers(q: Row) -> bool:
    """Return whether a present effect in the muscle has a memory that is not a pressure."""
    return False


def joint_remembers(q: Row) -> bool:
    """Return whether a present effect on the joint has a memory."""
    return False


def travel_of(s: float, i: int, q: Row, j: int) -> float:
    """Return the displacement of the end of muscle i, contraction positive, 0 at s = 0."""
    return s


def arm_of(s: float, i: int, q: Row, j: int) -> float:
    """Return the arm of muscle i: its shortening per unit of the coordinate."""
    return 1.0


def arm_slope_of(s: float, i: int, q: Row, j: int) -> float:
    """Return the derivative of the arm with respect to s."""
    return 0.0


def inertia_of(m: float, q: Row, j: int) -> float:
    """Return the inertia of the coordinate."""
    return m


def fall_of(s: float, m: float, inertia: float, q: Row, j: int) -> float:
    """Return the gravitational acceleration, positive against the coordinate."""
    acceleration: float = q[j]
    return acceleration


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


def taken(limit: float, u: Row, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the rises of the chambers in Pa that a reservoir of *limit* Pa feeds in h seconds.

    A chamber vents into the atmosphere as far as its command tells it to. If the reservoir has
    less, they are connected, and air flows back into it.
    """
    total = 0.0
    for i in range(MUSCLES):
        r = MUSCLE + i
        fed = pressure_chain(min(u[i], limit), t + h, h, x[r], xn[r], q[r])
        alone = fed if u[i] <= limit else pressure_chain(u[i], t + h, h, x[r], xn[r], q[r])
        total += fed - min(x[r, P], alone)
    return total


def supplied(u: Row, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Advance the reservoir by h seconds; return its pressure in Pa in the middle of this step.

    No chamber is filled beyond it. The chambers take the more, the higher it is, and it is the
    lower, the more they take: one pressure fulfils both. First the chambers that fill at once do
    so, and x receives their pressures and that of the reservoir; it is refilled from there on.
    """
    at_once = balanced(u, t, 0.0, x, xn, q)
    if at_once >= ENOUGH:
        return at_once
    for i in range(MUSCLES):
        r = MUSCLE + i
        x[r, P] = pressure_chain(min(u[i], at_once), t, 0.0, x[r], xn[r], q[r])
    for c in range(JOINT_HIDDEN, WIDTH):
        x[JOINT, c] = xn[JOINT, c]
    limit = balanced(u, t, 0.5 * h, x, xn, q)
    total = taken(limit, u, t, h, x, xn, q)
    reservoir_chain(total, h, x[JOINT], xn[JOINT], q[JOINT])
    return limit


def balanced(u: Row, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the pressure of the reservoir after h seconds in which it is the limit.

    By the method of Illinois: a false position whose retained end counts half.
    """
    high = found = reservoir_chain(0.0, h, x[JOINT], xn[JOINT], q[JOINT])
    if high >= ENOUGH:
        return high
    low = above = below = 0.0
    highest = u[0]
    for i in range(1, MUSCLES):
        highest = max(highest, u[i])
    for turn in range(TURNS):
        total = taken(found, u, t, h, x, xn, q)
        left = reservoir_chain(total, h, x[JOINT], xn[JOINT], q[JOINT])
        excess = found - left
        if abs(excess) <= PRECISION:
            return left
        if turn == 0:
            if highest <= min(high, left):
                return left  # what the chambers take does not depend on it
            above, low, found = excess, left, left
            continue
        if turn == 1:
            below = excess
        elif excess * above > 0.0:
            high, above, below = found, excess, 0.5 * below
        else:
            low, below, above = found, excess, 0.5 * above
        found = (low * above - high * below) / (above - below)
    return found


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
