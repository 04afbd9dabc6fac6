# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What has changed since an earlier bench is told beyond the spread, and only where it is fair."""

from dataclasses import replace

from pam_ros.bench.changes import changes
from pam_ros.bench.outcome import Status
from support.outcomes import results_of

OLD = results_of({'step': {'a': [1e-5, 1.2e-5, 1.1e-5], 'b': [2e-5, 2e-5, 2.4e-5]}})


def test_better_worse_and_within_the_spread():
    new = results_of({'step': {'b': [1e-5, 1e-5, 1.2e-5], 'a': [1.6e-5, 1.7e-5, 1.7e-5]}})
    assert changes(OLD, new) == [
        'step: error at rest of b is better: 0.0100 mm, before 0.0200 mm',
        'step: error at rest of a is worse: 0.0170 mm, before 0.0110 mm',
    ]
    mixed = results_of({'step': {'a': [1.3e-5, 1e-5, 1.2e-5], 'b': [2e-5, 2e-5, 2.4e-5]}})
    assert changes(OLD, mixed) == ['nothing has changed by more than the spread over the seeds']


def test_only_seeds_of_both_and_no_times_of_the_machine():
    slow = results_of({'step': {'a': [1e-5, 1.2e-5, 1.1e-5]}}, others={'computing_time': 9.0})
    fast = results_of({'step': {'a': [1e-5, 1.2e-5]}}, others={'computing_time': 1.0})
    assert changes(slow, fast) == ['nothing has changed by more than the spread over the seeds']


def test_failures_that_came_and_went():
    failed = results_of({'step': {'a': [1e-5, Status.DIED, 1.1e-5], 'b': [2e-5, 2e-5, 2.4e-5]}})
    ended = 'died (its process ended with exit code 1)'
    assert changes(OLD, failed) == [f'step: a {ended}, before it completed (seed 1)']
    assert changes(failed, OLD) == [f'step: a completed, before it {ended} (seed 1)']


def test_other_scenarios_and_controllers_are_not_compared():
    nothing = 'nothing is compared: no scenario and controller is in both'
    assert changes(OLD, results_of({'step': {'c': [1e-5]}})) == [nothing]
    assert changes(OLD, results_of({'sine': {'a': [1e-5]}})) == [nothing]
    source = replace(OLD.provenance, files={'step': 64 * 'b'})
    assert changes(replace(OLD, provenance=source), OLD) == [
        'step: not compared, the scenario itself has changed',
        nothing,
    ]
