# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Blind trials in which an effect begins during the recording: how often it is named, and when.

Recordings come from the truth plant in ``test/truth``, which shares neither equations nor
integrator with the package. The moment at which the effect begins counts as found within 1 s of
the true one, or of the first time at which the effect has moved the load by three standard
deviations of the noise. Some effects develop within 2 to 8 s. Options: ``--seeds N`` (default 3)
from ``--first N``, ``--kinds a,b``, ``--jobs N``, ``--log FILE`` (one JSON line a trial).
"""

import os

# One thread for each of many small matrices: trials run side by side instead.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

import time
from typing import Any

from benchmarks import _trials
from benchmarks.tracing import answer, nominal_model, recording_of
from pam_ros.identification.identify import identify
from truth import DEVELOPING, LATE, late_trial

NEAR = 1.0  # s
TARGETS = {
    'named with the moment, or unexplained_structure with it': (0.80, 'min'),
    'named with the moment': (0.50, 'min'),
    'no other name': (1.00, 'min'),
    'moments whose 95 % interval holds the true one, of those named': (0.90, 'min'),
}


def run_trial(job: tuple[str, int]) -> dict[str, Any]:
    """Run one trial and return a row of the true effect and those that were found."""
    late = late_trial(*job)
    trial = late.trial
    began = time.perf_counter()
    found = identify(nominal_model(trial), [recording_of(trial)])
    since = found.since
    return {
        'kind': trial.kind,
        'seed': trial.seed,
        'where': '' if since is None else f'{since.value - late.onset:+.3f} s',
        'accepted': [sorted(names) for names in trial.accepted],
        'onset': late.onset,
        'shows': late.shows,
        'within': late.within,
        'since': None if since is None else [since.low, since.value, since.high],
        **answer(found),
        'noise': trial.noise,
        'seconds': time.perf_counter() - began,
    }


def is_near(row: dict[str, Any]) -> bool:
    """Return whether the moment was found."""
    since = row['since']
    return since is not None and any(
        abs(since[1] - time) <= NEAR for time in (row['onset'], row['shows'])
    )


def is_named(row: dict[str, Any]) -> bool:
    """Return whether the effect was named, alone or in a set of two."""
    stated = [row['found'][0], *row['alternatives'][0]] if len(row['found']) == 1 else []
    return len(stated) <= 2 and bool({*stated} & {*row['accepted'][0]})


def is_wrong(row: dict[str, Any]) -> bool:
    """Return whether an effect was named that is not there."""
    return bool(row['found']) and not is_named(row)


def scores(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return the figures for the targets."""
    named = [is_named(r) and is_near(r) for r in rows]
    open_ones = [r['verdict'] == 'unexplained_structure' and is_near(r) for r in rows]
    inside = [
        r['since'][0] <= r['onset'] <= r['since'][2]
        for r, is_one in zip(rows, named, strict=True)
        if is_one
    ]
    groups = [
        [a or b for a, b in zip(named, open_ones, strict=True)],
        named,
        [not is_wrong(r) for r in rows],
        inside,
    ]
    return _trials.shares(TARGETS, groups)


def main() -> None:
    """Run the trials that the command line selects, and print the scores."""
    given = _trials.options(__doc__, 3).parse_args()
    rows = _trials.run_all(run_trial, _trials.chosen(given, (*LATE, *DEVELOPING)), given)
    _trials.print_scores(rows, scores(rows), TARGETS)


if __name__ == '__main__':
    main()
