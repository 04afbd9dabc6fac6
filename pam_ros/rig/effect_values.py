# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The given effects of a joint and its library: their check, where each acts, when it begins."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pam_ros.arguments import refuse, sequence
from pam_ros.effects import EFFECTS
from pam_ros.effects.base import ONSET, Effect
from pam_ros.effects.names import EffectName
from pam_ros.errors import ParameterError
from pam_ros.similar_names import not_known


def checked_effects(effects: Sequence[Effect]) -> tuple[Effect, ...]:
    """Return *effects* as a tuple; raises ParameterError for other types and duplicates."""
    found = sequence('effects', effects, Effect, 'an effect, such as PressureLag(fill=0.1)')
    for i, effect in enumerate(found):
        if any(type(effect) is type(other) for other in found[:i]):
            raise ParameterError(f'effects[{i}] is a second {effect.name}: give one of each')
    return found


def library_of(library: Sequence[type[Effect]]) -> tuple[type[Effect], ...]:
    """Return *library* as a tuple; raises ParameterError if an entry is not a valid Effect."""
    found = sequence('library', library, type, 'an Effect, such as those of EFFECTS')
    for i, effect in enumerate(found):
        if not issubclass(effect, Effect):
            refuse(f'library[{i}]', effect, 'an Effect, such as those of EFFECTS')
        effect.parameters()  # raises ParameterError for an incomplete one
    return found


def effects_from(
    values: Mapping[str, Mapping[str, float]], library: Sequence[type[Effect]] = EFFECTS
) -> tuple[Effect, ...]:
    """Return the effects of *values*, by the names of effects and then of their parameters.

    They are in the order of the *library*. Raises ParameterError for an effect that is not in
    the library, for an unknown parameter, and for a value out of range.
    """
    known = {effect.name: effect for effect in library}
    for name, given in values.items():
        if name not in known:
            raise not_known(f'effects.{name}', name, known)
        names = [p.name for p in (*known[name].parameters(), ONSET)]
        for parameter in given:
            if parameter not in names:
                raise not_known(EffectName(name, parameter).flat, parameter, names)
    return tuple(effect(**values[name]) for name, effect in known.items() if name in values)


def split_effects(
    effects: Sequence[Effect],
) -> tuple[tuple[Effect, ...], tuple[Effect, ...]]:
    """Return those of *effects* that act in a muscle, and those that act on the joint."""
    checked = checked_effects(effects)
    return (
        tuple(effect for effect in checked if not effect.acts_on_joint()),
        tuple(effect for effect in checked if effect.acts_on_joint()),
    )


def onsets(effects: Sequence[Effect]) -> set[float]:
    """Return the times in s after 0 at which the present ones of *effects* begin to act."""
    return {effect.onset for effect in effects if effect.is_present} - {0.0}


def begun(effects: Sequence[Effect], time: float) -> tuple[Effect, ...]:
    """Return those of *effects* that act at *time* s, with their onsets set to 0."""
    return tuple(replace(effect, onset=0.0) for effect in effects if effect.onset <= time)
