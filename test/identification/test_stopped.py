# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Identifications that the user stops: the best model so far is the result, and marked as such."""

from dataclasses import replace

import pytest

from pam_ros.identification.fit.solve import FitStatus
from pam_ros.identification.identify import identify
from pam_ros.identification.search.search import find_effects
from pam_ros.identification.summary import last_line
from pam_ros.identification.work import Work
from pam_ros.identification.workers import Workers
from support import bench_truth
from support.marks import at_release
from support.searches import setting_of
from truth import effect

pytestmark = [pytest.mark.needs_numba, pytest.mark.slow]
NOISE = 20e-6  # m
OFF = [0.01, -0.015, 0.005, 0.01, -0.01, 0.015]
LAG = effect('pressure_lag', 'two_times', fill_s=0.05, vent_s=0.07)


class StopAt:
    """Requests the end when a step begins, or after some simulations of it."""

    def __init__(self, text, simulations=0):
        self.text, self.rest = text, simulations
        self.steps = []

    def progress(self, share, text):
        if text not in self.steps[-1:]:
            self.steps.append(text)

    def stop(self):
        if any(self.text in step for step in self.steps):
            self.rest -= 1
            return self.rest < 0
        return False


def stopped_at(text, recording, simulations=0):
    """Return what is identified in *recording* until this step begins, and the steps."""
    at = StopAt(text, simulations)
    model = bench_truth.nominal(off=OFF)
    found = identify(model, recording, progress=at.progress, stop=at.stop)
    return found, at.steps


@pytest.mark.parametrize('simulations', [0, 300], ids=['at its first simulation', 'later'])
def test_a_search_that_is_stopped_in_its_first_round_has_only_re_tuned(simulations):
    at = StopAt('trying', simulations)
    work = Work(at.progress, stop=at.stop)
    with Workers(work.update) as pool:
        setting = setting_of([bench_truth.free(LAG, seed=2, duration=20.0)], pool)
        found = find_effects(replace(setting, work=work))
    assert work.is_stopped
    assert found.best is found.retuned
    assert found.evaluated == [found.retuned]
    assert found.best.errors.fit > 10.0 * NOISE  # errors can still be computed


def test_what_was_accepted_before_the_end_is_reported_and_marked():
    found, steps = stopped_at('confirming', bench_truth.free(LAG, seed=4))
    assert not found.is_complete
    assert steps[-3:] == [
        'the search was stopped',
        'fitting the chosen models in full',
        'done',
    ]
    assert found.verdict == 'effect_found'
    (lag,) = found.effects
    assert lag.name == 'pressure_lag'
    assert lag.parameters['fill'].value == pytest.approx(0.05, rel=0.02)
    assert found.stages[2].held_error < 1.2 * NOISE
    assert found.stages[2].log.status != FitStatus.NOT_FITTED
    assert found.sentence.startswith('Incomplete: the search was stopped before it ended')
    assert last_line(found).startswith('incomplete, the search was stopped: effect_found (')
    assert found.next_experiment.startswith('Identify again without stopping')
    assert found.next_command == ''


def test_without_an_effect_the_library_is_not_said_to_have_none():
    found, _ = stopped_at('round 1', bench_truth.free(LAG, seed=4, duration=20.0), 100)
    assert (found.is_complete, found.verdict) == (False, 'unexplained_structure')
    assert found.candidates == ()
    assert 'none of the effects so far explains' in found.sentence


@pytest.mark.parametrize('step', ['pressures: trying', at_release('motion: trying')])
def test_effects_of_the_signals_so_far_are_joined(step):
    recording = bench_truth.with_pressures(LAG, seed=1, duration=30.0)
    found, steps = stopped_at(step, recording)
    assert not found.is_complete
    assert [one.name for one in found.effects] == (['pressure_lag'] if 'motion' in step else [])
    assert not any('not used' in warning for warning in found.warnings)
    assert not any('both: trying' in one for one in steps)


@pytest.mark.parametrize('step', ['round 1', at_release('confirming')])
def test_a_search_for_what_begins_late_can_be_stopped(step):
    recording = bench_truth.late(effect('payload', payload_kg=-4.0), 15.0, duration=36.0)
    found, _ = stopped_at(step, recording)
    assert not found.is_complete
    if step == 'confirming':
        assert [one.name for one in found.effects] == ['payload']
        assert found.since.value == pytest.approx(15.0, abs=0.1)
    else:
        assert found.effects == ()


def test_a_search_that_has_ended_is_complete_although_the_end_was_requested():
    found, steps = stopped_at('fitting the chosen', bench_truth.free(seed=4, duration=20.0))
    assert found.is_complete
    assert 'the search was stopped' not in steps
    assert not found.sentence.startswith('Incomplete')
