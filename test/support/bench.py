# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rigs on which an effect is seen alone, and an adaptive solver to check it against.

The solver's equations are written in each test; only the muscle's own are here, from
``support.paper``, in SI and with contraction positive.
"""

import numpy as np
from scipy.integrate import solve_ivp

from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from support import paper

L0 = paper.L0
G = paper.G
MASS = 10.0
ZETA = 0.15


def hanging(*effects, mass=MASS):
    """Return the paper's muscle with a hanging load."""
    return single_muscle_joint(Muscle(zeta=ZETA), Mass(mass=mass), effects)


def cart(*effects, mass=MASS):
    """Return a load on a horizontal guide, drawn with 1 N per Pa, and nothing else."""
    drawn = Muscle(
        a1=0.0,
        a2=0.0,
        a3=0.0,
        a4=0.0,
        a5=1.0,
        a6=0.0,
        pressure_unit='Pa',
        contraction_unit='fraction',
        zeta=0.0,
        l0=1.0,
        p_min=-1e5,
        p_max=1e5,
    )
    return single_muscle_joint(drawn, Mass(mass=mass, mount='horizontal'), effects)


def pull(p, y):
    """Return the muscle's force in N at p Pa and y m: equation (1)."""
    return paper.force(1e-5 * p, 100.0 * y / L0)


def drag(p, y, mass=MASS):
    """Return its damping coefficient in N s/m: equation (4)."""
    return paper.damping(1e-5 * p, 100.0 * y / L0, mass, ZETA)


def rest(p, weight=MASS * G):
    """Return the position in m where the muscle holds *weight* N, by bisection."""
    low, high = -0.1 * L0, 0.5 * L0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if pull(p, middle) > weight else (low, middle)
    return low


def stepped(commands):
    """Return the (stamp, value) pairs *commands* as arguments of ``simulate``."""
    command_t, command = zip(*commands, strict=True)
    return {'command': command, 'command_t': command_t}


def solved(rhs, t, state, commands=((0.0, 0.0),), **options):
    """Integrate ``rhs(t, state, u)`` adaptively, restarted after each command; return (states, t).

    commands: (stamp, value) pairs, ascending, the first at or before t[0].
    """
    t, state = np.asarray(t, float), np.asarray(state, float)
    out = np.empty((state.size, t.size))
    options = {'method': 'DOP853', 'rtol': 1e-10, 'atol': 1e-12, **options}
    ends = [stamp for stamp, _ in commands[1:]] + [t[-1]]
    for (stamp, u), end in zip(commands, ends, strict=True):
        begin = max(stamp, t[0])
        inside = (t >= begin) & (t <= end)
        run = solve_ivp(rhs, (begin, end), state, args=(u,), dense_output=True, **options)
        assert run.success
        out[:, inside] = run.sol(t[inside])
        state = run.y[:, -1]
    return out
