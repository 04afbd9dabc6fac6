# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An effect with the units that it has on a joint that turns."""

import math
from dataclasses import replace

from pam_ros.effects.base import Effect, EffectParameter
from pam_ros.effects.names import EffectName
from pam_ros.units import turned_unit


def turned(effect: Effect) -> Effect:
    """Return *effect* with the units and ranges that it has on a joint that turns.

    Raises ParameterError for a unit that is not known to have one.
    """
    return replace(effect, parameters=tuple(_turned(effect.name, p) for p in effect.parameters))


def _turned(name: str, p: EffectParameter) -> EffectParameter:
    unit = turned_unit(p.unit, EffectName(name, p.name).flat)
    if p.unit == 'fraction':
        return replace(p, unit=unit, low=-math.pi, high=math.pi)
    return replace(p, unit=unit)
