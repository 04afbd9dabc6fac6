# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The segments of an identification as the report sees them."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.result import Estimate
from pam_ros.report.runs import runs_of, sizes


def test_held_out_is_the_part_that_judges(friction):
    result, _, runs = friction
    assert len(runs) == 1
    assert np.array_equal(runs[0].held, ~result.segments[0].fit)
    assert runs[0].held.mean() == pytest.approx(0.25, abs=0.01)


def test_held_out_is_the_test_recording_where_there_is_one(tested):
    result, _, runs = tested
    assert [run.is_test for run in runs] == [False, False, True]
    assert [bool(run.held.all()) for run in runs] == [False, False, True]
    assert not runs[0].held.any()
    assert runs[2].name == 'other.csv'
    assert runs[2].target is result.test[0].target


def test_effects_begin_in_what_was_fitted_and_not_in_tests(tested):
    result, _, runs = tested
    assert [run.since for run in runs] == [None, None, None]
    late = runs_of(replace(result, since=Estimate(5.0, 4.9, 5.1, 's')))
    assert [run.since for run in late] == [5.0, 5.0, None]


def test_residual_is_measured_less_simulated(friction):
    result, _, runs = friction
    segment = result.segments[0]
    for k, stage in enumerate(result.stages):
        assert np.array_equal(runs[0].residual(k), segment.target - stage.simulated[0])


def test_sizes_are_the_stages_own_errors(any_result):
    result, _, runs = any_result
    for k, stage in enumerate(result.stages):
        fit, held = sizes(runs, k)
        assert fit.rmse == pytest.approx(stage.fit_error, rel=1e-12)
        assert held.rmse == pytest.approx(stage.held_error, rel=1e-12)
        assert fit.low <= fit.rmse <= fit.high
        assert fit.rmse <= fit.maximum


def test_inputs_of_a_free_load(friction):
    result, _, (run,) = friction
    segment = result.segments[0]
    last = result.stages[2].simulated[0]
    assert run.position == pytest.approx(last)
    # The integral of the velocity is the way.
    way = np.sum(0.5 * (run.velocity[1:] + run.velocity[:-1]) * np.diff(run.t))
    assert way == pytest.approx(last[-1] - last[0], abs=1e-4)
    for k in (0, 777, run.t.size - 1):
        holding = segment.drive[segment.drive_t <= run.t[k]][-1]
        assert run.pressures[k] == holding


def test_inputs_of_a_held_length_are_measured(held):
    result, _, runs = held
    contractions = [run.position[0] / 0.4 for run in runs]
    assert contractions == pytest.approx([0.02, 0.1, 0.18])
    for run, s in zip(runs, result.segments, strict=True):
        np.testing.assert_array_equal(run.pressures[:, 0], s.pressure)
        np.testing.assert_array_equal(run.drive, s.pressure)
    assert runs_of(result)[0].velocity.max() == 0.0
