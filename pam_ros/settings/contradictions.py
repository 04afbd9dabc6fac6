# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values that are allowed one by one, and together make no joint."""

from collections.abc import Mapping

from pam_ros.effects import EFFECTS
from pam_ros.effects.payload import LEAST_SHARE
from pam_ros.errors import ParameterError
from pam_ros.rig.joint import Joint

NAMES = {effect.name: effect for effect in EFFECTS}


def refuse_contradictions(joint: Joint) -> None:
    """Raise ParameterError where effects on *joint* leave it no mass, or no travel.

    The equations keep a fifth of the mass whatever the payload, for the sake of fits that try
    values on their way; what a user declares is refused instead.
    """
    mass, payload = joint.load.mass, _values(joint.effects, 'payload')['mass']
    if mass + payload < LEAST_SHARE * mass:
        raise ParameterError(
            f'effects.payload.mass = {payload:g} kg leaves {mass + payload:g} kg of mass = '
            f'{mass:g} kg: give at least {(LEAST_SHARE - 1.0) * mass:g} kg'
        )
    stop = _values(joint.effects, 'end_stop')
    has_both = stop['stiffness'] > 0.0 and stop['lower_stiffness'] > 0.0
    if has_both and stop['lower'] >= stop['upper']:
        raise ParameterError(
            f'effects.end_stop.lower = {stop["lower"]:g} is not allowed: give less than '
            f'effects.end_stop.upper = {stop["upper"]:g}'
        )


def _values(effects: Mapping[str, Mapping[str, float]], name: str) -> dict[str, float]:
    """Return the parameters of an effect by name: those given, or their defaults."""
    defaults = {parameter.name: parameter.default for parameter in NAMES[name].parameters}
    return {**defaults, **effects.get(name, {})}
