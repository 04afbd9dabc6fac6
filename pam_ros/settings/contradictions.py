# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values that are allowed one by one, and together make no joint."""

from typing import TypeVar

from pam_ros.effects.base import Effect
from pam_ros.effects.end_stop import EndStop
from pam_ros.effects.payload import LEAST_SHARE, Payload
from pam_ros.errors import ParameterError
from pam_ros.rig.joint import Joint

E = TypeVar('E', bound=Effect)


def refuse_contradictions(joint: Joint) -> None:
    """Raise ParameterError where effects on *joint* leave it no mass, or no travel.

    The equations keep a fifth of the mass whatever the payload, for the sake of fits that try
    values on their way; what a user declares is refused instead.
    """
    mass, more = joint.load.mass, _of(joint, Payload()).mass
    if mass + more < LEAST_SHARE * mass:
        raise ParameterError(
            f'effects.payload.mass = {more:g} kg leaves {mass + more:g} kg of mass = '
            f'{mass:g} kg: give at least {(LEAST_SHARE - 1.0) * mass:g} kg'
        )
    stop = _of(joint, EndStop())
    if stop.stiffness > 0.0 and stop.lower_stiffness > 0.0 and stop.lower >= stop.upper:
        raise ParameterError(
            f'effects.end_stop.lower = {stop.lower:g} is not allowed: give less than '
            f'effects.end_stop.upper = {stop.upper:g}'
        )


def _of(joint: Joint, absent: E) -> E:
    """Return the effect on *joint* that is of the kind of *absent*, or that one."""
    return next((effect for effect in joint.effects if isinstance(effect, type(absent))), absent)
