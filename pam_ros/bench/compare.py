# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Comparison of controllers over a few seeds: medians, intervals, and which controller is best.

All controllers have the same seeds, and thus the same noise and the same changes of the rig, so
that they are compared by the differences of each seed. One score is lower than another one if

- the medians differ by at least 1 %, and by what can matter on a rig, such as 0.1 um: less is of
  no use, whatever the spread; and
- a paired t test says so (p < 0.05, two-sided). For the few seeds of a bench there is no test
  without an assumption on the distribution: a sign test or a permutation test of 5 seeds has
  p = 0.06 at least. Scores of equal controllers have symmetric differences, for which the test is
  conservative. A single seed has no spread, so that the first condition has to suffice.

The best controller has a lower score than each other one. The tests need no correction for the
number of controllers: a wrong best controller must be lower than one that is at least equal, and
the comparison of the first with the second keeps its level for any number of them (Gutmann and
Maymin, Annals of Statistics 15, 1987; Hung and Fithian, Annals of Statistics 47, 2019).

The interval of a median is between two of the ordered values, from the binomial distribution. It
assumes no distribution, and its confidence is known. A bootstrap interval of so few values claims
95 %, but contains the median far less often: the values that it draws from are the few ones.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from pam_ros.bench.outcome import Results

RELEVANT = 0.01  # smallest difference, as a share of the larger median
# Smallest difference by the unit of the score: far below what sensors and valves resolve.
LEAST = {'m': 1e-7, 'rad': 1e-6, 's': 2e-3, 'percent': 0.01, 'kPa': 1e-3, 'kPa/s': 0.01}
LEVEL = 0.05  # of the two-sided t test
CONFIDENCE = 0.95  # of an interval of the median, where there are enough seeds

Values = Mapping[int, float]  # of a score, by seed


@dataclass(frozen=True)
class Interval:
    """An interval of the median and its confidence, which is exact for continuous scores.

    The confidence is at least 0.95 for 6 seeds or more. For fewer, the interval is from the
    smallest to the largest value, and has 0.5 for 2 seeds, 0.75, 0.875, and 0.9375 for 5.
    """

    low: float
    high: float
    confidence: float


@dataclass(frozen=True)
class Comparison:
    """A score of a controller in a scenario, over the ``seeds`` that were completed with a value.

    ``median`` and ``worst`` are None without such a seed, ``interval`` also with a single one.
    ``failed`` seeds were not completed.
    """

    scenario: str
    controller: str
    score: str
    seeds: int
    failed: int
    median: float | None
    worst: float | None
    interval: Interval | None
    is_best: bool


@dataclass(frozen=True)
class Standing:
    """The numbers of scenarios in which a controller is best, is not worse, or failed.

    They are by the main scores. It is not worse if it completed each seed and no controller that
    did so has a lower score; this includes those in which it is best. It failed if a seed was not
    completed.
    """

    controller: str
    best: int
    not_worse: int
    failed: int


def median_interval(values: ArrayLike) -> Interval | None:
    """Return the interval of the median of n *values*; None for a single one."""
    ordered = np.sort(np.asarray(values, dtype=float))
    n = len(ordered)
    if n < 2:
        return None
    # The median is below the k-th of the ordered values with this probability: P(B < k).
    k = max(int(stats.binom.ppf((1.0 - CONFIDENCE) / 2.0, n, 0.5)), 1)
    outside = float(stats.binom.cdf(k - 1, n, 0.5))
    return Interval(float(ordered[k - 1]), float(ordered[n - k]), 1.0 - 2.0 * outside)


def is_lower(one: ArrayLike, other: ArrayLike, unit: str = '') -> bool:
    """Return whether *one* score is lower than *other* by more than the spread over n seeds.

    Both (n,) are in the order of the same seeds, at least 0, and in this *unit*.
    """
    a, b = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
    gap = np.median(b) - np.median(a)
    if not (gap > LEAST.get(unit, 0.0) and gap >= RELEVANT * np.median(b)):
        return False
    n = len(a)
    if n == 1:
        return True
    difference = (b - a) / np.max(np.abs(b - a))  # squares of large ones are finite then
    error = np.std(difference, ddof=1) / np.sqrt(n)
    return bool(np.mean(difference) > stats.t.ppf(1.0 - LEVEL / 2.0, n - 1) * error)


def best(results: Results, scenario: str, score: str) -> str | None:
    """Return the controller that is best in *scenario* for *score*; None if none is.

    It completed each seed. A controller that did not is worse; one that did must have a score
    that is higher by more than the spread over the seeds of both. None is best for a score that
    depends on the machine: other programs on it cause differences as well.
    """
    if results.score(score).is_of_machine:
        return None
    rivals = [c for c in results.controllers if results.runs(scenario, c)]
    whole = _whole(results, scenario, score)
    if len(rivals) < 2:
        return None
    unit = results.unit(scenario, score)
    for name, values in whole.items():
        others = [other for key, other in whole.items() if key != name]
        if values and all(_is_lower(values, other, unit) for other in others):
            return name
    return None


def compare(results: Results) -> list[Comparison]:
    """Return each score of each controller in each scenario, in the order of *results*."""
    return [
        one
        for scenario in results.about
        for score in results.scores
        for one in compared(results, scenario, score.name)
    ]


def compared(results: Results, scenario: str, score: str) -> list[Comparison]:
    """Return *score* of each controller in *scenario*, in the order of the controllers."""
    winner = best(results, scenario, score)
    found = []
    for controller in results.controllers:
        values = list(values_of(results, scenario, controller, score).values())
        failed = sum(not run.is_completed for run in results.runs(scenario, controller))
        found.append(
            Comparison(
                scenario,
                controller,
                score,
                len(values),
                failed,
                float(np.median(values)) if values else None,
                max(values, default=None),
                median_interval(values),
                controller == winner,
            )
        )
    return found


def standings(results: Results) -> list[Standing]:
    """Return the standing of each controller, in the order of the controllers."""
    counts = {controller: [0, 0, 0] for controller in results.controllers}
    for scenario, about in results.about.items():
        whole = _whole(results, scenario, about.main_score)
        winner = best(results, scenario, about.main_score)
        unit = results.unit(scenario, about.main_score)
        for controller, count in counts.items():
            values = whole.get(controller)
            count[0] += controller == winner
            count[1] += bool(values) and not any(
                _is_lower(other, values, unit) for other in whole.values() if values and other
            )
            count[2] += any(not run.is_completed for run in results.runs(scenario, controller))
    return [Standing(controller, *count) for controller, count in counts.items()]


def values_of(results: Results, scenario: str, controller: str, score: str) -> dict[int, float]:
    """Return the values of *score* in the completed runs that have one, by seed."""
    found = {
        run.seed: run.scores.get(score)
        for run in results.runs(scenario, controller)
        if run.is_completed
    }
    return {seed: value for seed, value in found.items() if value is not None}


def _whole(results: Results, scenario: str, score: str) -> dict[str, Values]:
    """Return the values of the controllers that have completed each seed that they have run.

    They are empty if a run of the controller lacks the score, which cannot be compared then.
    """
    found: dict[str, Values] = {}
    for controller in results.controllers:
        runs = results.runs(scenario, controller)
        if runs and all(run.is_completed for run in runs):
            values = values_of(results, scenario, controller, score)
            found[controller] = values if len(values) == len(runs) else {}
    return found


def _is_lower(one: Values, other: Values, unit: str) -> bool:
    """Return whether *one* is lower in the seeds of both; false if they have none in common."""
    seeds = sorted(set(one) & set(other))
    return bool(seeds) and is_lower([one[s] for s in seeds], [other[s] for s in seeds], unit)
