# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pneumatic artificial muscles: simulate, control, identify.

The names listed here are the public interface, which ``docs/python.md`` describes. All other names
of the package are internal and may change. A name is imported when it is first used, so that
programs that need only a part of the package do not wait for the rest.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from pam_ros.version import __version__

if TYPE_CHECKING:
    from pam_ros.control.co_contraction import CoContraction
    from pam_ros.control.gains import Gains
    from pam_ros.control.limits import Limits
    from pam_ros.control.pid import Pid, PidGains
    from pam_ros.control.reference.generator import ReferenceGenerator
    from pam_ros.control.reference.shaping import Shape
    from pam_ros.control.signals import Reference
    from pam_ros.control.sliding_mode import SlidingMode
    from pam_ros.devices.sensors import Sensors
    from pam_ros.devices.simulated_sensors import SensorReadings, SimulatedSensors
    from pam_ros.effects import EFFECTS
    from pam_ros.effects.base import Effect
    from pam_ros.errors import PamError
    from pam_ros.identification.identify import identify
    from pam_ros.identification.result import Identification
    from pam_ros.muscle.braid import Braid
    from pam_ros.muscle.fit import fit_static_map
    from pam_ros.muscle.muscle import Muscle
    from pam_ros.parameters import parameter_field
    from pam_ros.recording.csv_file import write_csv
    from pam_ros.recording.mapping import read_mapping
    from pam_ros.recording.read import read_recording
    from pam_ros.recording.recording import Recording
    from pam_ros.report.save import save_parameters, save_report
    from pam_ros.rig.co_contraction import (
        co_contraction_pressures,
        joint_stiffness,
        joint_stiffness_range,
    )
    from pam_ros.rig.equilibrium import equilibrium
    from pam_ros.rig.joint import Actuator, Joint
    from pam_ros.rig.loads import Arm, Load, LoadEquations, Mass
    from pam_ros.rig.run import Trajectory, simulate, simulate_held
    from pam_ros.rig.simulation import JointOutputs, MuscleOutputs, Simulation
    from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
    from pam_ros.rig.transmissions import (
        Lever,
        Pulley,
        Straight,
        Transmission,
        TransmissionEquations,
    )
    from pam_ros.settings.load import load_joint, load_muscle

__all__ = [
    'EFFECTS',
    'Actuator',
    'Arm',
    'Braid',
    'CoContraction',
    'Effect',
    'Gains',
    'Identification',
    'Joint',
    'JointOutputs',
    'Lever',
    'Limits',
    'Load',
    'LoadEquations',
    'Mass',
    'Muscle',
    'MuscleOutputs',
    'PamError',
    'Pid',
    'PidGains',
    'Pulley',
    'Recording',
    'Reference',
    'ReferenceGenerator',
    'SensorReadings',
    'Sensors',
    'Shape',
    'SimulatedSensors',
    'Simulation',
    'SlidingMode',
    'Straight',
    'Trajectory',
    'Transmission',
    'TransmissionEquations',
    '__version__',
    'antagonistic_joint',
    'co_contraction_pressures',
    'equilibrium',
    'fit_static_map',
    'identify',
    'joint_stiffness',
    'joint_stiffness_range',
    'load_joint',
    'load_muscle',
    'parameter_field',
    'read_mapping',
    'read_recording',
    'save_parameters',
    'save_report',
    'simulate',
    'simulate_held',
    'single_muscle_joint',
    'write_csv',
]

_PLACES = {
    'control.co_contraction': ('CoContraction',),
    'control.gains': ('Gains',),
    'control.limits': ('Limits',),
    'control.pid': ('Pid', 'PidGains'),
    'control.reference.generator': ('ReferenceGenerator',),
    'control.reference.shaping': ('Shape',),
    'control.signals': ('Reference',),
    'control.sliding_mode': ('SlidingMode',),
    'devices.sensors': ('Sensors',),
    'devices.simulated_sensors': ('SensorReadings', 'SimulatedSensors'),
    'effects': ('EFFECTS',),
    'effects.base': ('Effect',),
    'errors': ('PamError',),
    'identification.identify': ('identify',),
    'identification.result': ('Identification',),
    'muscle.braid': ('Braid',),
    'muscle.fit': ('fit_static_map',),
    'muscle.muscle': ('Muscle',),
    'parameters': ('parameter_field',),
    'recording.csv_file': ('write_csv',),
    'recording.mapping': ('read_mapping',),
    'recording.read': ('read_recording',),
    'recording.recording': ('Recording',),
    'report.save': ('save_parameters', 'save_report'),
    'rig.co_contraction': ('co_contraction_pressures', 'joint_stiffness', 'joint_stiffness_range'),
    'rig.joint': ('Actuator', 'Joint'),
    'rig.loads': ('Arm', 'Load', 'LoadEquations', 'Mass'),
    'rig.equilibrium': ('equilibrium',),
    'rig.simulation': ('JointOutputs', 'MuscleOutputs', 'Simulation'),
    'rig.run': ('Trajectory', 'simulate', 'simulate_held'),
    'rig.standard_joints': ('antagonistic_joint', 'single_muscle_joint'),
    'rig.transmissions': (
        'Lever',
        'Pulley',
        'Straight',
        'Transmission',
        'TransmissionEquations',
    ),
    'settings.load': ('load_joint', 'load_muscle'),
}
_PLACE_OF = {name: place for place, names in _PLACES.items() for name in names}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used (PEP 562)."""
    if name not in _PLACE_OF:
        raise AttributeError(f'module pam_ros has no attribute {name}')
    value = getattr(import_module(f'pam_ros.{_PLACE_OF[name]}'), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names."""
    return __all__
