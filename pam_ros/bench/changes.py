# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What has changed since an earlier bench: scores that moved beyond the spread, and failures."""

from collections.abc import Iterator

import numpy as np

from pam_ros.bench.compare import is_lower, values_of
from pam_ros.bench.outcome import Outcome, Results
from pam_ros.bench.table import value_text
from pam_ros.errors import shown
from pam_ros.identification.wording import name_in_words


def changes(old: Results, new: Results) -> list[str]:
    """Return a sentence for each change from the results *old* to *new*; one if there is none.

    Controllers are compared by name, in scenarios whose files are the same, over the seeds of
    both. A score has changed if it would be marked as better or worse in a table. Scores that
    depend on the machine are not compared.
    """
    common, sentences = [], []
    for scenario in new.about:
        if scenario not in old.about:
            continue
        if old.provenance.files.get(scenario) != new.provenance.files.get(scenario):
            sentences.append(f'{scenario}: not compared, the scenario itself has changed')
        else:
            common.append(scenario)
    controllers = [name for name in new.controllers if name in old.controllers]
    if not (common and controllers):
        return [*sentences, 'nothing is compared: no scenario and controller is in both']
    for scenario in common:
        for controller in controllers:
            sentences += _failures(old, new, scenario, controller)
            sentences += _scores(old, new, scenario, controller)
    return sentences or ['nothing has changed by more than the spread over the seeds']


def _failures(old: Results, new: Results, scenario: str, controller: str) -> Iterator[str]:
    """Yield a sentence for each seed whose run failed in one of the two only, or otherwise."""
    before = {run.seed: run for run in old.runs(scenario, controller)}
    for run in new.runs(scenario, controller):
        was = before.get(run.seed)
        if was is not None and was.status is not run.status:
            ends = f'{_ending(run)}, before it {_ending(was)}'
            yield shown(f'{scenario}: {controller} {ends} (seed {run.seed})')


def _ending(run: Outcome) -> str:
    return f'{run.status.words} ({run.reason})' if run.reason else run.status.words


def _scores(old: Results, new: Results, scenario: str, controller: str) -> Iterator[str]:
    """Yield a sentence for each score that has changed."""
    for score in new.scores:
        if score.is_of_machine:
            continue
        was, now = (values_of(one, scenario, controller, score.name) for one in (old, new))
        seeds = sorted({*was} & {*now})
        if not seeds:
            continue
        a, b = [was[seed] for seed in seeds], [now[seed] for seed in seeds]
        unit = new.unit(scenario, score.name)
        word = 'better' if is_lower(b, a, unit) else 'worse' if is_lower(a, b, unit) else ''
        if word:
            before, after = (value_text(float(np.median(one)), unit) for one in (a, b))
            what = f'{name_in_words(score.name)} of {controller}'
            yield shown(f'{scenario}: {what} is {word}: {after}, before {before}')
