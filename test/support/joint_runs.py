# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of joints by the package, and by scipy's DOP853 on equations of a test's own."""

import numpy as np
from scipy.integrate import solve_ivp

from pam_ros.rig.rig import Rig

BAR = 1e5
MASS, OFFSETS = 50.0, (0.02, -0.01)


def solve(rhs, start, t):
    found = solve_ivp(rhs, (t[0], t[-1]), start, 'DOP853', t, rtol=1e-12, atol=1e-14)
    assert found.success
    return found.y


def run(model, t, start, pressure=(0.0, 0.0), step=1e-3):
    """Return coordinate and speed at the stamps t, whole numbers of steps apart."""
    rig = Rig([model], step)
    rig.reset(pressure, [start[0]], [start[1]])
    found = [start]
    for span in np.diff(t):
        rig.advance(round(span / step))
        found.append((rig.position[0], rig.velocity[0]))
    return np.array(found).T
