# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The whole trace in one line."""

from pam_ros.identification.result import Trace
from pam_ros.report.wording import listed, number, scale_for


def last_line(trace: Trace) -> str:
    """Return the verdict, and the error on held-out data before and after."""
    declared, retuned, augmented = (stage.held_error for stage in trace.stages)
    scale = scale_for(trace.unit, augmented)
    names = [finding.name for finding in trace.effects]
    found = f' ({listed(names)})' if names else ''
    errors = (
        f'{number(scale.factor * declared)} {scale.unit} as declared, '
        f'{number(scale.factor * retuned)} {scale.unit} re-tuned'
    )
    if added(trace):
        errors += f', {number(scale.factor * augmented)} {scale.unit} with {listed(added(trace))}'
    floor = f'{number(scale.factor * trace.noise.sigma)} {scale.unit}'
    return f'{trace.verdict}{found}: held-out error {errors}; noise {floor}'


def added(trace: Trace) -> list[str]:
    """Return the names of the effects that the last model has beside the declared ones."""
    first, *_, last = (
        [effect.name for effect in stage.model.all_present] for stage in trace.stages
    )
    return [name for name in last if name not in first]
