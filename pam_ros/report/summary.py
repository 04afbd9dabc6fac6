# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The whole identification in one line."""

from pam_ros.identification.fit.places import spelled
from pam_ros.identification.result import Identification
from pam_ros.identification.verdict import moment_of
from pam_ros.report.wording import listed, number, scale_for


def last_line(result: Identification) -> str:
    """Return the verdict, and the error of each model on held-out data."""
    nominal, retuned, augmented = (stage.held_error for stage in result.stages)
    scale = scale_for(result.unit, augmented)
    names = [spelled(finding.name) for finding in result.effects]
    since = '' if result.since is None else f'from {moment_of(result)} on'
    words = ' '.join(word for word in (listed(names) if names else '', since) if word)
    found = f' ({words})' if words else ''
    errors = (
        f'{number(scale.factor * nominal)} {scale.unit} nominal, '
        f'{number(scale.factor * retuned)} {scale.unit} re-tuned'
    )
    if result.added:
        more = listed([spelled(name) for name in result.added])
        errors += f', {number(scale.factor * augmented)} {scale.unit} with {more}'
    floor = f'{number(scale.factor * result.noise.sigma)} {scale.unit}'
    return f'{result.verdict}{found}: held-out error {errors}; noise {floor}'
