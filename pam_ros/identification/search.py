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
from pam_ros.identification.candidate import (
    EARNED,
    Fit,
    extended,
    fitted,
    guessed,
    look,
    refine,
    released,
)
from pam_ros.identification.coarse import coarse_step, thinned
from pam_ros.identification.noise import Noise
from pam_ros.identification.problem import Problem
from pam_ros.identification.segment import Segment, windows
from pam_ros.identification.solve import Solution, predicted_cost, solve
from pam_ros.identification.unknowns import Unknown, declared_unknowns, run_unknowns
from pam_ros.rig.model import RigModel

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

EFFECTS_AT_MOST = 3
REFINED = 4  # candidates of a round that get a full fit
WINDOW = 2.0  # s of a run of a load without a muscle
OUTLIER = 1.48  # median residuals beyond which one is an outlier
COMPARABLE = 0.15  # and its share of the best fall
SURELY = 0.9  # share of the noise floor below which no model can come
OBVIOUS = 0.8  # ratio of errors kept back below which no odd parameter needs a reason
PROMISING = 4.0  # fall of the cost in a cheap look that earns a full fit
AS_GOOD = 0.03  # share of the RMSE kept back by which two candidates may differ
AS_MUCH = 0.03  # and of the fall that the better one brings
IMPLAUSIBLE = 12.0  # chi square of re-tuned parameters under their prior that asks for a reason


@dataclass(frozen=True, eq=False)
class Tried:
    """A candidate's fit in a round, and what speaks for it."""

    effect: Effect
    parents: tuple[str, ...]
    fit: Fit
    evidence: evidence.Evidence
    rank: float
    chosen: bool = False


@dataclass(frozen=True, eq=False)
class Search:
    """How the search went: each round's candidates, and the models that it ended with."""

    declared: Fit
    retuned: Fit
    augmented: Fit
    rounds: tuple[tuple[Tried, ...], ...]


def problem_of(
    model: RigModel, segments: Sequence[Segment], noise: Noise, step: float, stride: int = 0
) -> Problem:
    """Return the problem of re-tuning *model* to the segments, at most *step* s a step.

    *stride* says how many samples apart those of thinned segments were in the recording, 0 where
    they are not thinned. Starts stay near to the measurement, but for those of the windows that
    a load without a muscle is cut into: there the rest of a wrong model must find room.
    """
    sigma = np.inf if stride and model.muscle.is_load_only else noise.sigma
    unknowns: list[Unknown] = [*declared_unknowns(model), *run_unknowns(segments, sigma)]
    rho = noise.rho ** max(stride, 1)
    samples = sum(int(np.count_nonzero(s.fit)) for s in segments)
    return Problem(
        tuple(segments),
        model.layout,
        model.active,
        model.row(),
        tuple(unknowns),
        samples * (1.0 - rho) / (1.0 + rho),
        step,
    )


def only_starts(problem: Problem, u: Array, pool: Executor) -> Solution:
    """Return u with its start states fitted and the rest as it is, all columns computed."""
    starts = [k for k, unknown in enumerate(problem.unknowns) if unknown.segment >= 0]
    if starts:
        rest = [k for k in range(len(u)) if k not in starts]
        row = replace(problem, unknowns=tuple(problem.unknowns[k] for k in rest)).row_at(u[rest])
        only = replace(problem, row=row, unknowns=tuple(problem.unknowns[k] for k in starts))
        u = u.copy()
        u[starts] = solve(only, u[starts], pool=pool).u
    r = problem.residuals(u)
    return Solution(problem, u, r, problem.jacobian(u, r, pool), 0)


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
            retuned = _robust(retuned, pool)
            same = retuned.solution.problem
            declared = fitted((), only_starts(same, np.zeros(len(same.unknowns)), pool))
        parent, rounds = retuned, []
        for k in range(EFFECTS_AT_MOST):
            if parent.effects and not _could_matter(parent, retuned, noise):
                break
            progress(0.1 + 0.25 * k, f'trying effects, round {k + 1}')
            tried = _round(parent, declared, model, pool)
            able = [t for t in tried if admitted(t, parent, retuned, noise)]
            if not able:
                rounds.append(tried)
                break
            first = plainest(able)
            chosen = replace(first, chosen=True)
            rounds.append(tuple(chosen if t is first else t for t in tried))
            parent = released(chosen.fit, model, chosen.effect, pool)
            if thin[0].kind == 'held':
                parent = _robust(parent, pool)
        progress(0.85, 'leaving out what is not needed')
        parent = _without_needless(parent, retuned, model, noise, pool)
        parent = _plain(parent, model, pool)
    return Search(declared, retuned, parent, tuple(rounds))


def _robust(fit: Fit, pool: Executor) -> Fit:
    """Return *fit* with outliers limited: a force cell that slipped spoils a whole recording.

    A residual is an outlier beyond the normal one's scale, by the median of its size.
    """
    for _ in range(2):
        solution = fit.solution
        e = np.concatenate(
            [
                (p - s.target)[s.fit]
                for p, s in zip(
                    solution.problem.predict(solution.u), solution.problem.segments, strict=True
                )
            ]
        )
        limited = replace(solution.problem, outlier=OUTLIER * float(np.median(np.abs(e))))
        fit = fitted(fit.effects, solve(limited, solution.u, pool=pool))
    return fit


def plainest(able: Sequence[Tried]) -> Tried:
    """Return the candidate with the fewest parameters that explains as much as the first.

    One that becomes another of them as its strength vanishes is not the plainest: a leak so
    small that only its refill shows is a lag.
    """
    equal = [t for t in able if explains_as_much(t, able[0])]
    names = {t.effect.name for t in equal}
    return min(equal, key=lambda t: (bool(names & set(t.effect.contains)), len(t.fit.solution.u)))


def explains_as_much(tried: Tried, best: Tried) -> bool:
    """Say whether a candidate leaves as little of the samples kept back as the *best*, in use.

    Statistics alone would tell apart what two models miss by the last bit of their numerics.
    """
    least = best.fit.held_error
    without = least / (1.0 - best.evidence.gain)
    tolerance = min(AS_GOOD * least, AS_MUCH * max(without - least, 0.0))
    return tried.fit.held_error <= least + tolerance


def admitted(tried: Tried, parent: Fit, retuned: Fit, noise: Noise) -> bool:
    """Say whether a candidate counts as an effect that the model lacks."""
    e = tried.evidence
    if not e.interval_clear or e.p > evidence.SIGNIFICANCE:
        return False
    if e.absorbed:
        return True
    if e.gain < evidence.GAIN:
        return False
    return not parent.effects or _matters(parent, tried.fit, retuned, noise)


def _matters(without: Fit, fit: Fit, retuned: Fit, noise: Noise) -> bool:
    """Say whether a further effect explains more than the form of those before it could miss.

    No effect of the library is quite the one of nature, and the rest that it leaves invites
    others: so a further one must explain a share of what re-tuning left, or much of the rest.
    """
    return _is_much(without.held_error - fit.held_error, without, retuned, noise)


def _could_matter(fit: Fit, retuned: Fit, noise: Noise) -> bool:
    """Say whether *fit* leaves so much above the noise that one more effect could matter."""
    return _is_much(fit.held_error - SURELY * noise.sigma, fit, retuned, noise)


def _is_much(fall: float, without: Fit, retuned: Fit, noise: Noise) -> bool:
    excess = max(retuned.held_error - noise.sigma, 0.0)
    return (
        fall >= evidence.LATER_SHARE * excess or fall >= evidence.LATER_GAIN * without.held_error
    )


def _round(parent: Fit, declared: Fit, model: RigModel, pool: Executor) -> tuple[Tried, ...]:
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
    for i in [i for i in np.argsort(-falls)[:REFINED] if worth[i]]:
        fits[absent[i].name] = refine(parent, absent[i], looks[i], pool)
    nearest = min(fits.values(), key=lambda fit: fit.score)
    if nearest.held_error > OBVIOUS * parent.held_error and not parent.effects:
        for effect in absent:
            if _is_static(effect) and _strain(parent) > IMPLAUSIBLE:
                straight = _from_declared(declared, model, effect, pool)
                fits[effect.name] = min(fits[effect.name], straight, key=lambda fit: fit.score)
    known = {e.name: e for e in absent}
    p = evidence.holm(np.array([_p(parent, fits[name]) for name in known]))
    tried = []
    for (name, effect), p_corrected in zip(known.items(), p, strict=True):
        fit = fits[name]
        gain = 1.0 - fit.held_error / parent.held_error
        found = evidence.Evidence(
            float(p_corrected),
            gain,
            evidence.strengths_clear(fit, float(p_corrected)),
            _absorbed(parent, fit, effect) and gain > -evidence.GAIN,
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
    best = [look(parent, model, effect, read)[0] for parent in parents]
    return sorted(best, key=lambda solution: solution.cost)


def _absorbed(parent: Fit, fit: Fit, effect: Effect) -> bool:
    """Say whether *effect* explains what re-tuning explains, too, but only by odd parameters."""
    relief = _strain(parent) - _strain(fit)
    return not parent.effects and _is_static(effect) and relief > IMPLAUSIBLE


def _p(parent: Fit, fit: Fit) -> float:
    """Return the p value of a fit: of its residuals, or of its less strained parameters."""
    from scipy.stats import chi2

    count = len(fit.solution.u) - len(parent.solution.u)
    p = evidence.f_test(parent, fit)
    if not parent.effects:
        p = min(p, float(chi2.sf(max(_strain(parent) - _strain(fit), 0.0), count)))
    return p


def _strain(fit: Fit) -> float:
    """Return how far the declared parameters were moved, as a chi square."""
    z = fit.solution.problem.priors(fit.solution.u)
    return float(z @ z)


def _rank(fit: Fit) -> float:
    """Return the score of a fit with what it says of the samples kept back: low is good."""
    problem = fit.solution.problem
    kept = sum(int(np.count_nonzero(~s.fit)) for s in problem.segments)
    if kept == 0:
        return fit.score
    share = problem.independent / fit.solution.r.size
    return fit.score + kept * share * float(np.log(fit.held_error**2))


def _is_static(effect: Effect) -> bool:
    """Say whether an effect only changes what the parameters of the model could change too."""
    where = (effect.mass, effect.contraction, effect.pressure)
    return not effect.states and any(f is not None for f in where)


def _from_declared(declared: Fit, model: RigModel, effect: Effect, pool: Executor) -> Fit:
    """Return the fit of *effect* that begins at the declared parameters, not the re-tuned."""
    known = declared.solution
    guesses = []
    for start in effect.fit_starts:
        problem, added = extended(known.problem, model, effect, start)
        u = np.concatenate([known.u, added])
        r = problem.residuals(u)
        own = problem.jacobian(u, r, pool, range(len(known.u), len(u)))
        jacobian = np.hstack([known.jacobian, own])
        guesses.append((predicted_cost(problem, u, r, jacobian), problem, u, jacobian))
    _, problem, u, jacobian = min(guesses, key=lambda guess: guess[0])
    return fitted((effect.name,), solve(problem, u, pool=pool, jacobian=jacobian))


def _without_needless(
    fit: Fit, retuned: Fit, model: RigModel, noise: Noise, pool: Executor
) -> Fit:
    """Return *fit* without the effects that it no longer needs, one after another."""
    while len(fit.effects) > 1:
        for name in fit.effects[:-1]:
            smaller = _dropped(fit, name, model, pool)
            gain = 1.0 - fit.held_error / smaller.held_error
            if gain < evidence.GAIN or not _matters(smaller, fit, retuned, noise):
                fit = smaller
                break
        else:
            return fit
    return fit


def _dropped(fit: Fit, name: str, model: RigModel, pool: Executor) -> Fit:
    """Return the fit without effect *name*, fitted anew."""
    names = [p.name for p in _effect(model, name).parameters]
    smaller = _reduced(fit, name, names, model, pool)
    return replace(smaller, effects=tuple(e for e in fit.effects if e != name))


def _plain(fit: Fit, model: RigModel, pool: Executor) -> Fit:
    """Return *fit* with the fewest parameters per effect that do as well.

    Finer ones may have been freed when another effect was still missing, to make up for it.
    """
    for name in fit.effects:
        prefix = f'effects.{name}.'
        there = {u.name.removeprefix(prefix) for u in fit.solution.problem.unknowns}
        for start in sorted(_effect(model, name).fit_starts, key=len):
            finer = [p.name for p in _effect(model, name).parameters if p.name not in start]
            if there >= set(start) and there & set(finer):
                smaller = _reduced(fit, name, finer, model, pool)
                if smaller.score < fit.score + EARNED:
                    fit = smaller
                    break
    return fit


def _reduced(
    fit: Fit, name: str, parameters: Sequence[str], model: RigModel, pool: Executor
) -> Fit:
    """Return the fit with *parameters* of effect *name* at their defaults, fitted anew."""
    problem = fit.solution.problem
    gone = {f'effects.{name}.{p}' for p in parameters}
    keep = [k for k, u in enumerate(problem.unknowns) if u.name not in gone]
    row = problem.row.copy()
    j = model.layout.parameter_at[name]
    for k, p in enumerate(_effect(model, name).parameters):
        if p.name in parameters:
            row[j + k] = p.default
    smaller = replace(problem, row=row, unknowns=tuple(problem.unknowns[k] for k in keep))
    return fitted(fit.effects, solve(smaller, fit.solution.u[keep], pool=pool))


def _effect(model: RigModel, name: str) -> Effect:
    return next(e for e in model.library if e.name == name)
