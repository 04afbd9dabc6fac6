# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The physical effects that the paper's model lacks, in the order in which they act.

To add one, write its file and add its line here; ``docs/tutorials/add_an_effect.md`` shows how.
"""

from importlib import import_module

from pam_ros.effects.base import Effect

# Each is the file of that name in this folder.
_ORDER = (
    # From the command to the chamber.
    'dead_time',
    'pressure_offset',
    'dead_band',
    'pressure_lag',
    'leak',
    # The muscle.
    'length_offset',
    'softening',
    'creep',
    'hysteresis',
    'slack',
    'pressure_dependent_damping',
    # The load and what it meets.
    'periodic_disturbance',
    'payload',
    'viscous_friction',
    'coulomb_friction',
    'end_stop',
)

EFFECTS: tuple[Effect, ...] = tuple(import_module(f'{__name__}.{name}').EFFECT for name in _ORDER)
