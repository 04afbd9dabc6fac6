# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which controller is best: rarely a wrong one, and none where nothing is known."""

import numpy as np
import pytest
from scipy.stats import quantile_test

from pam_ros.bench.compare import (
    LEAST,
    best,
    compared,
    is_lower,
    median_interval,
    standings,
)
from pam_ros.bench.outcome import Status
from support.outcomes import results_of

DIED = Status.DIED
DRAWS = 1500


def marked(scores):
    """Return the row of *scores* (controllers, seeds) that is lower than each other, or None."""
    for k, one in enumerate(scores):
        if all(is_lower(one, other) for j, other in enumerate(scores) if j != k):
            return k
    return None


def equal(rng, kind, n):
    """Draw the scores of 2 equal controllers, or of 5 of which the first 2 are equal, and best."""
    if kind == 'lognormal':  # a seed that is harder for one is harder for all
        return np.exp(rng.normal(size=n) + rng.normal(size=(2, n)))
    if kind == 'outliers':
        return np.exp(rng.standard_t(2.0, size=(2, n)))
    spread = np.array([[0.1], [2.0], [1.0], [1.0], [1.0]])
    levels = np.array([[20.0], [20.0], [25.0], [60.0], [60.0]])
    return levels + rng.normal(size=n) + spread * rng.normal(size=(5, n))


@pytest.mark.parametrize('n', [2, 3, 5, 10])
@pytest.mark.parametrize('kind', ['lognormal', 'outliers', 'of five'])
def test_equal_controllers_are_rarely_marked(kind, n):
    rng = np.random.default_rng(n)
    wrong = sum(marked(equal(rng, kind, n)) is not None for _ in range(DRAWS))
    assert wrong / DRAWS < 0.05 + 3.0 * np.sqrt(0.05 * 0.95 / DRAWS)


@pytest.mark.parametrize(('n', 'power'), [(3, 0.9), (5, 0.99)])
def test_what_differs_by_far_more_than_the_spread_is_marked(n, power):
    rng = np.random.default_rng(n)
    scores = (
        np.array([[1.0], [2.0], [3.0]]) * rng.lognormal(0.0, 0.1, (3, n)) for _ in range(400)
    )
    assert np.mean([marked(one) == 0 for one in scores]) > power


def test_a_spread_that_all_seeds_share_does_not_hide_a_difference():
    seeds = np.array([1.0, 5.0, 2.0, 9.0, 4.0])
    assert is_lower(seeds, seeds * 1.2)
    assert not is_lower(seeds, (seeds * 1.2)[::-1])


@pytest.mark.parametrize('unit', [*LEAST])
def test_a_difference_that_no_rig_would_show_is_none(unit):
    seeds = np.array([1.0, 1.1, 0.9]) * 1e-3 * LEAST[unit]
    assert not is_lower(seeds, 900.0 * seeds, unit)
    assert is_lower(seeds, 1200.0 * seeds, unit)


@pytest.mark.parametrize(
    ('one', 'other', 'lower'),
    [
        ([1.0], [1.011], True),
        ([1.0], [1.009], False),
        ([0.0], [0.0], False),
        ([0.0, 0.0], [0.0, 0.0], False),
        ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], True),
        ([1.0, 1.0, 1.0], [1.009, 1.009, 1.009], False),  # no spread, and of no use
        ([1.0, 1.0, 1.0], [2.0, 2.0, 1e200], False),
        ([1.0, 1.1], [2.0, 2.1], True),
        ([1.0, 1.5], [2.0, 2.0], False),
    ],
)
def test_boundaries_of_a_difference(one, other, lower):
    assert is_lower(one, other) is lower
    assert is_lower(other, one) is False


@pytest.mark.parametrize(
    ('row', 'winner', 'standing'),
    [
        # Numbers of scenarios in which a and b are best, not worse and failed.
        ({'a': [1.0, 1.1], 'b': [2.0, 2.1]}, 'a', [(1, 1, 0), (0, 0, 0)]),
        ({'a': [1.0, 2.0], 'b': [2.0, 1.5]}, None, [(0, 1, 0), (0, 1, 0)]),
        ({'a': [1.0, DIED], 'b': [2.0, 2.1]}, 'b', [(0, 0, 1), (1, 1, 0)]),
        ({'a': [1.0, DIED], 'b': [DIED, 2.1]}, None, [(0, 0, 1), (0, 0, 1)]),
        ({'a': [1.0, None], 'b': [2.0, 2.1]}, None, [(0, 0, 0), (0, 1, 0)]),
        ({'a': [1.0, np.nan], 'b': [DIED, DIED]}, None, [(0, 0, 0), (0, 0, 1)]),
        ({'a': [1.0, 1.0]}, None, [(0, 1, 0)]),
        ({'a': [1.0, 1.1, 9.0], 'b': [2.0, 2.1]}, 'a', [(1, 1, 0), (0, 0, 0)]),
    ],
)
def test_only_who_completed_each_seed_with_a_score_is_best(row, winner, standing):
    results = results_of({'step': row})
    assert best(results, 'step', 'error_at_rest') == winner
    found = [(one.best, one.not_worse, one.failed) for one in standings(results)]
    assert found == standing
    assert sum(one.is_best for one in compared(results, 'step', 'error_at_rest')) == bool(winner)


def test_failed_seeds_are_counted_and_have_no_part_in_the_numbers():
    one, other = compared(
        results_of({'step': {'a': [3.0, DIED, 1.0, 2.0, 9.0], 'b': [DIED]}}),
        'step',
        'error_at_rest',
    )
    assert (one.seeds, one.failed, one.median, one.worst) == (4, 1, 2.5, 9.0)
    assert (other.seeds, other.failed, other.median, other.interval) == (0, 1, None, None)


@pytest.mark.parametrize('n', range(2, 11))
def test_the_interval_of_a_median_has_the_confidence_that_it_states(n):
    rng = np.random.default_rng(n)
    draws = rng.exponential(size=(2000, n))
    found = [median_interval(values) for values in draws]
    hits = np.mean([one.low <= np.log(2.0) <= one.high for one in found])
    confidence = found[0].confidence
    assert abs(hits - confidence) < 4.0 * np.sqrt(confidence * (1.0 - confidence) / 2000)
    library = quantile_test(draws[0], p=0.5).confidence_interval(0.95)
    if n > 5:
        assert confidence >= 0.95
        assert (found[0].low, found[0].high) == (library.low, library.high)
    else:  # no such interval exists
        assert np.isnan([library.low, library.high]).any()


def test_a_single_seed_has_no_interval():
    assert median_interval([1.0]) is None
