# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The physical effects that the paper's model lacks, in the order in which they act.

To add one, write its file and add its line here; ``docs/tutorials/add_an_effect.md`` shows how.
"""

from pam_ros.effects.base import Effect as Effect

# isort: off
# From the command to the chamber.
from pam_ros.effects.dead_time import DeadTime as DeadTime
from pam_ros.effects.supply import Supply as Supply
from pam_ros.effects.pressure_offset import PressureOffset as PressureOffset
from pam_ros.effects.dead_band import DeadBand as DeadBand
from pam_ros.effects.pressure_lag import PressureLag as PressureLag
from pam_ros.effects.leak import Leak as Leak

# The muscle.
from pam_ros.effects.length_offset import LengthOffset as LengthOffset
from pam_ros.effects.softening import Softening as Softening
from pam_ros.effects.creep import Creep as Creep
from pam_ros.effects.hysteresis import Hysteresis as Hysteresis
from pam_ros.effects.pressure_hysteresis import PressureHysteresis as PressureHysteresis
from pam_ros.effects.slack import Slack as Slack
from pam_ros.effects.pressure_dependent_damping import (
    PressureDependentDamping as PressureDependentDamping,
)

# The load and its surroundings.
from pam_ros.effects.periodic_disturbance import PeriodicDisturbance as PeriodicDisturbance
from pam_ros.effects.payload import Payload as Payload
from pam_ros.effects.viscous_friction import ViscousFriction as ViscousFriction
from pam_ros.effects.coulomb_friction import CoulombFriction as CoulombFriction
from pam_ros.effects.end_stop import EndStop as EndStop
# isort: on

# The effects imported above, in their order.
EFFECTS: tuple[type[Effect], ...] = tuple(
    found
    for found in list(vars().values())
    if isinstance(found, type) and issubclass(found, Effect) and found is not Effect
)
