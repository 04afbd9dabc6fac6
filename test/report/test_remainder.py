# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is left of the error, in words: each case has a sentence that is true of its numbers."""

from dataclasses import replace

import pytest

from pam_ros.identification.data.noise import Noise
from pam_ros.identification.result import Verdict
from pam_ros.identification.structure import Structure
from pam_ros.identification.wording import Scale
from pam_ros.report.remainder import remainder_of, structure_in_words

MM = Scale(1e3, 'mm')
SIGNALS = 'pressure and time'


def left(result, floors, verdict=Verdict.EFFECT_FOUND, noise=5e-5):
    last = replace(result.stages[-1], held_error=floors * 5e-5, fit_error=1e-3)
    changed = replace(
        result, noise=Noise(noise, 0.0), verdict=verdict, stages=(*result.stages[:2], last)
    )
    return remainder_of(changed, MM)


@pytest.mark.parametrize(
    ('floors', 'is_poor', 'words'),
    [
        (1.0, False, '0.0500 mm (1.0 noise floors): only the noise of the sensor is left.'),
        (2.0, False, '0.100 mm (2.0 noise floors): more than the noise of the sensor, but not'),
        (8.2, True, '0.410 mm (8.2 noise floors): more than the inexact form of the laws'),
    ],
)
def test_error_is_stated_in_both_units_and_judged(friction, floors, is_poor, words):
    found = left(friction[0], floors)
    assert found.sentence.startswith('On data that no fit has used, the identified model leaves')
    assert words in found.sentence
    assert found.is_poor is is_poor


def test_a_small_error_that_no_effect_explains_is_poor(friction):
    found = left(friction[0], 2.0, Verdict.UNEXPLAINED_STRUCTURE)
    assert found.is_poor
    assert found.sentence.endswith('and no effect of the library explains it.')


def test_insufficient_data_never_look_like_a_good_result(friction):
    found = left(friction[0], 1.0, Verdict.INSUFFICIENT_DATA)
    assert found.is_poor
    assert 'cannot support a verdict' in found.sentence


def test_without_held_out_data_the_fitted_ones_are_named(friction):
    found = left(friction[0], float('nan'))
    assert found.sentence.startswith('On the fitted data, the only ones,')
    assert '1.00 mm (20 noise floors)' in found.sentence


def test_without_a_noise_floor_there_is_none_in_the_sentence(friction):
    found = left(friction[0], 1.0, noise=0.0)
    assert 'floors' not in found.sentence
    assert not found.is_poor


@pytest.mark.parametrize(
    ('ceiling', 'share', 'words'),
    [
        (0.0, 0.057, 'Nothing predictable is left: 94 % of the variance'),
        (0.3, 0.057, '94 % of the variance of the remaining error is noise of the sensor. Of its'),
        (0.71, 0.96, '71 % of the variance of the remaining error can be predicted from pressure'),
        (0.0, 0.96, 'Only 4.0 % of the variance of the remaining error is noise of the sensor,'),
    ],
)
def test_structure_has_a_sentence_for_each_case(ceiling, share, words):
    assert structure_in_words(Structure(ceiling, 0.0, share), SIGNALS).startswith(words)
