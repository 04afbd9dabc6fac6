# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The physical effects that the paper's model lacks, in the order in which they act.

To add one, write its file and add its line here; ``docs/effects.md`` shows how.
"""

from pam_ros.effects import (
    coulomb_friction,
    creep,
    dead_time,
    end_stop,
    hysteresis,
    leak,
    length_offset,
    payload,
    periodic_disturbance,
    pressure_dependent_damping,
    pressure_lag,
    pressure_offset,
    slack,
    softening,
    viscous_friction,
)
from pam_ros.effects.base import Effect

EFFECTS: tuple[Effect, ...] = (
    # From the command to the chamber.
    dead_time.EFFECT,
    pressure_offset.EFFECT,
    pressure_lag.EFFECT,
    leak.EFFECT,
    # The muscle.
    length_offset.EFFECT,
    softening.EFFECT,
    creep.EFFECT,
    hysteresis.EFFECT,
    slack.EFFECT,
    pressure_dependent_damping.EFFECT,
    # The load and what it meets.
    periodic_disturbance.EFFECT,
    payload.EFFECT,
    viscous_friction.EFFECT,
    coulomb_friction.EFFECT,
    end_stop.EFFECT,
)
