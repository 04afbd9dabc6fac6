# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Unknowns by their names, and coloured noise."""

import numpy as np
from scipy.signal import lfilter

from pam_ros.effects.names import parsed
from pam_ros.identification.fit.unknowns import Constant, OfEffect, RunStart, Unknown
from pam_ros.rig import layout as at
from pam_ros.rig.standard_joints import single_muscle_joint

LAYOUT = single_muscle_joint().layout


def unknown(name, base=0.0, scale=1.0, *numbers, index=0, run=None, **more):
    """Return an unknown by its name; of the start of a *run*, where one is given."""
    if run is not None:
        of = RunStart(run, name.startswith('v'))
    elif parsed(name):
        of = OfEffect(*parsed(name), name, (index,))
    else:
        of = Constant(name, (index,), at.A1)
    return Unknown(of, base, scale, *numbers, **more)


def coloured(rng, n, rho, sigma=1.0):
    """Return n samples of stationary AR(1) noise of standard deviation *sigma*."""
    white = rng.standard_normal(n)
    first = np.array([rho * rng.standard_normal()])
    drive = np.sqrt(1.0 - rho**2) * white
    return sigma * lfilter([1.0], [1.0, -rho], drive, zi=first)[0]
