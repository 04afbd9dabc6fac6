# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One slow rise and fall of the pressure: what is fitted contains both."""

import pytest

from benchmarks.tracing import nominal_model, recording_of
from pam_ros.identification.identify import identify
from truth import slow_trial

pytestmark = [pytest.mark.needs_numba, pytest.mark.slow]


def test_a_hysteresis_is_found_in_one_slow_cycle():
    """Fitted to the rise alone, it would be refuted by the fall."""
    trial = slow_trial('hysteresis', 0)
    found = identify(nominal_model(trial), [recording_of(trial)])
    assert found.verdict == 'effect_found'
    assert [one.name for one in found.effects] == ['pressure_hysteresis']
    assert found.stages[2].held_error < 1.2 * trial.noise < 0.2 * found.stages[1].held_error


def test_a_slow_error_that_blocks_interpolate_is_no_effect():
    """A backlash is not in the library; friction fits the blocks, and not what follows them."""
    trial = slow_trial('backlash', 0)
    found = identify(nominal_model(trial), [recording_of(trial)])
    assert found.verdict == 'unexplained_structure'
