# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fits with one more effect: first a cheap look from every starting value, then a full fit."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.identification.fit.extend import finer_starts
from pam_ros.identification.fit.unknowns import OfEffect, effect_unknowns
from pam_ros.identification.problem import Problem
from pam_ros.identification.solve import (
    Solution,
    amplified_cost,
    improved,
    predicted_cost,
    solve,
)
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
FURTHER = 2  # starts from which a look takes a second step
LITTLE = 0.05  # share of a start's strength that is nearly none
WHISPERS = 4  # steps from there
EARNED = 10.0  # fall of the score that pays for an effect's finer parameters
PROMISING = 4.0  # fall of the cost that earns a closer look


@dataclass(frozen=True, eq=False)
class Fit:
    """A model that was fitted: the effects in it and where it ended."""

    effects: tuple[str, ...]
    solution: Solution
    fit_error: float
    held_error: float

    @property
    def score(self) -> float:
        """Cost plus what its number of parameters costs: lower is better."""
        return self.solution.cost + price_of(self.solution.problem)

    @property
    def rank(self) -> float:
        """Score with what it says of the samples kept back: lower is better."""
        problem = self.solution.problem
        kept = sum(int(np.count_nonzero(~s.fit)) for s in problem.segments)
        if kept == 0:
            return self.score
        share = problem.independent / self.solution.r.size
        return self.score + kept * share * float(np.log(self.held_error**2))


def price_of(problem: Problem) -> float:
    """Return what the number of parameters costs that nothing was declared of (Schwarz)."""
    count = sum(k.prior == np.inf and k.is_parameter for k in problem.unknowns)
    return count * float(np.log(problem.independent))


def fitted(effects: tuple[str, ...], solution: Solution) -> Fit:
    """Return the Fit of a solution, its errors computed."""
    fit, held = solution.problem.errors(solution.u)
    return Fit(effects, solution, fit, held)


def extended(
    problem: Problem, model: Joint, effect: Effect, start: dict[str, float]
) -> tuple[Problem, Array]:
    """Return the problem with *effect* added, and the coordinates at which it starts.

    The effect's parameters that *start* does not name keep their defaults.
    """
    added = effect_unknowns(model, effect, start)
    row = problem.row.copy()
    for k, p in enumerate(effect.parameters):
        row[model.layout.index(effect, k)] = start.get(p.name, p.default)
    u = [k.coordinate(start[k.of.which.parameter]) for k in added if isinstance(k.of, OfEffect)]
    new = replace(problem, row=row, active=model.library, unknowns=(*problem.unknowns, *added))
    return new, np.array(u)


def look(
    parent: Fit,
    model: Joint,
    effect: Effect,
    tried: int,
    read: Sequence[dict[str, float]] = (),
) -> list[Solution]:
    """Return the best cheap fits of *effect* on top of *parent*, the best first.

    One simulation at each known starting value tells in which direction it moves the residual;
    from the *tried* most promising, steps are taken in which the columns of what the parent
    already has are taken from it, and only the effect's own are computed. Of the starts that
    were *read* from the residual, see :func:`guessed`, a look is taken in any case: they need no
    ranking, nor could they have one, since a phase that is not fitted yet may point the wrong way.
    """
    known = parent.solution
    guesses = []
    for start in effect.fit_starts:
        problem, added = extended(known.problem, model, effect, start)
        r = problem.residuals(np.concatenate([known.u, added]))
        guesses.append((amplified_cost(known, r), problem, added))
    guesses.sort(key=lambda guess: guess[0])
    starts = [(problem, added) for _, problem, added in guesses[:tried]]
    starts += [extended(known.problem, model, effect, start) for start in read]
    solutions = [_stepped(known, problem, added) for problem, added in starts]
    solutions.sort(key=lambda solution: solution.cost)
    further = [_again(known, solution) for solution in solutions[:FURTHER]]
    return sorted([*further, *solutions[FURTHER:]], key=lambda solution: solution.cost)


def whisper(parent: Fit, model: Joint, effect: Effect) -> Solution:
    """Return a short fit of *effect* that begins on top of *parent* with hardly any of it.

    For where no look from a known start came down to the parent: a nested model can always. No
    step is taken where the derivatives there promise nothing.
    """
    strengths = {p.name for p in effect.parameters if p.strength}
    start = {
        name: LITTLE * value if name in strengths else value
        for name, value in effect.fit_starts[0].items()
    }
    known = parent.solution
    problem, added = extended(known.problem, model, effect, start)
    u = np.concatenate([known.u, added])
    r = problem.residuals(u)
    own = problem.jacobian(u, r, only=range(len(known.u), len(u)))
    jacobian = np.hstack([known.jacobian, own])
    if predicted_cost(problem, u, r, jacobian) > known.cost - PROMISING:
        return Solution(problem, u, r, jacobian, 0)
    return solve(problem, u, WHISPERS, jacobian=jacobian)


def released(fit: Fit, model: Joint, effect: Effect, pool: Executor) -> Fit:
    """Return *fit* with the parameters of *effect* freed that its start left at their defaults.

    The plainer fit is kept where the others do not earn their cost. From each of the options a
    fit goes to its end: how well it begins says little where friction sticks.
    """
    known = fit.solution
    firsts = _freed(known, model, effect)
    ends = pool.map(lambda s: improved(s, goal=fit.score - EARNED - price_of(s.problem)), firsts)
    wide = [fitted(fit.effects, s) for s in ends]
    best = min(wide, key=lambda one: one.score, default=fit)
    return best if best.score < fit.score - EARNED else fit


def freed(known: Solution, model: Joint, effect: Effect, iterations: int) -> Solution:
    """Return a short fit with some or all of the parameters of *effect* freed that are fixed."""
    looks = [_again(known, first) for first in _freed(known, model, effect)]
    if not looks:
        return known
    return improved(min(looks, key=lambda solution: solution.cost), iterations)


def _freed(known: Solution, model: Joint, effect: Effect) -> list[Solution]:
    problem = known.problem
    options = finer_starts(problem.unknowns, problem.row_at(known.u), model, effect)
    return [_stepped(known, *extended(problem, model, effect, o)) for o in options]


def _stepped(known: Solution, problem: Problem, added: Array) -> Solution:
    """Return a step from the *added* unknowns on top of *known*, whose columns are kept."""
    return _again(known, _begun(known, problem, np.concatenate([known.u, added])))


def began(parent: Fit, problem: Problem, u: Array) -> Solution:
    """Return a step from u, which begins with all unknowns of *parent* at values of their own."""
    return _again(parent.solution, _begun(parent.solution, problem, u))


def _begun(known: Solution, problem: Problem, u: Array) -> Solution:
    jacobian = np.hstack([known.jacobian, np.empty((known.r.size, u.size - known.u.size))])
    return Solution(problem, u, problem.residuals(u), jacobian, 0)


def _again(known: Solution, solution: Solution) -> Solution:
    """Return one more step of a *solution* that keeps the columns of *known*."""
    return improved(solution, 1, frozen=len(known.u))


def guessed(parent: Fit, effect: Effect) -> tuple[dict[str, float], ...]:
    """Return the starts that *effect* reads from what *parent* leaves of the longest run.

    Samples that are kept back stay unseen: their residual is given as 0, and their contraction,
    where it is what is to be explained, as NaN.
    """
    if effect.guess is None:
        return ()
    problem = parent.solution.problem
    # A window that is kept back as a whole has nothing to read.
    longest = max(range(len(problem.segments)), key=lambda k: problem.fit_rows[k].size)
    s = problem.segments[longest]
    out = problem.runs(parent.solution.u, longest)[0]
    is_free = s.kind == 'free'
    residual = np.where(s.fit, s.target - out[:, at.RUN_S if is_free else at.RUN_F], 0.0)
    position = np.where(s.fit, s.target, np.nan) if is_free else out[:, at.RUN_S]
    l0 = problem.row[problem.layout.constant(at.L0)]
    return effect.guess(s.t, out[:, at.RUN_P], position / l0, residual)


def refine(parent: Fit, effect: Effect, looks: Sequence[Solution], pool: Executor | None) -> Fit:
    """Return the best full fit of *effect* on top of *parent*, from its cheap ones.

    Friction and stops make a fit stop in the wrong place now and then, so that the better look
    is not always the better fit.
    """
    effects = (*parent.effects, effect.name)
    best = fitted(effects, improved(looks[0], pool=pool))
    for start in looks[1:]:
        goal = best.score - price_of(start.problem)
        other = fitted(effects, improved(start, pool=pool, goal=goal))
        best = min(best, other, key=lambda fit: fit.score)
    return best
