# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of scores: what a file may say, and what does not keep it."""

import re

import pytest

from pam_ros.bench.limits import read_limits, shortfalls
from pam_ros.bench.outcome import Status
from pam_ros.errors import ParameterError
from support.outcomes import SCORES, results_of

NAMES = [score.name for score in SCORES]


def limits_of(tmp_path, text):
    path = tmp_path / 'limits.yaml'
    path.write_text(text, encoding='utf-8')
    return read_limits(path, ['step', 'turn'], NAMES)


def test_limits_are_by_scenario_and_score(tmp_path):
    text = "step: {error_at_rest: 3e-5, settling_time: 1}\n'*': {limit_violations: 0}"
    assert limits_of(tmp_path, text) == {
        'step': {'error_at_rest': 3e-5, 'settling_time': 1.0},
        '*': {'limit_violations': 0.0},
    }


@pytest.mark.parametrize(
    ('text', 'sentence'),
    [
        ('', ' has no limits: give them by scenario and score, such as friction_step: '),
        ('[1]', ' has no limits: '),
        ('step: 3', ', step has no limits: '),
        ('step: {}', ', step has no limits: '),
        ('stepp: {rms_error: 1}', ': stepp is not a scenario: was step meant?'),
        ('1: {rms_error: 1}', ': 1 is not a scenario: give one of step, turn'),
        ('step: {rms_eror: 1}', ', step: rms_eror is not a score: was rms_error meant?'),
        ("'*': {x: 1}", ', *: x is not a score: give one of error_at_rest, rms_error'),
        ('step: {rms_error: small}', ", step, rms_error = 'small' is not a limit: give a number"),
        ('step: {rms_error: true}', ', step, rms_error = True is not a limit'),
        ('step: {rms_error: }', ', step, rms_error = None is not a limit'),
        ('step: {rms_error: .nan}', ', step, rms_error = nan is not a limit'),
        ('step: {rms_error: .inf}', ', step, rms_error = inf is not a limit'),
        ('step: {rms_error: -1}', ', step, rms_error = -1 is not a limit'),
        pytest.param(
            'step: {rms_error: 1' + 400 * '0' + '}', ', step, rms_error = 1000', id='huge'
        ),
        ('step: {', ' is not valid YAML: '),
    ],
)
def test_a_file_that_is_not_valid_is_one_sentence(tmp_path, text, sentence):
    with pytest.raises(ParameterError, match=re.escape(f'limits.yaml{sentence}')):
        limits_of(tmp_path, text)


def test_each_limit_that_the_worst_seed_does_not_keep_is_one_sentence():
    results = results_of(
        {
            'step': {'a': [1e-5, 3e-5, 2e-5], 'b': [1e-5, 3.00001e-5, 1e-5], 'c': [1e-5, 1e-5]},
            'turn': {'a': [1e-3, 1e-3], 'b': [1e-5, Status.DIED], 'c': [1e-5, None]},
        },
        revolute={'turn'},
        others={'limit_violations': 0.5},
    )
    limits = {'step': {'error_at_rest': 3e-5}, '*': {'error_at_rest': 1e-4}}
    assert shortfalls(results, limits) == [
        'step: error at rest of b must be at most 0.0300000 mm, but is 0.0300001 mm with seed 1',
        'turn: error at rest of a must be at most 0.100 mrad, but is 1.00 mrad with seed 0',
        'turn: error at rest of b must be at most 0.100 mrad, but it died with seed 1 '
        '(its process ended with exit code 1)',
        'turn: error at rest of c must be at most 0.100 mrad, but it has no value with seed 1',
    ]
    assert shortfalls(results, {'step': {'limit_violations': 0.5}}) == []
    assert len(shortfalls(results, {'step': {'limit_violations': 0.0}})) == 3


def test_a_score_that_has_no_meaning_in_a_scenario_has_only_limits_that_name_it():
    results = results_of({'step': {'a': [None, None]}, 'turn': {'a': [1e-5, 2e-5]}})
    assert shortfalls(results, {'*': {'error_at_rest': 1e-4}, 'other': {'rms_error': 0.0}}) == []
    assert shortfalls(results, {'step': {'error_at_rest': 1e-4}}) == [
        'step: error at rest of a must be at most 0.100 mm, but it has no value with seed 0'
    ]


def test_a_controller_that_did_not_run_keeps_no_limit():
    results = results_of({'step': {'a': [1e-5]}, 'turn': {'b': [1e-5]}})
    assert shortfalls(results, {'step': {'error_at_rest': 1.0}}) == [
        'step: error at rest of b must be at most 1000 mm, but it did not run'
    ]
