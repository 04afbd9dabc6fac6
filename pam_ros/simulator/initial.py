# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The state in which a simulation starts."""

import numpy as np
from numpy.typing import NDArray

from pam_ros.rig.equilibrium import rest_position
from pam_ros.settings.scene import SimulationSetup

Array = NDArray[np.float64]


def initial_state(setup: SimulationSetup) -> tuple[Array, Array, Array]:
    """Return the pressures in Pa, then the positions (m, rad) and velocities of the joints.

    A joint that starts at rest is at the equilibrium of the pressures in its muscles.
    """
    pressures = iter(setup.pressures)
    positions, velocities = [], []
    # Joints with the same values are one object: in a large rig most of them rest alike.
    rests: dict[tuple[int, tuple[float, ...]], float] = {}
    for joint, start in zip(setup.joints, setup.starts, strict=True):
        p = tuple(next(pressures) for _ in joint.muscles)
        if start.at_rest:
            key = id(joint), p
            if key not in rests:
                rests[key] = rest_position(joint.at_start, p)
            positions.append(rests[key])
            velocities.append(0.0)
        else:
            positions.append(start.position)
            velocities.append(start.velocity)
    return np.array(setup.pressures), np.array(positions), np.array(velocities)
