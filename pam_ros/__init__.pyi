# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
# The public names and their modules, for type checkers and for __init__.py, which reads this file.
# ruff: noqa: F403

from pam_ros.control.co_contraction import CoContraction as CoContraction
from pam_ros.control.gains import Gains as Gains
from pam_ros.control.limits import Limits as Limits
from pam_ros.control.pid import Pid as Pid
from pam_ros.control.pid import PidGains as PidGains
from pam_ros.control.reference.generator import ReferenceGenerator as ReferenceGenerator
from pam_ros.control.reference.shaping import Shape as Shape
from pam_ros.control.signals import Reference as Reference
from pam_ros.control.sliding_mode import SlidingMode as SlidingMode
from pam_ros.devices.sensors import Sensors as Sensors
from pam_ros.devices.simulated_sensors import SensorReadings as SensorReadings
from pam_ros.devices.simulated_sensors import SimulatedSensors as SimulatedSensors
from pam_ros.effects import *
from pam_ros.effects import EFFECTS as EFFECTS
from pam_ros.errors import PamError as PamError
from pam_ros.identification.identify import identify as identify
from pam_ros.identification.result import Identification as Identification
from pam_ros.muscle.braid import Braid as Braid
from pam_ros.muscle.fit import fit_static_map as fit_static_map
from pam_ros.muscle.muscle import Muscle as Muscle
from pam_ros.parameters import parameter_field as parameter_field
from pam_ros.recording.csv_file import write_csv as write_csv
from pam_ros.recording.mapping import read_mapping as read_mapping
from pam_ros.recording.read import read_recording as read_recording
from pam_ros.recording.recording import Recording as Recording
from pam_ros.report.save import save_parameters as save_parameters
from pam_ros.report.save import save_report as save_report
from pam_ros.rig.co_contraction import co_contraction_pressures as co_contraction_pressures
from pam_ros.rig.co_contraction import joint_stiffness as joint_stiffness
from pam_ros.rig.co_contraction import joint_stiffness_range as joint_stiffness_range
from pam_ros.rig.equilibrium import equilibrium as equilibrium
from pam_ros.rig.joint import Actuator as Actuator
from pam_ros.rig.joint import Joint as Joint
from pam_ros.rig.loads import Arm as Arm
from pam_ros.rig.loads import Load as Load
from pam_ros.rig.loads import LoadEquations as LoadEquations
from pam_ros.rig.loads import Mass as Mass
from pam_ros.rig.run import Trajectory as Trajectory
from pam_ros.rig.run import simulate as simulate
from pam_ros.rig.run import simulate_held as simulate_held
from pam_ros.rig.simulation import JointOutputs as JointOutputs
from pam_ros.rig.simulation import MuscleOutputs as MuscleOutputs
from pam_ros.rig.simulation import Simulation as Simulation
from pam_ros.rig.standard_joints import antagonistic_joint as antagonistic_joint
from pam_ros.rig.standard_joints import single_muscle_joint as single_muscle_joint
from pam_ros.rig.transmissions import Lever as Lever
from pam_ros.rig.transmissions import Pulley as Pulley
from pam_ros.rig.transmissions import Straight as Straight
from pam_ros.rig.transmissions import Transmission as Transmission
from pam_ros.rig.transmissions import TransmissionEquations as TransmissionEquations
from pam_ros.settings.load import load_joint as load_joint
from pam_ros.settings.load import load_muscle as load_muscle
from pam_ros.version import __version__ as __version__
