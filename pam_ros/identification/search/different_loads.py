# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of one rig with different loads, of which only one was stated.

An effect that changes with time can imitate the change from one load to another. So the best model
of a search is compared with models in which each recording has a load of its own: the re-tuned
one, and the best one.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import log

import numpy as np

from pam_ros.identification.fit.of_rig import LOAD, OfRig, numbers_of
from pam_ros.identification.fit.solve import converge, initial_solution, with_nominal_constants
from pam_ros.identification.fit.unknowns import RunNumber, Unknown
from pam_ros.identification.search.compare import is_complete
from pam_ros.identification.search.doubt import Doubt
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.setting import Model, Setting
from pam_ros.parameters import Parameter
from pam_ros.recording.recording import Recording

FACTOR = log(2.0)  # standard deviation of the logarithm of a load that nobody stated
# Share by which loads differ at least: the pull of a muscle differs by some percent from day to
# day, which a load of its own would explain as well.
DIFFERENT = 0.05


def different_loads(search: Search, recordings: Sequence[Recording]) -> Doubt | None:
    """Return the doubt if *recordings* were made with different loads, None if not.

    The loads differ if loads of their own lower the score of the best model by the margin, and
    its error by the share that an effect must explain.
    """
    setting, best = search.setting, search.best
    number = _number(setting)
    runs = _runs_of_recordings(setting)
    if number is None or len(runs) < 2 or is_complete(best, setting):
        return None
    of, value, about = number
    if any(of.name in recording.numbers for recording in recordings):
        return None
    bases = [search.retuned] if best is search.retuned else [search.retuned, best]
    unknowns = [
        Unknown(RunNumber(own, of), value, FACTOR, 1e-3 * value, _high(about), 1.0, True)
        for own in runs.values()
    ]
    fits = [one for model in bases for one in _with(model, unknowns, setting)]
    own = min(fits, key=lambda m: m.score)
    most = (1.0 - setting.criteria.form) * setting.above(best.errors.fit)
    if own.score > best.score - setting.criteria.margin or setting.above(own.errors.fit) > most:
        return None
    loads = [one.value(u) for one, u in _loads(own)]
    if max(loads) < (1.0 + DIFFERENT) * min(loads):
        return None
    listed = ', '.join(
        f'{load:.3g} {about.unit} in {recordings[k].name}'
        for k, load in zip(runs, loads, strict=True)
    )
    return Doubt(
        f'the recordings were made with different loads ({of.name} = {listed}, if the nominal '
        f'model is right otherwise), and one {of.name} was given for all, '
        f'{value:.6g} {about.unit}',
        f'State the {of.name} of each recording: --set {of.name}=VALUE before its file.',
    )


def _number(setting: Setting) -> tuple[OfRig, float, Parameter] | None:
    """Return the mass of the load, or its inertia if it has no mass, with its description."""
    if setting.drifts or setting.parts[0].segment.kind != 'free':
        return None
    if any(isinstance(one.of, OfRig) and one.of.part == LOAD for one in setting.problem.unknowns):
        return None
    known = numbers_of(setting.joint)
    for name in ('mass', 'inertia'):
        for of, (value, about) in known.items():
            if of.part == LOAD and of.name == name and value > 0.0:
                return of, value, about
    return None


def _runs_of_recordings(setting: Setting) -> dict[int, tuple[int, ...]]:
    """Return the numbers of the fitted runs of each recording, by its number."""
    found: dict[int, tuple[int, ...]] = {}
    for run, segment in enumerate(setting.problem.segments):
        found[segment.recording] = (*found.get(segment.recording, ()), run)
    return found


def _high(about: Parameter) -> float:
    return float('inf') if about.high is None else about.high


def _with(model: Model, unknowns: Sequence[Unknown], setting: Setting) -> list[Model]:
    """Return *model* with more *unknowns*, fitted again from its result.

    If its constants have moved far to compensate for the loads, a second fit begins with nominal
    ones.
    """
    known = model.solution
    problem = replace(known.problem, unknowns=(*known.problem.unknowns, *unknowns))
    u = np.append(known.u, np.zeros(len(unknowns)))
    start = initial_solution(problem, u, known.discrepancy, setting.pool)
    ends = (
        converge(one, setting.budget.iterations, setting.pool)
        for one in (start, *with_nominal_constants(start))
    )
    return [setting.model(model.effects, end) for end in ends]


def _loads(model: Model) -> list[tuple[Unknown, float]]:
    """Return the unknown loads of recordings in *model*, with their coordinates."""
    solution = model.solution
    pairs = zip(solution.problem.unknowns, solution.u, strict=True)
    return [(one, u) for one, u in pairs if isinstance(one.of, RunNumber)]
