# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of joints by the package, by scipy's DOP853, and what the law of the muscles says."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support import joints
from support.joint_models import UNEQUAL, lever, pair

BAR = 1e5
MASS, OFFSETS = 50.0, (0.02, -0.01)


def solve(rhs, start, t):
    found = solve_ivp(rhs, (t[0], t[-1]), start, 'DOP853', t, rtol=1e-12, atol=1e-14)
    assert found.success
    return found.y


def run(model, t, start, pressure=(0.0, 0.0), step=1e-3):
    """Return coordinate and speed at the stamps t, whole numbers of steps apart."""
    rig = Simulation([model], step)
    rig.reset(pressure, [start[0]], [start[1]])
    found = [start]
    for span in np.diff(t):
        rig.advance(round(span / step))
        found.append((rig.position[0], rig.velocity[0]))
    return np.array(found).T


@dataclass(frozen=True)
class Case:
    """A joint, and what the law of its muscles says: ends in m and arms at a coordinate."""

    made: Any
    inertia: float
    ends: Any
    arms: Any

    def forces(self, p, s, rate):
        """Return equation (1) less (4) times the muscle's speed of each, p (muscles,) in Pa."""
        found = []
        for bar, strand, y, r in zip(p / 1e5, UNEQUAL, self.ends(s), self.arms(s), strict=False):
            mass = self.inertia / (p.size * r**2)
            c = 2.0 * joints.ZETA * np.sqrt(mass * strand.stiffness(bar, y))
            found.append(strand.force(bar, y) - c * r * rate)
        return found


def ends_on_lever(s):
    mounted = joints.KAPPA_1 * UNEQUAL[0].l0, joints.KAPPA_2 * UNEQUAL[1].l0
    return [y + joints.drawn(s, i) for i, y in enumerate(mounted)]


CASES = {
    'one muscle': Case(
        lambda effects=((), ()): single_muscle_joint(effects=effects[0]),
        *(20.0, lambda s: [s], lambda s: [1.0]),
    ),
    'pair': Case(
        pair, joints.J, lambda s: joints.ends(s, UNEQUAL), lambda s: [joints.R, -joints.R]
    ),
    'lever': Case(
        lever, joints.J, ends_on_lever, lambda s: [joints.lever_arm(s, i) for i in (0, 1)]
    ),
}
