# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a simulated rig that one node alone may publish."""

from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, Float64MultiArray

from pam_ros.nodes.common.topic_watch import Watched
from pam_ros.settings.scene import Simulation


def watched_topics(simulation: Simulation) -> list[Watched]:
    """Return them: commands, states and pressures, and the clock where it is the simulator's.

    Two simulators share their other topics where they share these.
    """
    settings = simulation.settings
    found = [Watched(JointState, 'joint_states', tuple(simulation.joint_names))]
    if settings.has_own_time:
        found.append(Watched(Clock, '/clock'))
    if simulation.is_one:
        return [*found, *_muscle()]
    found.append(Watched(Float64MultiArray, 'pressure_commands'))
    found.append(Watched(Float64MultiArray, 'pressures'))
    if settings.muscle_topics:
        for name in simulation.muscle_names:
            found += _muscle(f'{name}/')
            if settings.joint == 'load':
                found.append(Watched(JointState, f'{name}/joint_states', (name,)))
    return found


def _muscle(below: str = '') -> list[Watched]:
    return [
        Watched(Float64, f'{below}pressure_command'),
        Watched(FluidPressure, f'{below}pressure'),
    ]
