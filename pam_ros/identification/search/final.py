# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The models of a search, fitted with short steps to all samples that a verdict may use."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.parts import FEWEST, Part, run_of
from pam_ros.identification.data.thinning import LONGEST_PERIOD, thinned
from pam_ros.identification.fit.extend import memories
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.solve import Solution, initial_solution, least_squares
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.setting import Model, Setting, rms, simulate_on
from pam_ros.identification.search.starts import without_idle
from pam_ros.identification.work import Forecast

Array = NDArray[np.float64]
STEP = 1e-3  # s, longest step of the simulations of a rig that is not slow
STEPS = 20  # of a slow rig, in the longest period that its fastest oscillation allows
# Simulations of the last fits, which were counted as in :mod:`.forecast`: 57 to 115 with none or
# one effect and 500 with two.
LEAST, MOST = 60.0, 500.0


@dataclass(frozen=True, eq=False)
class FinalFits:
    """The nominal, the re-tuned and the augmented model, fitted to *fit* and *choose*.

    In the nominal model only unknowns that are not parameters are fitted, such as the starts and
    the levels of runs. ``parts`` are those of the setting, in the order of the runs; parts with
    too few samples for a run come last.
    """

    parts: tuple[Part, ...]
    nominal: Solution
    retuned: Solution
    augmented: Solution


def fit_finally(search: Search) -> FinalFits:
    """Return the models of a search, fitted completely: by least squares of the free run."""
    setting = search.setting
    parts = tuple(sorted(setting.parts, key=lambda part: not _is_run(part)))
    whole = _whole(parts, setting)
    starts = tuple(k for k in whole.unknowns if not k.is_parameter)
    nominal = _nearest(replace(whole, unknowns=starts), np.zeros(len(starts)), setting)
    retuned = _nearest(*_begun(search.retuned, whole, setting), setting)
    if not search.best.effects:
        return FinalFits(parts, nominal, retuned, retuned)
    return FinalFits(parts, nominal, retuned, _nearest(*_nearer(search, whole), setting))


def forecast_of_final(setting: Setting) -> Forecast:
    """Return the forecast of the last fits, and of the errors of all models that were tried."""
    return Forecast(*(count * _whole(setting.parts, setting).steps for count in (LEAST, MOST)))


def _whole(parts: Sequence[Part], setting: Setting) -> Problem:
    """Return the problem of re-tuning to all samples of *parts* that a fit may use."""
    runs = [run_of(part.segment, part.used) for part in parts if _is_run(part)]
    return setting.problem_of(runs, short_step(setting.coarse_period(LONGEST_PERIOD)))


def short_step(period: float) -> float:
    """Return the longest step in s of the simulations of the last fits.

    *period* in s is the longest one that the fastest oscillation of the rig allows.
    """
    return max(STEP, period / STEPS)


def _is_run(part: Part) -> bool:
    return int(np.count_nonzero(part.used)) >= FEWEST


def _nearer(search: Search, whole: Problem) -> tuple[Problem, Array]:
    """Return the start of the chosen model's fit: the better result of short and long steps.

    If a load sticks or hits something, a fit that is right with one step may be wrong with
    another.
    """
    best, setting = search.best, search.setting
    same = [m for m in search.evaluated if {*m.effects} == {*best.effects}]
    coarse = [m for m in same if m.solution.problem.step == setting.step and m is not best]
    coarse = sorted(coarse, key=lambda m: m.score)[:1]
    places = [_begun(model, whole, setting) for model in [best, *coarse]]
    return min(places, key=lambda place: float(np.linalg.norm(place[0].residuals(place[1]))))


def _nearest(problem: Problem, u: Array, setting: Setting) -> Solution:
    """Return the least-squares fit of a problem, from u.

    First a fit to thinned samples is made with the longest steps that resolve the rig. It costs a
    tenth, and its result is nearly the final one, except for a load that hits something.
    """
    budget, pool = setting.budget, setting.pool
    segments = tuple(thinned(s, setting.period) for s in problem.segments)
    coarse = replace(problem, segments=segments, step=setting.step)
    there = least_squares(initial_solution(coarse, u, pool=pool), budget.iterations, pool).u
    nearer = min((u, there), key=lambda one: float(np.linalg.norm(problem.residuals(one))))
    at = without_idle(initial_solution(problem, nearer, pool=pool), setting.noise)
    return least_squares(at, budget.closer, pool)


def _begun(model: Model, whole: Problem, setting: Setting) -> tuple[Problem, Array]:
    """Return the problem of *model* on the runs of *whole*, and its unknowns at the start."""
    known = model.solution.problem
    own = [k for k, unknown in enumerate(known.unknowns) if unknown.is_parameter]
    starts = [unknown for unknown in whole.unknowns if not unknown.is_parameter]
    for name in model.effects:
        starts += memories(whole, setting.places[name])
    problem = replace(
        whole,
        row=known.row,
        active=known.active,
        unknowns=(*(known.unknowns[k] for k in own), *starts),
    )
    # The short runs of a load without a spring differ from those of the search, and a search of
    # many recordings has used only some of them.
    is_same = not setting.drifts and len(setting.searched) == len(setting.parts)
    there = _starts_of(model) if is_same else {}
    moved = [one.coordinate(there[one.name]) if one.name in there else 0.0 for one in starts]
    # Thinned samples determine a start less accurately than all samples.
    return problem, np.concatenate([model.nearest.u[own], np.clip(moved, -2.0, 2.0)])


def _starts_of(model: Model) -> dict[str, float]:
    """Return the values of the unknowns of a fit that are not parameters, by name."""
    pairs = zip(model.solution.problem.unknowns, model.nearest.u, strict=True)
    return {k.name: k.value(u) for k, u in pairs if not k.is_parameter}


def simulated(solution: Solution, parts: Sequence[Part], setting: Setting) -> list[Array]:
    """Return the free run of a final fit through each of its *parts*, from its start.

    For a load without a spring this is the measured start: the starts of short runs are different.
    """
    segments = [part.segment for part in parts]
    return simulate_on(solution, segments, setting.left_out)


def errors_of(runs: Sequence[Array], parts: Sequence[Part]) -> tuple[float, float]:
    """Return the RMSE in m, rad or N of free runs through *parts*: of what was used, and *judge*.

    NaN if there are no judging samples. It is only for reports: a search must not use the data
    that judge it.
    """
    left = [run - part.segment.target for run, part in zip(runs, parts, strict=True)]
    used = np.concatenate([part.used for part in parts])
    judge = np.concatenate([part.judge for part in parts])
    e = np.concatenate(left)
    return rms(e[used]), rms(e[judge])
