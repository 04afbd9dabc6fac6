# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Blind trials of rigs whose pressure is measured: effects in the pressure path, muscle and joint.

Recordings come from the truth plant in ``test/truth``, which shares neither equations nor
integrator with the package: commands, a pressure with 300 Pa of noise, and the position. Trials
have one effect, or three at once: one in the pressure path, one in the muscle and one on the load.
Options: ``--seeds N`` (default 1) from ``--first N``, ``--kinds a,b+c+d``, ``--jobs N``,
``--log FILE`` (one JSON line a trial).
"""

import os

# One thread for each of many small matrices: trials run side by side instead.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

import time
from dataclasses import replace
from typing import Any

from benchmarks import _trials
from benchmarks.tracing import answer, is_right, nominal_model, pair_hits, recording_of
from pam_ros.identification.identify import identify
from truth import blind_trial

SINGLE = (
    *('pressure_lag', 'dead_time', 'leak', 'hysteresis', 'creep', 'pressure_dependent_damping'),
    *('coulomb_friction', 'viscous_friction'),
)
THREE = (
    'pressure_lag+hysteresis+coulomb_friction',
    'dead_time+creep+viscous_friction',
    'pressure_lag+pressure_dependent_damping+coulomb_friction',
    'leak+hysteresis+viscous_friction',
    'dead_time+hysteresis+coulomb_friction',
    'pressure_lag+creep+coulomb_friction',
)
TARGETS = {
    'one effect: named first, or in a set of two': (0.95, 'min'),
    'three at once: each named': (0.95, 'min'),
    'three at once: all named': (0.75, 'min'),
    'a wrong name': (0.02, 'max'),
    'noise only: no effect claimed': (0.99, 'min'),
}


def run_trial(job: tuple[str, int]) -> dict[str, Any]:
    """Run one trial and return a row of the true effects and those that were found."""
    trial = blind_trial(*job)
    began = time.perf_counter()
    recording = replace(recording_of(trial), pressure=trial.recording.pressure_pa)
    result = identify(nominal_model(trial), [recording])
    return {
        'kind': trial.kind,
        'seed': trial.seed,
        'accepted': [sorted(names) for names in trial.accepted],
        'in_library': trial.in_library,
        **answer(result),
        'noise': trial.noise,
        'seconds': time.perf_counter() - began,
    }


def scores(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return the figures for the targets."""
    single = [is_right(row) for row in rows if len(row['accepted']) == 1]
    several = [pair_hits(row) for row in rows if len(row['accepted']) > 1]
    each = [k < hits for hits, _ in several for k in range(3)]
    wrong = [pair_hits(row)[1] > 0 for row in rows if row['accepted']]
    noise = [not row['found'] for row in rows if not row['accepted']]
    whole = [hits == 3 for hits, _ in several]
    return _trials.shares(TARGETS, [single, each, whole, wrong, noise])


def main() -> None:
    """Run the trials that the command line selects, and print the scores."""
    given = _trials.options(__doc__, 1).parse_args()
    rows = _trials.run_all(
        run_trial, _trials.chosen(given, ('noise_only', *SINGLE, *THREE)), given
    )
    _trials.print_scores(rows, scores(rows), TARGETS)


if __name__ == '__main__':
    main()
