# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of scores that controllers have to keep, from a YAML file, and what does not keep them.

The file has the limits of the scores by scenario, in the units of the scores (m, rad, s, kPa, %)::

    friction_step: {error_at_rest: 3.0e-5}
    '*': {limit_violations: 0.0}

Those of ``*`` hold in each scenario that has no other limit of the same score.
"""

import math
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from pam_ros.bench.outcome import NotRun, Outcome, Results
from pam_ros.bench.table import value_text
from pam_ros.errors import ParameterError, shown
from pam_ros.identification.wording import name_in_words
from pam_ros.plain_yaml import read_yaml
from pam_ros.similar_names import similar

EVERY = '*'  # stands for each scenario

Limits = Mapping[str, Mapping[str, float]]  # largest value by scenario and score


def read_limits(path: Path, scenarios: Collection[str], scores: Collection[str]) -> Limits:
    """Return the limits in the file *path*, by scenario or ``*``, and by score.

    *scenarios* and *scores* are the names that exist. Raises ParameterError for a file that
    cannot be read or has no limits, for other names, and for values that are not limits.
    """
    found: dict[str, dict[str, float]] = {}
    for scenario, limits in _table(read_yaml(path), f'{path}').items():
        if scenario != EVERY:
            _refuse_unknown(scenario, 'scenario', scenarios, f'{path}')
        place = f'{path}, {scenario}'
        found[scenario] = {}
        for score, value in _table(limits, place).items():
            _refuse_unknown(score, 'score', scores, place)
            found[scenario][score] = _limit(value, f'{place}, {score}')
    return found


def shortfalls(results: Results, limits: Limits) -> list[str]:
    """Return a sentence for each controller, scenario and limit that is not kept.

    A limit is kept if all runs were completed with a score that is not higher. A limit for ``*``
    does not hold in scenarios in which no run has the score; a limit for a scenario does.
    """
    sentences = []
    for scenario in results.about:
        held = {**limits.get(EVERY, {}), **limits.get(scenario, {})}
        for score, limit in held.items():
            has_meaning = any(
                run.scores.get(score) is not None or not run.is_completed
                for run in results.outcomes
                if run.scenario == scenario
            )
            if score not in limits.get(scenario, {}) and not has_meaning:
                continue
            unit = results.unit(scenario, score)
            for controller in results.controllers:
                what = f'{name_in_words(score)} of {controller}'
                runs = results.runs(scenario, controller)
                lacking = results.lacking(scenario, controller)
                problem = _problem(runs, lacking, score, limit, unit)
                if problem:
                    sentences.append(shown(f'{scenario}: {what} must be at most {problem}'))
    return sentences


def _problem(
    runs: list[Outcome], lacking: list[NotRun], score: str, limit: float, unit: str
) -> str:
    """Return *limit* and why *runs* of a controller do not keep it; '' if they do."""
    text = value_text(limit, unit)
    for one in lacking:
        return f'{text}, but it could not be run with seed {one.seed} ({one.reason})'
    if not runs:
        return f'{text}, but it did not run'
    for run in runs:
        if not run.is_completed:
            reason = f' ({run.reason})' if run.reason else ''
            return f'{text}, but it {run.status.words} with seed {run.seed}{reason}'
        if run.scores.get(score) is None:
            return f'{text}, but it has no value with seed {run.seed}'
    worst, seed = max((run.scores[score] or 0.0, -run.seed) for run in runs)
    if worst <= limit:
        return ''
    pairs = ((value_text(limit, unit, n), value_text(worst, unit, n)) for n in range(3, 18))
    text, found = next((pair for pair in pairs if pair[0] != pair[1]), (text, 'above it'))
    return f'{text}, but is {found} with seed {-seed}'


def _table(data: Any, place: str) -> dict[str, Any]:
    """Return *data* if they are a mapping of names that is not empty."""
    if not isinstance(data, dict) or not data:
        raise ParameterError(
            f'{place} has no limits: give them by scenario and score, such as '
            'friction_step: {error_at_rest: 3.0e-5}'
        )
    return {str(name): value for name, value in data.items()}


def _refuse_unknown(name: str, what: str, known: Collection[str], place: str) -> None:
    if name in known:
        return
    alike = similar(name, known)
    hint = f'was {alike} meant?' if alike else f'give one of {", ".join(known)}'
    raise ParameterError(f'{place}: {name} is not a {what}: {hint}')


def _limit(value: Any, place: str) -> float:
    """Return a limit as a float."""
    number = math.nan
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:  # a whole number with hundreds of digits
            number = math.inf
    if not (math.isfinite(number) and number >= 0.0):
        raise ParameterError(
            f'{place} = {value!r} is not a limit: give a number that is not negative'
        )
    return number
