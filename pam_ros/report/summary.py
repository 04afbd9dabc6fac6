# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The whole identification in one line."""

from pam_ros.identification.fit.places import effect_of, muscle_of, place_of, spelled
from pam_ros.identification.result import Identification
from pam_ros.identification.verdict import time_of
from pam_ros.report.wording import listed, number, scale_for


def last_line(result: Identification) -> str:
    """Return the verdict, and the error of each model on held-out data."""
    nominal, retuned, augmented = (stage.held_error for stage in result.stages)
    scale = scale_for(result.unit, augmented)
    names = [spelled(finding.name) for finding in result.effects]
    since = '' if result.since is None else f'from {time_of(result.since)} on'
    words = ' '.join(word for word in (listed(names) if names else '', since) if word)
    found = f' ({words})' if words else ''
    errors = (
        f'{number(scale.factor * nominal)} {scale.unit} nominal, '
        f'{number(scale.factor * retuned)} {scale.unit} re-tuned'
    )
    if added(result):
        more = listed([spelled(name) for name in added(result)])
        errors += f', {number(scale.factor * augmented)} {scale.unit} with {more}'
    floor = f'{number(scale.factor * result.noise.sigma)} {scale.unit}'
    return f'{result.verdict}{found}: held-out error {errors}; noise {floor}'


def added(result: Identification) -> list[str]:
    """Return the names of the places of the effects that were added to the last model.

    If an effect is alike in all muscles, each muscle still has its own initial value of the
    effect. These are not counted as further places.
    """
    found = dict.fromkeys(place_of(name) for name in result.stages[-1].parameters)
    return [name for name in found if name and not (muscle_of(name) and effect_of(name) in found)]
