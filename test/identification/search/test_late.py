# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Searches for effects that begin late, at once or over some seconds, on the truth plant."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.fit.onset import index_of_onset
from pam_ros.identification.search.criteria import CRITERIA
from pam_ros.identification.search.late import (
    Late,
    begins_late,
    explains_transition,
    find_late_effects,
    leaves_only_noise,
)
from pam_ros.identification.search.moves import with_each
from pam_ros.identification.search.onset import OnsetEstimate, estimate_onset
from pam_ros.identification.search.search import Search
from support import bench_truth, searches
from support.marks import at_release
from truth import effect

ONSET = 17.0
SHARES = CRITERIA.fit, CRITERIA.choose


@pytest.fixture(scope='module')
def late_of(pool):
    """Return a function that estimates the onset in a recording."""
    specimen = bench_truth.nominal(off=0.02 * np.array([1, -1, 1, 1, -1, 1]))

    def late_of(recording):
        setting = searches.setting_of([recording], pool, specimen)
        since = estimate_onset(setting)
        return Late(setting, since, recording, SHARES, CRITERIA.duration)

    return late_of


@pytest.mark.parametrize(('transition', 'is_possible'), [(0.0, True), (8.0, True), (16.0, False)])
def test_enough_must_come_after_a_transition(pool, transition, is_possible):
    """5 s must be fitted, of those that come after it."""
    recording = bench_truth.free(duration=40.0)
    setting = searches.setting_of([recording], pool)
    since = OnsetEstimate(20.0, 19.8, 20.1)
    late = Late(setting, since, recording, SHARES, CRITERIA.duration)
    after = late.setting_after(transition)
    assert (after is not None) is is_possible
    if after is not None:
        assert after.onset == 20.0
        assert after.transition == ((19.8, 28.0) if transition else None)


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(
    'one',
    [
        effect('viscous_friction'),
        at_release(effect('payload', payload_kg=-4.0)),
        at_release(effect('leak', 'refill')),
    ],
    ids=lambda one: one.kind,
)
def test_what_begins_is_named_with_its_moment(late_of, one):
    recording = bench_truth.late(one, ONSET)
    found = find_late_effects(late_of(recording))
    assert found.setting.transition is None
    assert found.best.effects == (one.kind,)
    k = index_of_onset(found.best.solution)
    unknown = found.best.solution.problem.unknowns[k]
    assert unknown.value(found.best.solution.u[k]) == pytest.approx(ONSET, abs=0.05)


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(('within', 'is_explained'), [(0.0, True), (2.0, False), (7.0, False)])
def test_no_jump_explains_a_transition_in_which_an_effect_develops(late_of, within, is_explained):
    recording = bench_truth.late(effect('payload', payload_kg=4.0), ONSET, within=within)
    late = late_of(recording)
    jump, after = (_with_payload(late.setting_after(seconds)) for seconds in (0.0, 8.0))
    assert begins_late(after)
    assert leaves_only_noise(after)
    assert leaves_only_noise(jump) is is_explained
    assert explains_transition(after, jump) is is_explained
    assert after.best.effects == ('payload',)
    # Nothing develops any longer in the seconds that only a longer transition leaves out.
    longer = replace(after, setting=replace(after.setting, transition=(ONSET, 30.0)))
    assert explains_transition(longer, after)


def _with_payload(setting):
    retuned = searches.retuned_of(setting)
    return Search(setting, retuned, with_each(retuned, ['payload'], setting)[0])


@pytest.mark.release
@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize(
    'one',
    [
        effect('pressure_offset', regulator_pa=0.0, regulator_gain=0.91),
        effect('viscous_friction'),
    ],
    ids=lambda one: one.kind,
)
def test_what_develops_is_named_and_no_effect_that_jumps(late_of, one):
    recording = bench_truth.late(one, ONSET, duration=60.0, within=4.0)
    found = find_late_effects(late_of(recording))
    assert found.best.effects == (one.kind,)
    start, end = found.setting.transition
    # A friction is visible only when the load moves.
    assert ONSET - 0.5 < start <= ONSET + 1.5
    assert end == found.setting.onset + 8.0
    assert found.best.errors.fit < 2.0 * found.setting.noise


@pytest.mark.release
@pytest.mark.slow
@pytest.mark.needs_numba
def test_what_develops_until_the_end_is_not_named(late_of):
    """Too little of the recording has the full strength."""
    loss = effect('pressure_offset', regulator_pa=0.0, regulator_gain=0.91)
    recording = bench_truth.late(loss, 26.0, within=8.0)
    found = find_late_effects(late_of(recording))
    assert found.best.effects == ()


@pytest.mark.release
@pytest.mark.slow
@pytest.mark.needs_numba
def test_an_end_stop_that_is_met_late_was_there_from_the_start(late_of):
    """The load meets it for the first time in the middle, which looks like something that begins.

    Both models explain it; that which needs no moment is the plainer one.
    """
    whole = bench_truth.free(seed=0, duration=40.0)
    highest = np.maximum.accumulate(whole.position)
    stop = 0.5 * (highest[int(0.3 * whole.t.size)] + highest[-1])
    assert whole.t[np.argmax(highest > stop)] > 8.0
    recording = bench_truth.free(effect('end_stop', stop_m=float(stop)), duration=40.0)
    late = late_of(recording)
    found = find_late_effects(late)
    assert found.best.effects == ('end_stop',)
    assert found.setting is late.setting
