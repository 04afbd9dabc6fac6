# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which effects does a residual ask for? Forward selection, then backward elimination."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.identification import evidence
from pam_ros.identification.admission import (
    IMPLAUSIBLE,
    Tried,
    absorbed,
    admitted,
    could_matter,
    is_static,
    p_of,
    plainest,
    strain,
)
from pam_ros.identification.candidate import (
    PROMISING,
    Fit,
    extended,
    fitted,
    guessed,
    look,
    refine,
    released,
    whisper,
)
from pam_ros.identification.coarse import coarse_step, thinned
from pam_ros.identification.elimination import plain, without_needless
from pam_ros.identification.noise import Noise
from pam_ros.identification.retuning import only_starts, problem_of, robust
from pam_ros.identification.segment import Segment, windows
from pam_ros.identification.solve import Solution, predicted_cost, solve
from pam_ros.rig.model import RigModel

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

EFFECTS_AT_MOST = 3
REFINED = 4  # candidates of a round that get a full fit
WINDOW = 2.0  # s of a run of a load without a muscle
COMPARABLE = 0.15  # and its share of the best fall
OBVIOUS = 0.8  # ratio of errors kept back below which no odd parameter needs a reason
TRIED = (3, 2)  # starts of an effect from which looks are taken: re-tuned, as declared


@dataclass(frozen=True, eq=False)
class Search:
    """How the search went: each round's candidates, and the models that it ended with."""

    declared: Fit
    retuned: Fit
    augmented: Fit
    rounds: tuple[tuple[Tried, ...], ...]


def search(
    model: RigModel, segments: Sequence[Segment], noise: Noise, progress: Progress
) -> Search:
    """Find the effects that *model* lacks, on thinned runs: forward, then backward."""
    step = coarse_step(model)
    thin = [thinned(s, step) for s in segments]
    stride = max(1, round(segments[0].t.size / thin[0].t.size))
    if model.muscle.is_load_only:
        thin = [part for s in thin for part in windows(s, WINDOW)]
    problem = problem_of(model, thin, noise, step, stride)
    with ThreadPoolExecutor() as pool:
        progress(0.0, 'simulating the model as declared')
        declared = fitted((), only_starts(problem, np.zeros(len(problem.unknowns)), pool))
        progress(0.05, 're-tuning its parameters')
        retuned = fitted((), solve(problem, declared.solution.u, pool=pool))
        if thin[0].kind == 'held':
            retuned = robust(retuned, pool)
            same = retuned.solution.problem
            declared = fitted((), only_starts(same, np.zeros(len(same.unknowns)), pool))
        parent, rounds = retuned, []
        for k in range(EFFECTS_AT_MOST):
            if parent.effects and not could_matter(parent, retuned, noise):
                break
            progress(0.1 + 0.25 * k, f'trying effects, round {k + 1}')
            tried = _round(parent, declared, model, noise, pool)
            able = [t for t in tried if admitted(t, parent, retuned, noise)]
            if not able:
                rounds.append(tried)
                break
            first = plainest(able)
            chosen = replace(first, chosen=True)
            rounds.append(tuple(chosen if t is first else t for t in tried))
            parent = released(chosen.fit, model, chosen.effect, pool)
            if thin[0].kind == 'held':
                parent = robust(parent, pool)
        progress(0.85, 'leaving out what is not needed')
        parent = without_needless(parent, retuned, model, noise, pool)
        parent = plain(parent, model, pool)
    return Search(declared, retuned, parent, tuple(rounds))


def _round(
    parent: Fit, declared: Fit, model: RigModel, noise: Noise, pool: Executor
) -> tuple[Tried, ...]:
    """Return every candidate on top of *parent*, the promising in full, the best first."""
    absent = [
        e
        for e in model.library
        if e.name not in (*parent.effects, *model.effects)
        and not (e.needs_muscle and model.muscle.is_load_only)
    ]
    parents = (parent, _as_declared(parent, pool) if parent.effects else declared)
    looks = list(pool.map(lambda e: _looks(parents, model, e), absent))
    fits = {
        e.name: fitted((*parent.effects, e.name), found[0])
        for e, found in zip(absent, looks, strict=True)
    }
    falls = np.array([parent.solution.cost - found[0].cost for found in looks])
    worth = falls > max(PROMISING, COMPARABLE * falls.max())
    chosen = [i for i in np.argsort(-falls)[:REFINED] if worth[i]]
    # Side by side: a fit by itself is one simulation after the other.
    for fit in pool.map(lambda i: refine(parent, absent[i], looks[i], None), chosen):
        fits[fit.effects[-1]] = fit
    nearest = min(fits.values(), key=lambda fit: fit.score)
    if nearest.held_error > OBVIOUS * parent.held_error:
        static = [e for e in absent if is_static(e) and strain(parent) > IMPLAUSIBLE]
        for fit in pool.map(lambda e: _from_declared(parents[1], model, e), static):
            name = fit.effects[-1]
            fits[name] = min(fits[name], fit, key=lambda fit: fit.score)
    known = {e.name: e for e in absent}
    p = evidence.holm(np.array([p_of(parent, fits[name], noise) for name in known]))
    tried = []
    for (name, effect), p_corrected in zip(known.items(), p, strict=True):
        fit = fits[name]
        gain = 1.0 - fit.held_error / parent.held_error
        found = evidence.Evidence(
            float(p_corrected),
            gain,
            evidence.strengths_clear(fit, float(p_corrected)),
            absorbed(parent, fit, effect, noise) and gain > -evidence.GAIN,
        )
        tried.append(Tried(effect, parent.effects, fit, found, _rank(fit)))
    return tuple(sorted(tried, key=lambda t: t.rank))


def _as_declared(fit: Fit, pool: Executor) -> Fit:
    """Return *fit* with its re-tuned constants taken back to those declared.

    Where something is missing they have gone astray to make up for it, and so far at times that
    no fit with what was missing finds the way back.
    """
    u = fit.solution.u.copy()
    for k, unknown in enumerate(fit.solution.problem.unknowns):
        if unknown.segment < 0 and unknown.prior < np.inf:
            u[k] = 0.0
    return fitted(fit.effects, only_starts(fit.solution.problem, u, pool))


def _looks(parents: Sequence[Fit], model: RigModel, effect: Effect) -> list[Solution]:
    """Return the best cheap fit of *effect* on top of each parent, the best first."""
    read = guessed(parents[0], effect)
    best = [
        look(parent, model, effect, tried, read)[0]
        for parent, tried in zip(parents, TRIED, strict=True)
    ]
    if min(solution.cost for solution in best) > parents[0].solution.cost:
        best.append(whisper(parents[0], model, effect))
    return sorted(best, key=lambda solution: solution.cost)


def _rank(fit: Fit) -> float:
    """Return the score of a fit with what it says of the samples kept back: low is good."""
    problem = fit.solution.problem
    kept = sum(int(np.count_nonzero(~s.fit)) for s in problem.segments)
    if kept == 0:
        return fit.score
    share = problem.independent / fit.solution.r.size
    return fit.score + kept * share * float(np.log(fit.held_error**2))


def _from_declared(declared: Fit, model: RigModel, effect: Effect) -> Fit:
    """Return the fit of *effect* that begins at the declared parameters, not the re-tuned."""
    known = declared.solution
    guesses = []
    for start in effect.fit_starts:
        problem, added = extended(known.problem, model, effect, start)
        u = np.concatenate([known.u, added])
        r = problem.residuals(u)
        own = problem.jacobian(u, r, only=range(len(known.u), len(u)))
        jacobian = np.hstack([known.jacobian, own])
        guesses.append((predicted_cost(problem, u, r, jacobian), problem, u, jacobian))
    _, problem, u, jacobian = min(guesses, key=lambda guess: guess[0])
    return fitted((*declared.effects, effect.name), solve(problem, u, jacobian=jacobian))
