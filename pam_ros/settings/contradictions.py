# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values that are allowed one by one, and together make no joint."""

from pam_ros.effects import end_stop, payload
from pam_ros.effects.base import Effect
from pam_ros.errors import ParameterError
from pam_ros.rig.joint import Joint


def refuse_contradictions(joint: Joint) -> None:
    """Raise ParameterError where effects on *joint* leave it no mass, or no travel.

    The equations keep a fifth of the mass whatever the payload, for the sake of fits that try
    values on their way; what a user declares is refused instead.
    """
    mass, more = joint.load.mass, _values(joint, payload.EFFECT)['mass']
    if mass + more < payload.LEAST_SHARE * mass:
        raise ParameterError(
            f'effects.payload.mass = {more:g} kg leaves {mass + more:g} kg of mass = '
            f'{mass:g} kg: give at least {(payload.LEAST_SHARE - 1.0) * mass:g} kg'
        )
    stop = _values(joint, end_stop.EFFECT)
    has_both = stop['stiffness'] > 0.0 and stop['lower_stiffness'] > 0.0
    if has_both and stop['lower'] >= stop['upper']:
        raise ParameterError(
            f'effects.end_stop.lower = {stop["lower"]:g} is not allowed: give less than '
            f'effects.end_stop.upper = {stop["upper"]:g}'
        )


def _values(joint: Joint, effect: Effect) -> dict[str, float]:
    """Return the parameters of an effect by name: those of the joint, or their defaults."""
    values = effect.values(joint.effects.get(effect.name, {}))
    return {p.name: value for p, value in zip(effect.parameters, values, strict=True)}
