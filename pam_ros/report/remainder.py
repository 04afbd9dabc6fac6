# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How much error the identified model leaves, and whether this is more than it should."""

from dataclasses import dataclass
from math import isfinite

from pam_ros.identification.identification import Identification
from pam_ros.identification.result import Verdict
from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.identification.structure import RATE, Structure
from pam_ros.identification.verdict import REMAINDER
from pam_ros.identification.wording import Scale, number, percent

# Share of a residual; a generic regressor that predicts less of it explains nothing that a model
# of the rig could use.
NOTHING = 0.05


@dataclass(frozen=True)
class Remainder:
    """A sentence on the error that is left, and whether it is a reason for caution."""

    sentence: str
    is_poor: bool


def remainder_of(result: Identification, scale: Scale) -> Remainder:
    """Return how much error the last model leaves on the data that no fit has used.

    It is poor if it is more than ``REMAINDER`` noise floors, which is more than the inexact form
    of the right laws leaves, or if the verdict is that something is not explained or cannot be
    decided.
    """
    last, noise = result.stages[-1], result.noise.sigma
    held = isfinite(last.held_error)
    left = last.held_error if held else last.fit_error
    where = 'On data that no fit has used' if held else 'On the fitted data, the only ones'
    floors = left / noise if noise > 0.0 else float('nan')
    digits = 2 if abs(floors - REMAINDER) > 0.1 else 3  # not "3.0: more than 3"
    times = f' ({number(floors, digits)} noise floors)' if isfinite(floors) else ''
    size = f'{where}, the identified model leaves an error of {scale.text(left)} {scale.unit}'
    start = size + times
    if result.verdict == Verdict.INSUFFICIENT_DATA:
        return Remainder(f'{start}, but these data cannot support a verdict.', True)
    if floors > REMAINDER:
        return Remainder(
            f'{start}: more than the inexact form of the laws explains, which is up to '
            f'{REMAINDER:g} noise floors. Something else is missing from the model, or these data '
            'differ from the fitted ones.',
            True,
        )
    if result.verdict == Verdict.UNEXPLAINED_STRUCTURE:
        tried = 'no effect of the library' if result.is_complete else 'none of the effects so far'
        return Remainder(f'{start}, and {tried} explains it.', True)
    if floors <= CRITERIA.complete:
        return Remainder(f'{start}: only the noise of the sensor is left.', False)
    if isfinite(floors):
        return Remainder(
            f'{start}: more than the noise of the sensor, but not more than the inexact form of '
            f'the laws explains, which is up to {REMAINDER:g} noise floors.',
            False,
        )
    return Remainder(f'{start}; the noise of the sensor is not known.', False)


def structure_in_words(structure: Structure, regressors: str) -> str:
    """Return what the residual of the last model consists of.

    *regressors* are the signals from which a generic regressor predicts it, as in a sentence.
    """
    noise = percent(1.0 - structure.share)
    # The share at which the whole residual is as large as that of a model that is complete.
    is_noise = structure.share <= 1.0 - 1.0 / CRITERIA.complete**2
    if structure.ceiling >= NOTHING and is_noise:
        return (
            f'{noise} of the variance of the remaining error is noise of the sensor. Of its means '
            f'over {1e3 / RATE:g} ms, {percent(structure.ceiling)} can be predicted from '
            f'{regressors}: a small effect may be left.'
        )
    if structure.ceiling >= NOTHING:
        return (
            f'{percent(structure.ceiling)} of the variance of the remaining error can be '
            f'predicted from {regressors}: the model lacks a law that depends on them. {noise} of '
            'it is noise of the sensor.'
        )
    if is_noise:
        return (
            f'Nothing predictable is left: {noise} of the variance of the remaining error is '
            'noise of the sensor.'
        )
    return (
        f'Only {noise} of the variance of the remaining error is noise of the sensor, but the '
        f'rest cannot be predicted from {regressors}: it depends on something that was not '
        'recorded, or in a way that the regressor does not contain.'
    )
