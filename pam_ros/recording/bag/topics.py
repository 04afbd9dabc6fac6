# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of the package in a bag: their types, and the meaning of their fields."""

from collections.abc import Sequence

from pam_ros.recording.mapping import Meaning
from pam_ros.recording.quantities import ATMOSPHERE, Target

JOINT_STATE = 'sensor_msgs/msg/JointState'
FLUID_PRESSURE = 'sensor_msgs/msg/FluidPressure'
FLOAT64_ARRAY = 'std_msgs/msg/Float64MultiArray'
FLOAT64 = 'std_msgs/msg/Float64'
_FLOAT = (FLOAT64, 'std_msgs/msg/Float32')
_PA, _M = Target('pressure_command', 'Pa'), Target('position', 'm')
# topic -> type -> field -> meaning: the package's own topics.
OwnTopics = dict[str, dict[str, dict[str, Meaning]]]
_OF_ONE_MUSCLE: OwnTopics = {
    'pressure_command': {kind: {'data': Meaning(_PA)} for kind in _FLOAT},
    'joint_states': {
        JOINT_STATE: {
            'position': Meaning(_M),
            'velocity': Meaning(Target('velocity', 'm_s')),
            'effort': Meaning(Target('force', 'N')),
        }
    },
    'force': {kind: {'data': Meaning(Target('force', 'N'))} for kind in _FLOAT},
    'pressure': {
        FLUID_PRESSURE: {'fluid_pressure': Meaning(Target('pressure', 'Pa'), 1.0, -ATMOSPHERE)}
    },
}


def own_topics(muscles: Sequence[str], unit: str | None) -> OwnTopics:
    """Return the package's topics of one muscle on a mass, or of a joint with *muscles*, *unit*.

    The pressures of a joint are arrays with a number for each muscle.
    """
    if not muscles:
        return _OF_ONE_MUSCLE
    linear = {'position': Target('position', 'm'), 'velocity': Target('velocity', 'm_s')}
    angular = {'position': Target('angle', 'rad'), 'velocity': Target('angular_velocity', 'rad_s')}
    motion = angular if unit == 'rad' else linear
    names = muscles if len(muscles) > 1 else ('',)
    commands = {
        f'data[{i}]': Meaning(Target('pressure_command', 'Pa', name))
        for i, name in enumerate(names)
    }
    pressures = {
        f'data[{i}]': Meaning(Target('pressure', 'Pa', name), 1.0, -ATMOSPHERE)
        for i, name in enumerate(names)
    }
    return {
        'pressure_commands': {FLOAT64_ARRAY: commands},
        'joint_states': {JOINT_STATE: {field: Meaning(to) for field, to in motion.items()}},
        'pressures': {FLOAT64_ARRAY: pressures},
    }
