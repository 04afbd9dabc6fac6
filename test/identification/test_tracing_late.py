# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How trials with effects that begin in the middle are scored, and what they are."""

import numpy as np
import pytest

from benchmarks.tracing_late import TARGETS, is_named, is_near, is_wrong, scores
from truth import LATE, TruthPlant, late_trial


def row(found=(), since=None, **changes):
    """Return a trial's row: a leak begins at 20 s, and shows at 40 s."""
    given = {
        'accepted': [['leak', 'pressure_lag']],
        'onset': 20.0,
        'shows': 40.0,
        'verdict': 'effect_found' if found else 'unexplained_structure',
        'found': list(found),
        'alternatives': [()] * len(found),
        'since': None if since is None else [since - 0.2, since, since + 0.2],
    }
    return given | changes


@pytest.mark.parametrize(
    ('since', 'near'),
    [(None, False), (20.9, True), (19.1, True), (21.1, False), (39.5, True), (30.0, False)],
)
def test_a_moment_is_near_the_true_one_or_the_one_at_which_it_shows(since, near):
    assert is_near(row(['leak'], since)) is near


@pytest.mark.parametrize(
    ('found', 'alternatives', 'named', 'wrong'),
    [
        (['leak'], [()], True, False),
        (['pressure_lag'], [()], True, False),
        (['creep'], [()], False, True),
        (['creep'], [('leak',)], True, False),
        (['creep'], [('slack', 'leak')], False, True),
        (['leak', 'creep'], [(), ()], False, True),
        ([], [], False, False),
    ],
)
def test_a_name_counts_alone_or_in_a_set_of_two(found, alternatives, named, wrong):
    one = row(found, 20.0, alternatives=alternatives)
    assert (is_named(one), is_wrong(one)) == (named, wrong)


def test_the_figures_are_shares():
    rows = [
        row(['leak'], 20.1),
        row(['leak'], 20.5),  # its interval misses the moment
        row(['leak']),  # no moment
        row(['creep'], 20.1),
        row([], 40.3),
    ]
    figures = dict(zip(TARGETS, (0.6, 0.4, 0.8, 0.5), strict=True))
    assert scores(rows) == pytest.approx(figures)


@pytest.mark.parametrize('kind', LATE)
def test_until_the_moment_nothing_is_there(kind):
    late = late_trial(kind, 3)
    trial, recording = late.trial, late.trial.recording
    t = recording.t_s - recording.t_s[0]
    plain = TruthPlant(
        trial.constants_si, trial.mass, trial.zeta, p0=recording.pressure_command_pa[0]
    ).run(recording.t_s, recording.pressure_command_pa)
    moved = np.abs(recording.truth['position_m'] - plain.y)
    assert 0.19 * t[-1] < late.onset < 0.61 * t[-1]
    assert moved[t <= late.onset].max() < 1e-12
    assert moved[t < late.shows].max() <= 3.0 * trial.noise
    assert moved[t >= late.shows][0] > 3.0 * trial.noise
    assert late.onset <= late.shows <= t[-1]
