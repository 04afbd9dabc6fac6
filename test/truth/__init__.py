# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An independent plant to judge the package by: own equations, own integrator, own constants.

It shares no code with the package on purpose, and says each effect by other equations than the
package where more than one description exists.
"""

from .catalogue import FORMS, KINDS, OUT_OF_LIBRARY
from .control_plants import CONTROL_PLANTS, control_plant
from .effects import Effect, effect
from .excitation import PROGRAMMES, stamps, working_range
from .plant import TruthPlant
from .records import Recording, held_record, play, record
from .sensor import Sensor
from .trials import ABSORBED, NOISE_ONLY, PAIRS, Declared, Trial, blind_trial, held_trial
from .visibility import Visibility, visibility

__all__ = [
    'ABSORBED',
    'CONTROL_PLANTS',
    'FORMS',
    'KINDS',
    'NOISE_ONLY',
    'OUT_OF_LIBRARY',
    'PAIRS',
    'PROGRAMMES',
    'Declared',
    'Effect',
    'Recording',
    'Sensor',
    'Trial',
    'TruthPlant',
    'Visibility',
    'blind_trial',
    'control_plant',
    'effect',
    'held_record',
    'held_trial',
    'play',
    'record',
    'stamps',
    'visibility',
    'working_range',
]
