# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The rig's equations of motion and their integrator, as templates.

The ODE is equation (3) of Sárosi (2015) with contraction positive (the load moves up):

    m y'' = F(p, kappa) - c y' + f_outside - m g,    kappa = y / l0

These functions are plain scalar Python and run as they stand. The names ``*_chain`` and
``remembers`` are bound to the effects in use by :mod:`pam_ros.rig.bind`, which also compiles
them; called unbound, the rig is the paper's, without effects. x is a state row, q a parameter row
(see ``layout``), xn a scratch row of the same width as x. Written ``* (1.0 / m)``, a division is
done once a step and not at every stage.

Integrator: Nyström's fourth-order scheme for second-order equations with a fixed step (Hairer,
Nørsett & Wanner, Solving Ordinary Differential Equations I, section II.14). It is the classical
Runge-Kutta scheme with better positions inside the step: half the error, and both stages in the
middle are at one place, so that the exponential there is computed once. At 1 ms the muscle's
4 Hz are resolved 250-fold: an explicit scheme is stable, and its error (below 1e-9 m) far below
that of any sensor. Effects with stiff memory bring their own exact or implicit update.
"""

from math import ceil, exp
from typing import Any

from pam_ros.muscle.law import damping, force_at, slope_at
from pam_ros.rig.layout import A1, A2, A3, A4, A5, A6, GRAVITY, HIDDEN, L0, MASS, ZETA, P, V, Y

Row = Any  # float64 row; numba's and numpy's types differ, both index to float


def delay_chain(q: Row) -> float:
    """Return by how many seconds commands act late: 0 without effects."""
    return 0.0


def pressure_chain(p: float, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the chamber pressure at t: the upstream pressure, without effects."""
    return p


def contraction_chain(kappa: float, q: Row) -> float:
    """Return the contraction that the muscle feels."""
    return kappa


def mass_chain(m: float, q: Row) -> float:
    """Return the moved mass."""
    return m


def force_chain(
    f: float, p: float, kappa: float, v: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return the muscle's pull after its effects."""
    return f


def damping_chain(c: float, p: float, kappa: float, v: float, q: Row) -> float:
    """Return the muscle's damping coefficient after its effects."""
    return c


def outside_chain(
    f: float, p: float, y: float, v: float, t: float, h: float, x: Row, xn: Row, q: Row
) -> float:
    """Return the force on the load from outside the muscle."""
    return f


def remembers(q: Row) -> bool:
    """Return whether an effect that is present has a memory that is no pressure."""
    return False


MEMORY_FROM = 3  # bound with the chains


def in_force(at: Row, delay: float, i: int, now: float) -> int:
    """Return the index of the command that acts at *now*, i or a later one: at are its stamps."""
    while i + 1 < at.shape[0] and at[i + 1] + delay <= now + 1e-9:
        i += 1
    return i


def held_until(at: Row, delay: float, i: int, end: float) -> float:
    """Return when command i ceases to act, *end* at the latest."""
    if i + 1 < at.shape[0] and at[i + 1] + delay < end - 1e-9:
        held: float = at[i + 1] + delay
        return held
    return end


def pull(y: float, v: float, p: float, t: float, h: float, x: Row, xn: Row, q: Row) -> float:
    """Return the muscle's force in N, effects included, h seconds after the state x."""
    kappa = contraction_chain(y * (1.0 / q[L0]), q)
    f = force_at(exp(q[A3] * kappa), p, kappa, q[A1], q[A2], q[A4], q[A5], q[A6])
    return force_chain(f, p, kappa, v, t, h, x, xn, q)


def coefficient(y: float, v: float, p: float, m: float, q: Row) -> float:
    """Return the muscle's damping coefficient c in N s/m: equation (4), effects included."""
    kappa = contraction_chain(y * (1.0 / q[L0]), q)
    k = -slope_at(exp(q[A3] * kappa), p, q[A1], q[A2], q[A3], q[A4]) * (1.0 / q[L0])
    c = damping(k, m, q[ZETA])
    return damping_chain(c, p, kappa, v, q)


def acceleration(
    y: float, v: float, p: float, t: float, h: float, m: float, x: Row, xn: Row, q: Row
) -> float:
    """Return y'' in m/s^2: equation (3) for the moved mass m."""
    f = pull(y, v, p, t, h, x, xn, q) - coefficient(y, v, p, m, q) * v
    f += outside_chain(0.0, p, y, v, t, h, x, xn, q)
    net: float = f * (1.0 / m) - q[GRAVITY]
    return net


def step(x: Row, xn: Row, q: Row, u: float, t: float, h: float) -> None:
    """Advance the state row x from t by h seconds with the pressure command u held, in place."""
    y, v = x[Y], x[V]
    half, sixth = 0.5 * h, h / 6.0
    m = mass_chain(q[MASS], q)
    p0 = pressure_chain(u, t, 0.0, x, xn, q)
    p1 = pressure_chain(u, t + half, half, x, xn, q)
    p2 = pressure_chain(u, t + h, half, xn, x, q)
    a1 = acceleration(y, v, p0, t, 0.0, m, x, xn, q)
    middle = y + half * v + 0.5 * half * half * a1
    a2 = acceleration(middle, v + half * a1, p1, t + half, half, m, x, xn, q)
    a3 = acceleration(middle, v + half * a2, p1, t + half, half, m, x, xn, q)
    end = y + h * v + 0.5 * h * h * a3
    a4 = acceleration(end, v + h * a3, p2, t + h, h, m, x, xn, q)
    x[Y] = y + h * v + h * sixth * (a1 + a2 + a3)
    x[V] = v + sixth * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    x[P] = p2
    if remembers(q):
        # Once more at the end that was reached: what the memories have become there.
        acceleration(x[Y], x[V], p2, t + h, h, m, x, xn, q)
        for i in range(MEMORY_FROM, x.shape[0]):
            x[i] = xn[i]


def advance(
    x: Row, xn: Row, q: Row, u: Row, at: Row, queue: Row, count: Row, k: int, steps: int, h: float
) -> None:
    """Advance every muscle by a counted number of steps of exactly h seconds, in place.

    x, xn, q: a row a muscle. u (muscles,): commands in force. at, queue (muscles, room): stamps
    and values of the commands to come, the first count[m] of them, in order; those that have
    come into force are removed. A command acts from the first step that starts at or after its
    stamp plus the delay of the pressure path. Steps are numbered from k: time is k h, never a sum.
    """
    for m in range(x.shape[0]):
        for j in range(x.shape[1]):
            xn[m, j] = x[m, j]
        delay = delay_chain(q[m])
        done = 0
        for i in range(k, k + steps):
            t = i * h
            while done < count[m] and at[m, done] + delay <= t + 1e-6 * h:
                u[m] = queue[m, done]
                done += 1
            step(x[m], xn[m], q[m], u[m], t, h)
        for i in range(done, count[m]):
            at[m, i - done] = at[m, i]
            queue[m, i - done] = queue[m, i]
        count[m] -= done


def outputs(x: Row, xn: Row, q: Row, t: float, out: Row) -> None:
    """Fill out (muscles, 4) with force N, stiffness N/m, damping N s/m, acceleration m/s^2.

    The stiffness is -dF/dkappa / l0 of the force law (2) at the contraction that is felt.
    """
    for n in range(x.shape[0]):
        y, v, p = x[n, Y], x[n, V], x[n, P]
        m = mass_chain(q[n, MASS], q[n])
        kappa = contraction_chain(y * (1.0 / q[n, L0]), q[n])
        e = exp(q[n, A3] * kappa)
        out[n, 0] = pull(y, v, p, t, 0.0, x[n], xn[n], q[n])
        out[n, 1] = -slope_at(e, p, q[n, A1], q[n, A2], q[n, A3], q[n, A4]) / q[n, L0]
        out[n, 2] = coefficient(y, v, p, m, q[n])
        out[n, 3] = acceleration(y, v, p, t, 0.0, m, x[n], xn[n], q[n])


def simulate(
    x: Row, xn: Row, q: Row, t: Row, at: Row, u: Row, longest: float, out: Row, forces: bool
) -> None:
    """Run one muscle over a recording's stamps with its commands exactly as stamped.

    x: state row at t[0], changed in place. t (n,): sample stamps. at, u (m,): stamps and values
    of the commands, ascending; u[0] is in force before at[0]. Between two stamps the steps are
    equal, at most *longest* seconds, and none reaches across a command. out (n, 4) receives
    y, v, p and, if *forces*, the muscle's force less its damping, c v: the state at t[i] before
    a command of the same stamp has acted.
    """
    for j in range(x.shape[0]):
        xn[j] = x[j]
    delay = delay_chain(q)
    i = 0
    while i + 1 < at.shape[0] and at[i + 1] + delay < t[0]:
        i += 1
    now = t[0]
    for n in range(t.shape[0]):
        while now < t[n]:
            i = in_force(at, delay, i, now)
            end = held_until(at, delay, i, t[n])
            steps = max(1, ceil((end - now) / longest - 1e-6))
            h = (end - now) / steps
            for s in range(steps):
                step(x, xn, q, u[i], now + s * h, h)
            now = end
        out[n, Y], out[n, V], out[n, P] = x[Y], x[V], x[P]
        if forces:
            f = pull(x[Y], x[V], x[P], now, 0.0, x, xn, q)
            c = coefficient(x[Y], x[V], x[P], mass_chain(q[MASS], q), q)
            out[n, 3] = f - c * x[V]


def simulate_held(
    x: Row, xn: Row, q: Row, t: Row, p: Row, y: Row, v: Row, longest: float, out: Row
) -> None:
    """Run one muscle whose length is prescribed; the load does not move it.

    t, p, y, v (n,): stamps, measured pressure in Pa, position in m, velocity in m/s, taken as
    linear between stamps. out (n, 4) receives y, v, the chamber pressure and the muscle's
    force less its damping, c v.
    """
    for i in range(x.shape[0]):
        xn[i] = x[i]
    delay = delay_chain(q)
    late = 0
    for n in range(t.shape[0]):
        last = n - 1 if n else 0
        span = t[n] - t[last]
        steps = max(1, ceil(span / longest - 1e-6))
        h = span / steps
        for s in range(1, steps + 1):
            share = s / steps
            now = t[last] + s * h
            p_in = p[last] + share * (p[n] - p[last])
            if delay > 0.0 and t.shape[0] > 1:
                # The pressure at the sensor, so long ago as it takes to the chamber.
                then = max(now - delay, t[0])
                while late + 2 < t.shape[0] and t[late + 1] <= then:
                    late += 1
                part = min((then - t[late]) / (t[late + 1] - t[late]), 1.0)
                p_in = p[late] + part * (p[late + 1] - p[late])
            y_in = y[last] + share * (y[n] - y[last])
            v_in = v[last] + share * (v[n] - v[last])
            x[P] = pressure_chain(p_in, now, h, x, xn, q)
            out[n, 3] = pull(y_in, v_in, x[P], now, h, x, xn, q)
            for i in range(HIDDEN, x.shape[0]):
                x[i] = xn[i]
        x[Y], x[V] = y[n], v[n]
        out[n, Y], out[n, V], out[n, P] = x[Y], x[V], x[P]
        out[n, 3] -= coefficient(x[Y], x[V], x[P], mass_chain(q[MASS], q), q) * x[V]


def simulate_along(
    x: Row, xn: Row, q: Row, t: Row, y: Row, v: Row, at: Row, u: Row, out: Row
) -> None:
    """Integrate the acceleration of equation (3) along a motion that is given.

    t, y, v (n,): stamps, position in m, velocity in m/s, linear between stamps. at, u (m,):
    commands as for ``simulate``. out (n - 1, 2) receives, for each interval between two stamps,
    the integral of the acceleration in m/s and its moment about the interval's middle in m, by
    the midpoint rule between commands.
    """
    for j in range(x.shape[0]):
        xn[j] = x[j]
    m = mass_chain(q[MASS], q)
    delay = delay_chain(q)
    i = 0
    while i + 1 < at.shape[0] and at[i + 1] + delay < t[0]:
        i += 1
    now = t[0]
    before = t[0]
    for n in range(1, t.shape[0]):
        out[n - 1, 0] = 0.0
        out[n - 1, 1] = 0.0
        while now < t[n]:
            i = in_force(at, delay, i, now)
            end = held_until(at, delay, i, t[n])
            half = 0.5 * (end - now)
            middle = now + half
            share = (middle - t[n - 1]) / (t[n] - t[n - 1])
            x[Y] = y[n - 1] + share * (y[n] - y[n - 1])
            x[V] = v[n - 1] + share * (v[n] - v[n - 1])
            x[P] = pressure_chain(u[i], middle, half, x, xn, q)
            h = middle - before
            for j in range(HIDDEN, MEMORY_FROM):
                x[j] = xn[j]
            a = acceleration(x[Y], x[V], x[P], middle, h, m, x, xn, q)
            x[P] = pressure_chain(u[i], end, half, x, xn, q)
            for j in range(HIDDEN, MEMORY_FROM):
                x[j] = xn[j]
            if remembers(q):
                for j in range(MEMORY_FROM, x.shape[0]):
                    x[j] = xn[j]
            out[n - 1, 0] += 2.0 * half * a
            out[n - 1, 1] += 2.0 * half * a * (middle - 0.5 * (t[n - 1] + t[n]))
            before = middle
            now = end
