# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The warning about commands that are known only once in a row."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.command_times import of_command_times
from support import results

PERIOD = 5e-3  # s


def answer_with(error, in_rows=True, **changes):
    """Return an unexplained result whose last model has this held-out error in m."""
    found = results.friction_result()[0]
    (recording,) = found.recordings
    stamps = recording.t if in_rows else recording.t[::7]
    at = np.searchsorted(recording.command_t, stamps, side='right') - 1
    recording = replace(recording, command_t=stamps, command=recording.command[at])
    last = replace(found.stages[-1], held_error=error)
    return replace(
        found,
        verdict='unexplained_structure',
        recordings=(recording,),
        stages=(*found.stages[:2], last),
        **changes,
    )


def expected_of(answer):
    """Return the error in m of a uniformly distributed time within a period before each row."""
    run, (segment,) = answer.stages[-1].simulated[0], answer.segments
    late = np.linspace(0.0, PERIOD, 201)
    moved = [np.interp(segment.t - d, segment.t, run) - run for d in late]
    return float(np.sqrt(np.mean(np.square(moved))))


def test_an_error_that_these_times_can_cause_is_warned_of():
    answer = answer_with(1e-4)
    expected = expected_of(answer)
    (warning,) = of_command_times(answer_with(1.8 * expected))
    assert 'its time is known to 5 ms only' in warning
    assert f'an error of {1e3 * expected:.2g} mm' in warning
    assert of_command_times(answer_with(2.2 * expected)) == []


@pytest.mark.parametrize(
    'other',
    [
        {'in_rows': False},
        {'quantity': 'force'},
    ],
    ids=['commands with their own stamps', 'a force'],
)
def test_of_other_errors_nothing_is_said(other):
    assert of_command_times(answer_with(1e-6, **other)) == []


def test_an_error_that_is_explained_is_not_warned_of():
    assert of_command_times(replace(answer_with(1e-6), verdict='effect_found')) == []
