# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How blind trials are scored: by the rules that the targets state."""

import numpy as np
import pytest

from benchmarks.tracing import (
    TARGETS,
    declared_model,
    is_right,
    pair_hits,
    recording_of,
    report,
    scores,
)
from truth import blind_trial


def row(kind, found=(), alternatives=None, **changes):
    """Return a trial's row; *kind* as in the benchmark, *found* the names in their order."""
    names = [] if kind == 'noise_only' else kind.split('+')
    given = {
        'kind': kind,
        'seed': 0,
        'accepted': [[name] for name in names],
        'in_library': True,
        'verdict': 'effect_found' if found else 'no_missing_effect',
        'found': list(found),
        'alternatives': [list(a) for a in alternatives or [()] * len(found)],
        'augmented': 1.1e-5,
        'noise': 1e-5,
        'seconds': 1.0,
    }
    return given | changes


@pytest.mark.parametrize(
    ('found', 'alternatives', 'right'),
    [
        (['creep'], [()], True),
        ([], [], False),
        (['leak'], [()], False),
        (['leak'], [('creep',)], True),  # a set of two that holds it
        (['leak'], [('slack', 'creep')], False),  # a set of three
        (['creep'], [('slack', 'leak')], True),  # first, whatever else
        (['leak', 'creep'], [(), ()], False),  # it must be first
        (['creep', 'leak'], [(), ()], True),
    ],
)
def test_a_single_effect(found, alternatives, right):
    assert is_right(row('creep', found, alternatives)) is right


def test_equations_that_are_two_effects_may_be_called_either():
    for name in ('leak', 'pressure_lag'):
        assert is_right(row('leak', [name], accepted=[['leak', 'pressure_lag']]))


@pytest.mark.parametrize(
    ('found', 'alternatives', 'hits', 'wrong'),
    [
        (['creep', 'leak'], [(), ()], 2, 0),
        (['leak', 'creep'], [(), ()], 2, 0),
        (['creep'], [()], 1, 0),
        ([], [], 0, 0),
        (['creep', 'slack'], [(), ()], 1, 1),
        (['creep', 'slack'], [(), ('leak',)], 2, 0),
        (['creep', 'slack'], [(), ('payload', 'leak')], 1, 1),
        (['creep', 'creep'], [(), ()], 1, 0),  # said twice: one hit, and not wrong
        (['creep', 'leak', 'slack'], [(), (), ()], 2, 1),
    ],
)
def test_a_pair(found, alternatives, hits, wrong):
    assert pair_hits(row('creep+leak', found, alternatives)) == (hits, wrong)


ROWS = [
    row('creep', ['creep']),
    row('creep', ['leak'], augmented=3e-5),
    row('leak', ['leak'], augmented=1.0e-5),
    row('noise_only'),
    row('noise_only', ['slack']),
    row('creep+leak', ['creep', 'leak']),
    row('creep+leak', ['creep']),
    row('creep+leak', ['creep', 'slack']),
    row('creep+leak'),
    row('cogging', verdict='unexplained_structure', in_library=False),
    row('cogging', ['creep'], in_library=False),
]


def test_scores_by_hand():
    values = list(scores(ROWS).values())
    assert values == pytest.approx([2 / 3, 1 / 2, 1 / 4, 2 / 4, 1 / 2, 1.1])
    assert list(scores(ROWS)) == list(TARGETS)


def test_what_was_not_tried_has_no_score():
    values = list(scores([row('noise_only')]).values())
    assert values[1] == 0.0
    assert np.isnan([values[k] for k in (0, 2, 3, 4, 5)]).all()


def test_the_report_says_what_is_reached_and_what_is_confused(capsys):
    report(ROWS)
    lines = capsys.readouterr().out.splitlines()
    for name in TARGETS:
        (line,) = [text for text in lines if name in text]
        assert line.endswith('reached' if 'median' in name else 'SHORT')
    (line,) = [text for text in lines if text.startswith('  creep ')]
    assert '1 x creep' in line
    assert '1 x leak' in line
    assert line.endswith('(2.05)')


def test_the_finder_is_given_what_a_user_has():
    trial = blind_trial('payload', 0, rate=100.0, duration=10.0)
    model, recording = declared_model(trial), recording_of(trial)
    # The published constants, not those of the specimen, and the mass without the payload.
    np.testing.assert_allclose(model.muscle.si, trial.declared.constants_si)
    assert not np.allclose(model.muscle.si, trial.constants_si, rtol=1e-3)
    assert model.load.mass == trial.mass
    assert model.all_effects == ()
    assert recording.kind == 'free'
    assert (recording.force, recording.pressure, recording.velocity) == (None, None, None)
    assert recording.t[0] == 0.0
    np.testing.assert_array_equal(recording.position, trial.recording.position_m)
    np.testing.assert_array_equal(recording.command, trial.recording.pressure_command_pa)
