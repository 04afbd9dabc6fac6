# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An independent plant to judge the package by: own equations, own integrator, own constants.

It shares no code with the package on purpose, and says each effect by other equations than the
package where more than one description exists.
"""

from .catalogue import FORMS, KINDS, OUT_OF_LIBRARY, Effect, effect
from .control_plants import CONTROL_PLANTS, control_plant
from .plant import TruthPlant
from .sensor import Sensor

__all__ = [
    'CONTROL_PLANTS',
    'FORMS',
    'KINDS',
    'OUT_OF_LIBRARY',
    'Effect',
    'Sensor',
    'TruthPlant',
    'control_plant',
    'effect',
]
