# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of one joint over the stamps of a recording, as templates.

They supplement those of :mod:`pam_ros.rig.kernel` and are bound with them. The stamp of a command
is the time at which it acts in the chamber: it already includes dead times.
"""

from math import ceil, exp

from pam_ros.effects.base import ENOUGH
from pam_ros.rig.filling import supplied
from pam_ros.rig.kernel import (
    begin,
    coefficient,
    effective_contraction,
    net_force,
    pull,
    share,
    step,
)
from pam_ros.rig.layout import (
    A3,
    HIDDEN,
    JOINT,
    JOINT_HIDDEN,
    MASS,
    MUSCLE,
    RUN_F,
    RUN_P,
    RUN_S,
    RUN_V,
    P,
    S,
    V,
)
from pam_ros.rig.unbound import (
    HAS_RESERVOIR,
    IS_DRAGGED,
    LOAD,
    MEMORY_FROM,
    MUSCLES,
    TRANSMISSION,
    WIDTH,
    Row,
    arm_of,
    delay_chain,
    drag_chain,
    inertia_of,
    mass_chain,
    pressure_chain,
)


def in_force(at: Row, i: int, now: float) -> int:
    """Return the index of the command that acts at *now*, not below i; *at* are the stamps."""
    while i + 1 < at.shape[0] and at[i + 1] <= now + 1e-9:
        i += 1
    return i


def held_until(at: Row, i: int, end: float) -> float:
    """Return the time at which command i stops acting, at most *end*."""
    if i + 1 < at.shape[0] and at[i + 1] < end - 1e-9:
        held: float = at[i + 1]
        return held
    return end


def first_command(at: Row, begin_at: float) -> int:
    """Return the index of the command that acts just before *begin_at*."""
    i = 0
    while i + 1 < at.shape[0] and at[i + 1] < begin_at:
        i += 1
    return i


def simulate(
    x: Row, xn: Row, q: Row, t: Row, at: Row, u: Row, longest: float, out: Row, forces: bool
) -> None:
    """Simulate one joint at the stamps of a recording, its commands exactly at their stamps.

    x: state at t[0], changed in place. t (n,): sample stamps. at (m,), u (m, muscles): stamps
    and values of the commands, ascending; u[0] also acts before at[0]. Between two stamps the
    steps are equal, at most *longest* seconds, and no step extends across a command. out (n,
    columns of a run) receives coordinate, velocity, pressure of each muscle and, if *forces*, its
    force minus its damping: the state at t[i] before a command of the same stamp has acted.
    """
    begin(x, xn)
    m = mass_chain(q[JOINT, MASS], q[JOINT])
    inertia = inertia_of(m, q[JOINT], LOAD)
    c = first_command(at, t[0])
    now = t[0]
    for n in range(t.shape[0]):
        while now < t[n]:
            c = in_force(at, c, now)
            end = held_until(at, c, t[n])
            steps = max(1, ceil((end - now) / longest - 1e-6))
            h = (end - now) / steps
            for k in range(steps):
                step(x, xn, q, u[c], now + k * h, h)
            now = end
        s, v = x[JOINT, S], x[JOINT, V]
        out[n, RUN_S], out[n, RUN_V] = s, v
        for i in range(MUSCLES):
            out[n, RUN_P + 2 * i] = x[MUSCLE + i, P]
            if forces:
                p = x[MUSCLE + i, P]
                out[n, RUN_F + 2 * i] = net_force(s, v, i, p, now, 0.0, inertia, x, xn, q)


def simulate_pressures(
    x: Row, xn: Row, q: Row, t: Row, at: Row, u: Row, longest: float, out: Row
) -> None:
    """Simulate the pressures in the chambers of one joint, whose motion they do not depend on.

    The arguments are those of :func:`simulate`, and so are the pressures, except for rounding: the
    laws of the path are exact over a step, or (a choked flow) of second order. The joint rests at
    its coordinate in x; out (n, columns of a run) receives no forces.
    """
    begin(x, xn)
    c = first_command(at, t[0])
    now = t[0]
    for n in range(t.shape[0]):
        while now < t[n]:
            c = in_force(at, c, now)
            end = held_until(at, c, t[n])
            steps = max(1, ceil((end - now) / longest - 1e-6))
            h = (end - now) / steps
            for k in range(steps):
                begun = now + k * h
                limit = ENOUGH
                if HAS_RESERVOIR:
                    limit = supplied(u[c], begun, h, x, xn, q)
                    for column in range(JOINT_HIDDEN, WIDTH):
                        x[JOINT, column] = xn[JOINT, column]
                for i in range(MUSCLES):
                    r = MUSCLE + i
                    p_in = min(u[c, i], limit)
                    x[r, P] = pressure_chain(p_in, begun + h, h, x[r], xn[r], q[r])
                    for column in range(HIDDEN, MEMORY_FROM):
                        x[r, column] = xn[r, column]
            now = end
        out[n, RUN_S], out[n, RUN_V] = x[JOINT, S], 0.0
        for i in range(MUSCLES):
            out[n, RUN_P + 2 * i], out[n, RUN_F + 2 * i] = x[MUSCLE + i, P], 0.0


def simulate_held(
    x: Row, xn: Row, q: Row, t: Row, p: Row, s: Row, v: Row, longest: float, out: Row
) -> None:
    """Simulate one joint whose coordinate is prescribed; the muscles do not move it.

    t (n,): stamps. p (n, muscles): measured pressures in Pa. s, v (n,): coordinate and velocity;
    all are assumed to be linear between stamps. out as with :func:`simulate`, forces included.
    The force of one muscle in line with the coordinate includes the friction that a machine
    measures.
    """
    begin(x, xn)
    m = mass_chain(q[JOINT, MASS], q[JOINT])
    inertia = inertia_of(m, q[JOINT], LOAD)
    for n in range(t.shape[0]):
        last = n - 1 if n else 0
        span = t[n] - t[last]
        steps = max(1, ceil(span / longest - 1e-6))
        h = span / steps
        for i in range(MUSCLES):
            r = MUSCLE + i
            delay = delay_chain(q[r])
            force, drag = 0.0, 0.0
            for k in range(1, steps + 1):
                part = k / steps
                now = t[last] + k * h
                p_in = p[last, i] + part * (p[n, i] - p[last, i])
                if delay > 0.0 and t.shape[0] > 1:
                    # The pressure at the sensor one delay ago: it reaches the chamber now.
                    then = max(now - delay, t[0])
                    late = min(n, t.shape[0] - 2)
                    while late > 0 and t[late] > then:
                        late -= 1
                    gone = min((then - t[late]) / (t[late + 1] - t[late]), 1.0)
                    p_in = p[late, i] + gone * (p[late + 1, i] - p[late, i])
                here, speed = s[last] + part * (s[n] - s[last]), v[last] + part * (v[n] - v[last])
                x[r, P] = pressure_chain(p_in, now, h, x[r], xn[r], q[r])
                kappa = effective_contraction(here, i, q)
                e = exp(q[r, A3] * kappa)
                w = arm_of(here, i, q[JOINT], TRANSMISSION) * speed
                force = pull(kappa, e, w, x[r, P], now, h, x[r], xn[r], q[r])
                for c in range(HIDDEN, WIDTH):
                    x[r, c] = xn[r, c]
                if IS_DRAGGED:
                    drag = drag_chain(
                        0.0, x[r, P], here, speed, now, h, x[JOINT], xn[JOINT], q[JOINT]
                    )
                    for c in range(JOINT_HIDDEN, WIDTH):
                        x[JOINT, c] = xn[JOINT, c]
            arm = arm_of(s[n], i, q[JOINT], TRANSMISSION)
            w = arm * v[n]
            kappa = effective_contraction(s[n], i, q)
            e = exp(q[r, A3] * kappa)
            c_end = coefficient(kappa, e, w, x[r, P], share(arm, inertia), q[r])
            out[n, RUN_P + 2 * i] = x[r, P]
            out[n, RUN_F + 2 * i] = force - c_end * w + drag
        x[JOINT, S], x[JOINT, V] = s[n], v[n]
        out[n, RUN_S], out[n, RUN_V] = s[n], v[n]
