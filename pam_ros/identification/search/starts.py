# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fits with one more effect: a few cheap iterations from each of its starts."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy
from pam_ros.identification.fit.extend import bounded, started, with_effect
from pam_ros.identification.fit.onset import keeping_onset
from pam_ros.identification.fit.places import Place
from pam_ros.identification.fit.solve import (
    Solution,
    initial_solution,
    levenberg_marquardt,
    with_nominal_constants,
)
from pam_ros.identification.fit.unknowns import MemoryStart, OfEffect
from pam_ros.identification.search.setting import Model, Setting
from pam_ros.rig import layout as at

Array = NDArray[np.float64]
# An unknown has an influence if it can change the residuals by so many standard deviations of the
# noise. A smaller influence is not visible in a score: ln(1 + 0.3^2) = 0.09.
LEAST_INFLUENCE = 0.3
WEAKER = 1.0 / 3.0  # of the strengths of a rival, with which fits also begin


def screen(parent: Model, place: Place, setting: Setting) -> list[Solution]:
    """Return cheap fits of the effect at *place* on top of *parent*, the best score first.

    They begin with each start of the effect, with the parent's discrepancy and with none (a slow
    discrepancy describes slow errors, and a fit that begins with it may not find an effect that
    causes them). With the starts that are the best with either of them, they also begin at the
    nominal constants (re-tuned constants may compensate for the missing effect). If the parent has
    a rival of the effect, which may have taken its place, they also begin with a weaker rival. The
    onset, if there is one, keeps its value.
    """
    starts = [*place.fit_starts, *guessed(parent, place)]
    found = []
    for known, processes in _grounds(parent.solution):
        wider = [extended(known, place, start, setting) for start in starts]
        best: list[int] = []
        for process in processes:
            some = [_screened(replace(one, discrepancy=process), setting) for one in wider]
            order = sorted(range(len(some)), key=lambda k: some[k].cost)
            found += [some[k] for k in order[: setting.budget.fits]]
            best += order[:1]
        starts = [starts[k] for k in dict.fromkeys(best)]
    for known in _with_weaker_rivals(parent, place, setting):
        for start in place.fit_starts:
            one = extended(known, place, start, setting)
            found.append(_screened(replace(one, discrepancy=WHITE), setting))
    return sorted((_with_own_discrepancy(one) for one in found), key=lambda one: one.score)


def _screened(wider: Solution, setting: Setting) -> Solution:
    def cheap(solution: Solution) -> Solution:
        return levenberg_marquardt(solution, setting.budget.screening, renew=False)

    return keeping_onset(wider, cheap)


def _grounds(solution: Solution) -> list[tuple[Solution, list[Discrepancy]]]:
    """Return solutions to which an effect is added, each with the discrepancies to begin with."""
    own = [solution.discrepancy] if solution.discrepancy != WHITE else []
    return [
        (solution, [*own, WHITE]),
        *((one, [WHITE]) for one in with_nominal_constants(solution)),
    ]


def _with_weaker_rivals(parent: Model, place: Place, setting: Setting) -> list[Solution]:
    """Return the solution of *parent* with the rivals of the effect at *place* that it has weaker.

    The list is empty if it has none. A lag that was fitted alone is as long as the lag and the
    dead time of the rig together, for example, and a fit from there ends near by.
    """
    rivals = {
        name
        for name in parent.effects
        for other in (setting.places[name],)
        if {*other.rows} & {*place.rows}
        and (other.effect.name in place.effect.rivals or place.effect.name in other.effect.rivals)
    }
    known = parent.solution
    u = known.u.copy()
    for k, unknown in enumerate(known.problem.unknowns):
        of = unknown.of
        if isinstance(of, OfEffect) and of.place in rivals:
            about = next(p for p in setting.places[of.place].parameters if p.name == of.parameter)
            u[k] *= WEAKER if about.strength else 1.0
    if np.array_equal(u, known.u):
        return []
    return [initial_solution(known.problem, u, known.discrepancy)]


def _with_own_discrepancy(solution: Solution) -> Solution:
    return replace(solution, discrepancy=solution.most_likely())


def extended(
    solution: Solution, place: Place, start: dict[str, float], setting: Setting
) -> Solution:
    """Return *solution* with the effect at *place*, with its parameters at *start*.

    The columns of the Jacobian that belong to the effect are computed; the others are kept, unless
    the values of unknowns of *solution* change.
    """
    problem, added = with_effect(solution.problem, setting.joint, place, start)
    there = started(solution.problem, solution.u, place, start)
    begin = np.concatenate([there, added])
    problem = bounded(problem, begin, setting.joint, place)
    u = np.clip(begin, *problem.bounds)
    if np.array_equal(there, solution.u):
        r = problem.residuals(u)
        own = problem.jacobian(u, r, only=range(solution.u.size, u.size))
        whole = Solution(problem, u, r, np.hstack([solution.jacobian, own]), solution.discrepancy)
    else:
        whole = initial_solution(problem, u, solution.discrepancy)
    return without_idle(whole, setting.noise)


def have_influence(solution: Solution, noise: float) -> NDArray[np.bool_]:
    """Return which unknowns (k,) can change the residuals by more than MOVES *noise*."""
    size = np.linalg.norm(solution.jacobian, axis=0) * solution.problem.prior
    return np.asarray(size > LEAST_INFLUENCE * noise)


def without_idle(solution: Solution, noise: float) -> Solution:
    """Return *solution* without those unknown memories that have no influence on their run."""
    problem = solution.problem
    moves = have_influence(solution, noise)
    keep = [
        k
        for k, unknown in enumerate(problem.unknowns)
        if not isinstance(unknown.of, MemoryStart) or moves[k]
    ]
    unknowns = tuple(problem.unknowns[k] for k in keep)
    return replace(
        solution,
        problem=replace(problem, unknowns=unknowns),
        u=solution.u[keep],
        jacobian=solution.jacobian[:, keep],
    )


def guessed(parent: Model, place: Place) -> tuple[dict[str, float], ...]:
    """Return the starts that an effect derives from *parent*'s residual in the longest run."""
    if place.effect.equations.guess is None:
        return ()
    problem = parent.solution.problem
    longest = max(range(len(problem.segments)), key=lambda k: problem.segments[k].t.size)
    s = problem.segments[longest]
    out = problem.runs(parent.solution.u, longest)[0]
    left = s.target - out[:, s.column]
    # Samples that are not fitted are not used: the residual is interpolated there.
    residual = np.interp(s.t, s.t[s.fit], left[s.fit])
    position = s.target if s.quantity == 'position' else out[:, at.RUN_S]
    # The contraction of one muscle in line with the load; of other joints the angle itself.
    length = problem.row[at.LENGTH]
    pressure = out[:, at.RUN_P :: 2].max(axis=1)
    return place.guess(s.t, pressure, position / length, residual, s.unit)
