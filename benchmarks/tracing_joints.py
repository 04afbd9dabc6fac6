# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Blind trials of joints: how often the identification names the effect, and where it acts.

Recordings come from the truth pair in ``test/truth``, which shares neither equations nor
integrator with the package. Options: ``--seeds N`` (default 3) from ``--first N``, ``--kinds
a@both,b@one,c@joint,noise_only``, ``--jobs N``, ``--log FILE`` (one JSON line a trial).
"""

import os

# One thread for each of many small matrices: trials run side by side instead.
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))

from benchmarks import _trials
from pam_ros.identification.identify import identify
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.transmissions import Pulley
from truth.pair_trials import NAMES, PAIR_KINDS, PairTrial, pair_trial

TARGETS = {
    'the effect named first, or in a set of two': (0.90, 'min'),
    'and where it sits': (0.80, 'min'),
    'noise only: no effect claimed': (0.99, 'min'),
    'out of library: called unexplained_structure': (0.92, 'min'),
}


def nominal_model(trial: PairTrial) -> Joint:
    """Return the nominal model that the user of the trial has."""
    d = trial.nominal
    muscle = Muscle(
        *d.constants_si, pressure_unit='Pa', contraction_unit='fraction', zeta=d.zeta, l0=d.l0
    )
    actuator = Actuator(muscle, contraction=d.contraction)
    load = Arm(inertia=d.inertia, mass=d.mass, arm=d.arm)
    return Joint((actuator, actuator), load, Pulley(radius=d.radius))


def recording_of(trial: PairTrial) -> Recording:
    """Return the recording of a trial for the identification."""
    return Recording(
        f'{trial.kind} {trial.seed}', trial.t, trial.t, trial.commands, trial.angle,
        None, None, None, 'free', muscles=NAMES, unit='rad',
    )  # fmt: skip


def run_trial(job: tuple[str, int]) -> dict[str, Any]:
    """Run one trial and return a row of the true effect and those that were found."""
    trial = pair_trial(*job)
    began = time.perf_counter()
    found = identify(nominal_model(trial), [recording_of(trial)])
    nominal, retuned, augmented = (stage.held_error for stage in found.stages)
    return {
        'kind': trial.kind,
        'seed': trial.seed,
        'forms': trial.forms,
        'accepted': sorted(trial.accepted),
        'where': trial.where,
        'in_library': trial.in_library,
        'verdict': found.verdict,
        'found': [e.name for e in found.effects],
        'alternatives': [list(e.alternatives) for e in found.effects],
        'declared': nominal,
        'retuned': retuned,
        'augmented': augmented,
        'noise': trial.noise,
        'seconds': time.perf_counter() - began,
    }


def place_of(name: str, on_joint: bool) -> tuple[str, str]:
    """Return the effect in the name of a place, and the place: a muscle, 'both' or 'joint'."""
    muscle, _, effect = name.rpartition('.')
    return effect, muscle or ('joint' if on_joint else 'both')


def hits(row: dict[str, Any]) -> tuple[bool, bool]:
    """Return whether the effect was named, first or in a set of two, and also with its place."""
    if not row['found']:
        return False, False
    stated = [row['found'][0], *row['alternatives'][0]]
    places = [place_of(name, row['where'] == 'joint') for name in stated]
    named = [(effect in row['accepted'], where == row['where']) for effect, where in places]
    first = named[0]
    if first[0]:
        return True, first[1]
    few = len({effect for effect, _ in places}) <= 2
    return few and any(is_it for is_it, _ in named), few and any(all(both) for both in named)


def scores(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return the figures for the targets."""
    single = [hits(r) for r in rows if r['accepted'] and r['in_library']]
    noise = [not r['found'] for r in rows if not r['accepted']]
    strange = [r['verdict'] == 'unexplained_structure' for r in rows if not r['in_library']]
    groups = [[a for a, _ in single], [b for _, b in single], noise, strange]
    return _trials.shares(TARGETS, groups)


def main() -> None:
    """Run the trials that the command line selects, and print the scores."""
    given = _trials.options(__doc__, 3).parse_args()
    rows = _trials.run_all(run_trial, _trials.chosen(given, PAIR_KINDS), given)
    _trials.print_scores(rows, scores(rows), TARGETS)


if __name__ == '__main__':
    main()
