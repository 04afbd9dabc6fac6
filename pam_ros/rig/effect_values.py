# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The values of effects as they are given: where each acts, and from when on."""

from collections.abc import Mapping, Sequence

from pam_ros.arguments import instance
from pam_ros.effects import EFFECTS
from pam_ros.effects.base import ONSET, Effect
from pam_ros.errors import ParameterError

EffectValues = Mapping[str, Mapping[str, float]]


def refuse_other_than_effects(effects: EffectValues) -> None:
    """Raise ParameterError where *effects* are not tables of parameters by name."""
    example = "{'pressure_lag': {'fill': 0.1, 'vent': 0.2}}"
    instance('effects', effects, Mapping, f'effects with their parameters, such as {example}')
    for name, given in effects.items():
        instance(f'effects.{name}', given, Mapping, f'its parameters by name, as in {example}')


def split_effects(
    effects: EffectValues, library: Sequence[type[Effect]] = EFFECTS
) -> tuple[EffectValues, EffectValues]:
    """Return those of *effects* that act in a muscle, and those that act on the joint.

    Raises ParameterError for an effect that *library* does not have.
    """
    refuse_other_than_effects(effects)
    on_joint = {effect.name: effect.acts_on_joint() for effect in library}
    for name in effects:
        if name not in on_joint:
            raise ParameterError(
                f'effects.{name} is not known: give one of ' + ', '.join(on_joint)
            )
    return (
        {name: given for name, given in effects.items() if not on_joint[name]},
        {name: given for name, given in effects.items() if on_joint[name]},
    )


def onsets(effects: EffectValues, present: Sequence[type[Effect]]) -> set[float]:
    """Return the times in s after 0 at which those of *effects* begin to act that are *present*.

    *present* are the effects that act when all have begun.
    """
    names = {effect.name for effect in present}
    times = {given.get(ONSET.name, 0.0) for name, given in effects.items() if name in names}
    return times - {0.0}


def begun(effects: EffectValues, time: float) -> EffectValues:
    """Return those of *effects* that act at *time* s, as effects that have always acted."""
    return {
        name: {parameter: value for parameter, value in given.items() if parameter != ONSET.name}
        for name, given in effects.items()
        if given.get(ONSET.name, 0.0) <= time
    }
