# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Blind trials: how often the identification names the effect in a recording, and no other.

Recordings come from the truth plant in ``test/truth``, which shares neither equations nor
integrator with the package. Options: ``--seeds N`` (default 12) from ``--first N``, ``--kinds
a,b+c,noise_only``, ``--draws wide`` (rigs as they are in the field), ``--jobs N``, ``--log FILE``
(one JSON line a trial).
"""

import os

# One thread for each of many small matrices: trials run side by side instead.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

import sys
import time
from collections import Counter, defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from benchmarks import _intervals, _trials
from pam_ros.identification.identification import Identification
from pam_ros.identification.identify import identify
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Joint
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from truth import (
    KINDS,
    NOISE_ONLY,
    OUT_OF_LIBRARY,
    PAIRS,
    Trial,
    blind_trial,
    slow_trial,
    wide_trial,
)

TARGETS = {
    'single: right effect first, or in a set of two': (0.95, 'min'),
    'noise only: an effect claimed': (0.01, 'max'),
    'pairs: both found': (0.75, 'min'),
    'pairs: one found and no wrong one': (0.95, 'min'),
    'out of library: called unexplained_structure': (0.85, 'min'),
    'single: median error after / noise floor': (1.2, 'max'),
    'noise floor found within 15 % of the true noise': (0.85, 'min'),
    'right effects alone: 95 % intervals of the effects that hold the truth': (0.90, 'min'),
    'right effects alone: 95 % intervals of a1 to a6 and zeta that do': (0.90, 'min'),
}


def nominal_model(trial: Trial) -> Joint:
    """Return the nominal model that the user of the trial has."""
    d = trial.nominal
    muscle = Muscle(
        *d.constants_si, pressure_unit='Pa', contraction_unit='fraction', zeta=d.zeta, l0=d.l0
    )
    return single_muscle_joint(muscle, Mass(mass=d.mass))


def recording_of(trial: Trial) -> Recording:
    """Return the recording of a trial for the identification."""
    r = trial.recording
    t = r.t_s - r.t_s[0]
    return Recording(
        f'{trial.kind} {trial.seed}', t, t, r.pressure_command_pa, r.position_m,
        None, None, None, 'free',
    )  # fmt: skip


@dataclass(frozen=True)
class Job:
    """A trial to be run, and the kind of draws (random rigs) that it belongs to."""

    kind: str
    seed: int
    draws: str


DRAWS = {'blind': blind_trial, 'wide': wide_trial, 'slow': slow_trial}


def run_trial(job: Job) -> dict[str, Any]:
    """Run one trial and return a row of the true effects and those that were found."""
    trial = DRAWS[job.draws](job.kind, job.seed)
    began = time.perf_counter()
    result = identify(nominal_model(trial), [recording_of(trial)])
    found = answer(result)
    return {
        'kind': job.kind,
        'seed': job.seed,
        'forms': [e.form for e in trial.effects],
        'accepted': [sorted(names) for names in trial.accepted],
        'in_library': trial.in_library,
        **found,
        'intervals': _intervals.intervals(
            _intervals.truth_of(trial), result.stages[-1].parameters
        ),
        'noise': float(np.hypot(trial.noise, trial.quantum / np.sqrt(12.0))),
        'samples': int(trial.recording.t_s.size),
        'seconds': time.perf_counter() - began,
    }


def answer(found: Identification) -> dict[str, Any]:
    """Return the results of a search; errors are those over held-out samples."""
    nominal, retuned, augmented = found.stages
    return {
        'verdict': found.verdict,
        'found': [e.name for e in found.effects],
        'alternatives': [list(e.alternatives) for e in found.effects],
        'declared': nominal.held_error,
        'retuned': retuned.held_error,
        'augmented': augmented.held_error,
        'floor': found.noise.sigma,
        'ceiling': found.structure.ceiling,
        'share': found.structure.share,
    }


def is_right(row: dict[str, Any]) -> bool:
    """Return whether a single effect was named first, or in a stated set of at most two."""
    if not row['found']:
        return False
    stated = [row['found'][0], *row['alternatives'][0]]
    truth = set(row['accepted'][0])
    return stated[0] in truth or (len(stated) <= 2 and bool(truth & set(stated)))


def pair_hits(row: dict[str, Any]) -> tuple[int, int]:
    """Return how many of a pair's effects were named, and how many names are wrong."""
    left = [set(names) for names in row['accepted']]
    wrong = 0
    for name, others in zip(row['found'], row['alternatives'], strict=True):
        stated = {name, *others[:1]}
        hit = next((truth for truth in left if truth & stated), None)
        if hit is not None:
            left.remove(hit)
        elif not any(name in names for names in row['accepted']):
            wrong += 1
    return len(row['accepted']) - len(left), wrong


def is_exact(row: dict[str, Any]) -> bool:
    """Return whether exactly the true effects were named; with noise only: none."""
    left = [set(names) for names in row['accepted']]
    for name in row['found']:
        hit = next((truth for truth in left if name in truth), None)
        if hit is None:
            return False
        left.remove(hit)
    return not left


def scores(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return the figures for the targets."""
    single = [r for r in rows if len(r['accepted']) == 1 and r['in_library']]
    noise = [r for r in rows if not r['accepted']]
    pairs = [r for r in rows if len(r['accepted']) == 2]
    strange = [r for r in rows if not r['in_library']]
    hits = [pair_hits(r) for r in pairs]
    exact = [r for r in rows if is_exact(r)]
    inside = [_intervals.are_inside(exact, of_effects) for of_effects in (True, False)]
    values = [
        np.mean([is_right(r) for r in single]) if single else np.nan,
        np.mean([bool(r['found']) for r in noise]) if noise else np.nan,
        np.mean([h == 2 for h, _ in hits]) if hits else np.nan,
        np.mean([h >= 1 and wrong == 0 for h, wrong in hits]) if hits else np.nan,
        np.mean([r['verdict'] == 'unexplained_structure' for r in strange]) if strange else np.nan,
        np.median([r['augmented'] / r['noise'] for r in single]) if single else np.nan,
        np.mean([0.85 <= r['floor'] / r['noise'] <= 1.15 for r in rows]) if rows else np.nan,
        *(np.mean(one) if one else np.nan for one in inside),
    ]
    return dict(zip(TARGETS, map(float, values), strict=True))


def report(rows: list[dict[str, Any]]) -> None:
    """Print the table of scores, the confusions, and the rows that are wrong."""
    _trials.print_scores(rows, scores(rows), TARGETS)
    confusion: dict[str, Counter[str]] = defaultdict(Counter)
    ratio: dict[str, list[float]] = defaultdict(list)
    for r in rows:
        confusion[r['kind']][' + '.join(r['found']) or r['verdict']] += 1
        ratio[r['kind']].append(r['augmented'] / r['noise'])
    print('\nwhat was there: what was called (median error after / noise)')
    for kind, counts in confusion.items():
        named = ', '.join(f'{n} x {name}' for name, n in counts.most_common())
        print(f'  {kind:38s} {named}  ({np.median(ratio[kind]):.2f})')


def main() -> None:
    """Run the trials that the command line selects, and print the scores."""
    parser = _trials.options(__doc__, 12)
    parser.add_argument('--draws', choices=DRAWS, default='blind')
    given = parser.parse_args()
    chosen = _trials.chosen(given, [NOISE_ONLY, *KINDS, *PAIRS, *OUT_OF_LIBRARY])
    rows = _trials.run_all(run_trial, [Job(*one, given.draws) for one in chosen], given)
    report(rows)


if __name__ == '__main__':
    main()
