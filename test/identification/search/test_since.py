# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Since when a model fails, on recordings of the truth plant."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.fit.onset import index_of_onset, keeping_onset
from pam_ros.identification.fit.solve import converge
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.onset import (
    OnsetEstimate,
    estimate_onset,
    shares_after,
)
from pam_ros.identification.search.starts import screen
from support import bench_truth, searches
from truth import effect

ONSET = 17.0
SHARES = CRITERIA.fit, CRITERIA.choose


@pytest.fixture(scope='module')
def setting_of(pool):
    """Return a function that makes the setting of a search of recordings."""
    specimen = bench_truth.nominal(off=0.02 * np.array([1, -1, 1, 1, -1, 1]))
    return lambda *recordings, shares=SHARES: searches.setting_of(
        recordings, pool, specimen, *shares
    )


@pytest.mark.needs_numba
@pytest.mark.parametrize(
    'one',
    [
        effect('coulomb_friction'),
        effect('viscous_friction'),
        effect('payload', payload_kg=-5.0),
        effect('pressure_offset', regulator_pa=0.0, regulator_gain=0.93),
        effect('backlash'),
        effect('saturation'),
    ],
    ids=lambda one: one.kind,
)
def test_a_model_fails_from_the_moment_on(setting_of, one):
    """Whether or not the library has the effect."""
    found = estimate_onset(setting_of(bench_truth.late(one, ONSET)))
    assert found.time == pytest.approx(ONSET, abs=0.5)
    assert found.low <= found.time <= found.high
    assert found.low - 0.2 <= ONSET <= found.high


@pytest.mark.needs_numba
@pytest.mark.parametrize(
    'effects',
    [
        (),
        (effect('pressure_lag'),),
        (effect('hysteresis', 'slip'),),
        (effect('coulomb_friction'), effect('creep', 'pressure')),
    ],
    ids=lambda effects: '+'.join(one.kind for one in effects) or 'noise',
)
def test_what_is_there_from_the_start_has_no_moment(setting_of, effects):
    assert estimate_onset(setting_of(bench_truth.free(*effects, seed=5, duration=40.0))) is None


@pytest.mark.needs_numba
def test_a_gap_does_not_hide_a_moment(setting_of):
    whole = bench_truth.late(effect('coulomb_friction'), ONSET)
    for gap in (10.0, 25.0):
        keep = (whole.t < gap) | (whole.t > gap + 0.5)
        ends = float(whole.t[whole.t < gap][-1]), float(whole.t[whole.t > gap + 0.5][0])
        cut = replace(whole, t=whole.t[keep], position=whole.position[keep], gaps=(ends,))
        assert len(setting_of(cut).parts) == 2
        assert estimate_onset(setting_of(cut)).time == pytest.approx(ONSET, abs=0.5)


@pytest.mark.needs_numba
def test_only_one_recording_of_a_free_load_has_a_moment(setting_of):
    """Of two it is not known which came first, and held ones are not run on."""
    one = bench_truth.late(effect('coulomb_friction'), ONSET)
    assert estimate_onset(setting_of(one, replace(one, name='again.csv'))) is None
    held = bench_truth.held()
    assert estimate_onset(setting_of(held)) is None


def test_the_shares_are_of_what_comes_after(setting_of):
    setting = setting_of(bench_truth.free(duration=40.0))
    length = setting.parts[0].segment.t[-1]
    fit, choose = shares_after(OnsetEstimate(20.0, 19.9, 20.1), setting.parts, (0.5, 0.75), 5.0)
    assert fit * length == pytest.approx(20.0 + 0.5 * (length - 20.0))
    assert choose * length == pytest.approx(20.0 + 0.75 * (length - 20.0))
    # With test recordings all of it is fitted or decides, to the last sample.
    assert shares_after(OnsetEstimate(17.3, 17.2, 17.4), setting.parts, (0.73, 1.0), 5.0)[1] == 1.0
    # Less than 5 s of it would be fitted.
    assert shares_after(OnsetEstimate(31.0, 30.9, 31.1), setting.parts, (0.5, 0.75), 5.0) is None


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('name', ['payload', 'creep'])
def test_cheap_fits_keep_the_onset(name, setting_of):
    """Their steps are large: a payload ended in a minimum a second before the right onset."""
    recording = bench_truth.late(effect('payload', payload_kg=-4.0), ONSET)
    since = estimate_onset(setting_of(recording))
    late = replace(setting_of(recording, shares=(0.8, 0.9)), onset=since.time)
    start = searches.at_nominal(late.problem)
    found = screen(late.model((), keeping_onset(start, converge)), late.places[name], late)
    assert found
    for one in found:
        k = index_of_onset(one)
        onset, (low, high) = one.problem.unknowns[k], one.problem.bounds
        assert onset.value(one.u[k]) == since.time
        # The fits that follow may move it.
        assert low[k] < one.u[k] < high[k]
    if name == 'payload':
        end = converge(found[0], BUDGET.iterations)
        k = index_of_onset(end)
        assert end.problem.unknowns[k].value(end.u[k]) == pytest.approx(ONSET, abs=0.01)
