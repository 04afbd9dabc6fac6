# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The units that an effect has on a joint that turns.

Effects on a joint are written for a load that slides. On one that turns, a force is a torque and a
length an angle; a contraction, which places end stops, becomes the angle itself.
"""

import math
from dataclasses import replace

from pam_ros.effects.base import Effect, EffectParameter
from pam_ros.errors import ParameterError

TURNED = {
    'm': 'rad',
    'm/s': 'rad/s',
    'N': 'N m',
    'N/m': 'N m/rad',
    'N s/m': 'N m s/rad',
    'N/Pa': 'N m/Pa',
    's/m': 's/rad',
    'fraction': 'rad',
    # These have nothing to do with the coordinate.
    '': '',
    'kg': 'kg',
    's': 's',
    '1/s': '1/s',
    'Hz': 'Hz',
    'Pa': 'Pa',
}


def turned(effect: Effect) -> Effect:
    """Return *effect* with the units and ranges that it has on a joint that turns.

    Raises ParameterError for a unit that is not in TURNED.
    """
    return replace(effect, parameters=tuple(_turned(effect.name, p) for p in effect.parameters))


def _turned(name: str, p: EffectParameter) -> EffectParameter:
    if p.unit not in TURNED:
        raise ParameterError(
            f'effects.{name}.{p.name} is in {p.unit}: what that is on a joint that turns is not '
            'known; add the unit to TURNED in pam_ros/effects/turned.py'
        )
    if p.unit == 'fraction':
        return replace(p, unit=TURNED[p.unit], low=-math.pi, high=math.pi)
    return replace(p, unit=TURNED[p.unit])
