# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A drawn scenario in words."""

from collections.abc import Callable, Mapping, Sequence
from math import degrees
from typing import Any

from pam_ros.bench.draw.effects import Given
from pam_ros.bench.draw.rig import Rig
from pam_ros.effects import EFFECTS
from pam_ros.rig.arrangements import ANTAGONISTIC, CRANK, LEVER, LOAD, PARALLEL

RIGS = {
    LOAD: '{} with {:.3g} kg',
    PARALLEL: 'two {} that lift {:.3g} kg',
    ANTAGONISTIC: 'two {} on a pulley with {:.3g} kg on an arm',
    LEVER: 'two {} on a lever with {:.3g} kg on an arm',
    CRANK: 'one {} on a lever with {:.3g} kg on an arm',
}
# How values are shown: a factor, and the unit after it.
SHOWN = {
    's': (1e3, ' ms'),
    'Pa': (1e-3, ' kPa'),
    '': (100.0, ' %'),
    'fraction': (100.0, ' % of the length'),
}
BY_NAME = {effect.name: effect for effect in EFFECTS}


def about(
    seed: int,
    rig: Rig,
    undeclared: Mapping[str, Any],
    hidden: Mapping[str, Given],
    declared: Mapping[str, Given],
    change: str,
    reference: Mapping[str, Any],
) -> str:
    """Return a sentence for each part of a scenario: rig, effects, a *change*, the reference.

    *undeclared* has the sensors and the rate. *hidden* are the effects that are not declared,
    *declared* those that are. *change* is a clause with its time, '' if there is none.
    """
    own = RIGS[rig.kind].format(rig.muscle, rig.declared['mass'])
    off = f'the force of the specimen is up to {100.0 * rig.mismatch:.2g} % off'
    sentences = [f'Drawn with seed {seed}: {own}; {off}.']
    for effects, word in ((hidden, 'not declared'), (declared, 'declared')):
        if effects:
            texts = [_effect(name, given, rig) for name, given in effects.items()]
            verb = 'is' if len(texts) == 1 else 'are'
            sentences.append(f'{_listed(texts)} {verb} {word}.')
    if change:
        sentences.append(f'{change}.')
    late = undeclared['sensor'].get('latency', 0.0)
    age = f', {1e3 * late:.2g} ms late' if late else ''
    sentences.append(f'States at {undeclared["publish_rate"]:g} Hz{age}.')
    sentences.append(f'{_reference(reference, rig)}.')
    return ' '.join(one[0].upper() + one[1:] for one in sentences)


def _listed(texts: Sequence[str]) -> str:
    return ', '.join(texts[:-1]) + ' and ' + texts[-1] if len(texts) > 1 else texts[0]


def _effect(name: str, given: Given, rig: Rig) -> str:
    """Return an effect with its greatest strength, such as 'coulomb friction of 12 N'."""
    parameters = BY_NAME[name].parameters(
        revolute=rig.is_revolute and BY_NAME[name].acts_on_joint()
    )
    for one in parameters:
        if one.strength and given.get(one.name):
            factor, unit = SHOWN.get(one.unit, (1.0, f' {one.unit}'))
            return f'{name.replace("_", " ")} of {factor * given[one.name]:.3g}{unit}'
    return name.replace('_', ' ')


def _reference(given: Mapping[str, Any], rig: Rig) -> str:
    """Return the reference in words."""

    def length(key: str) -> str:
        value = abs(given[key])
        return f'{degrees(value):.3g} degrees' if rig.is_revolute else f'{1e3 * value:.3g} mm'

    texts: dict[str, Callable[[], str]] = {
        'hold': lambda: 'the position at the start is held',
        'step': lambda: f'a step of {length("size")}',
        'staircase': lambda: f'{len(given["sizes"])} steps, one each {given["every"]:g} s',
        'sine': lambda: f'a sine of {length("amplitude")} at {given["frequency"]:g} Hz',
        'chirp': lambda: (
            f'a chirp of {length("amplitude")} from {given["frequency_low"]:g} to '
            f'{given["frequency_high"]:g} Hz'
        ),
        'minimum_jerk': lambda: f'a move of {length("size")} within {given["travel_time"]:g} s',
        'trajectory': lambda: f'a path through {len(given["times"])} points',
    }
    return texts[given['kind']]()
