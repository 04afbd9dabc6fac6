# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a simulated rig that only one node may publish."""

from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, Float64MultiArray

from pam_ros.nodes.common.topic_watch import Watched
from pam_ros.settings.scene import SimulationSetup


def watched_topics(setup: SimulationSetup) -> list[Watched]:
    """Return these topics: commands, states, pressures, and ``/clock`` if the simulator makes it.

    Two simulators that share one of their other topics also share one of these.
    """
    settings = setup.settings
    found = [Watched(JointState, 'joint_states', tuple(setup.joint_names))]
    if settings.has_own_time:
        found.append(Watched(Clock, '/clock'))
    if setup.has_arrays:
        found.append(Watched(Float64MultiArray, 'pressure_commands'))
        found.append(Watched(Float64MultiArray, 'pressures'))
    for prefix in setup.muscle_prefixes:
        found.append(Watched(Float64, f'{prefix}pressure_command'))
        found.append(Watched(FluidPressure, f'{prefix}pressure'))
    if setup.has_arrays and setup.muscle_prefixes:
        for name in setup.muscle_joints:
            found.append(Watched(JointState, f'{name}/joint_states', (name,)))
    return found
