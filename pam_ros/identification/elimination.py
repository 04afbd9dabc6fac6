# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Backward elimination: effects, and parameters of theirs, that are not needed after all."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from pam_ros.effects.base import Effect
from pam_ros.effects.names import EffectName
from pam_ros.identification import evidence
from pam_ros.identification.admission import IMPLAUSIBLE, is_odd, leeway, matters, strain
from pam_ros.identification.candidate import EARNED, Fit, extended, fitted, price_of
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.fit.unknowns import parameters_of
from pam_ros.identification.problem import Problem
from pam_ros.identification.solve import solve
from pam_ros.rig.joint import Joint


def without_needless(
    fit: Fit,
    doubted: Sequence[str],
    retuned: Fit,
    model: Joint,
    noise: Noise,
    pool: Executor,
) -> Fit:
    """Return *fit* without those of the effects *doubted* that it does not need, one by one.

    One without which the declared parameters would have to be odd ones is needed, and so is the
    last that is left.
    """
    while len(fit.effects) > 1:
        for name in (name for name in fit.effects if name in doubted):
            smaller = dropped(fit, name, model, pool)
            gain = 1.0 - fit.held_error / smaller.held_error
            if strain(smaller) - strain(fit) > IMPLAUSIBLE * leeway(fit, noise):
                continue
            is_needless = gain < evidence.GAIN or not matters(smaller, fit, retuned, noise)
            if is_needless or is_odd(_effect(model, name), smaller, fit):
                fit = smaller
                break
        else:
            return fit
    return fit


def promises_little(fit: Fit, name: str, hope: float, model: Joint) -> bool:
    """Say whether the cost rises by less than *hope* without effect *name*, by the derivatives."""
    names = [p.name for p in _effect(model, name).parameters]
    return _promised_rise(fit, name, names, model) < hope


def dropped(fit: Fit, name: str, model: Joint, pool: Executor) -> Fit:
    """Return the fit without effect *name*, fitted anew."""
    names = [p.name for p in _effect(model, name).parameters]
    smaller = _reduced(fit, name, names, model, pool)
    return replace(smaller, effects=tuple(e for e in fit.effects if e != name))


def plain(fit: Fit, model: Joint, pool: Executor, hope: float = np.inf) -> Fit:
    """Return *fit* with the fewest parameters per effect that do as well.

    Finer ones may have been freed when another effect was still missing, to make up for it. Only
    those are tried without which the cost rises by less than *hope*, by the derivatives.
    """
    for name in fit.effects:
        there = parameters_of(fit.solution.problem.unknowns, name)
        starts = sorted(_effect(model, name).fit_starts, key=len)
        # Several starts are of the same parameters.
        for kept in dict.fromkeys(frozenset(start) for start in starts):
            finer = [p.name for p in _effect(model, name).parameters if p.name not in kept]
            is_wider = there >= kept and there & set(finer)
            if is_wider and (hope == np.inf or _promised_rise(fit, name, finer, model) < hope):
                smaller = _reduced(fit, name, finer, model, pool, fit.score + EARNED)
                if smaller.score < fit.score + EARNED:
                    fit = smaller
                    break
    return fit


def became(fit: Fit, name: str, other: Effect, model: Joint, pool: Executor) -> Fit:
    """Return the fit with *other* in the place of effect *name*, which contains it, fitted anew.

    It begins where the two are the same: with the parameters that they share.
    """
    effect, known = _effect(model, name), fit.solution
    names = [p.name for p in effect.parameters]
    row = known.problem.row_at(known.u)
    values = {n: row[model.layout.index(effect, k)] for k, n in enumerate(names)}
    there = parameters_of(known.problem.unknowns, name)
    strengths = {p.name for p in other.parameters if p.strength}
    start = {
        theirs: float(values[own])
        for theirs, own in effect.contains[other.name].items()
        if theirs in strengths or own in there
    }
    smaller, keep = _without(known.problem, name, names, model)
    problem, added = extended(smaller, model, other, start)
    solution = solve(problem, np.concatenate([known.u[keep], added]), pool=pool)
    return fitted((*(e for e in fit.effects if e != name), other.name), solution)


def _promised_rise(fit: Fit, name: str, parameters: Sequence[str], model: Joint) -> float:
    """Return by how much the cost rises with *parameters* at their defaults, all else refitted.

    By the derivatives alone: infinite where a default is beyond what they reach.
    """
    solution, problem = fit.solution, fit.solution.problem
    defaults = {EffectName(name, p.name).flat: p.default for p in _effect(model, name).parameters}
    gone = {EffectName(name, p).flat for p in parameters}
    is_gone = np.array([u.name in gone for u in problem.unknowns])
    move = np.array(
        [
            unknown.coordinate(defaults[unknown.name]) - u
            for unknown, u in zip(problem.unknowns, solution.u, strict=True)
            if unknown.name in gone
        ]
    )
    if not np.all(np.isfinite(move)):
        return float(np.inf)
    normal = solution.normal
    pulled = normal[:, is_gone] @ move
    answer = np.linalg.lstsq(normal[np.ix_(~is_gone, ~is_gone)], pulled[~is_gone])[0]
    return float(move @ pulled[is_gone] - pulled[~is_gone] @ answer)


def _reduced(
    fit: Fit,
    name: str,
    parameters: Sequence[str],
    model: Joint,
    pool: Executor,
    goal: float = np.inf,
) -> Fit:
    """Return the fit with *parameters* of effect *name* at their defaults, fitted anew.

    As far as it may reach a score of *goal*.
    """
    smaller, keep = _without(fit.solution.problem, name, parameters, model)
    least = goal - price_of(smaller)
    return fitted(fit.effects, solve(smaller, fit.solution.u[keep], pool=pool, goal=least))


def _without(
    problem: Problem, name: str, parameters: Sequence[str], model: Joint
) -> tuple[Problem, list[int]]:
    """Return the problem with *parameters* of effect *name* at their defaults.

    And the numbers of the unknowns that are left.
    """
    gone = {EffectName(name, p).flat for p in parameters}
    keep = [k for k, u in enumerate(problem.unknowns) if u.name not in gone]
    row, effect = problem.row.copy(), _effect(model, name)
    for k, p in enumerate(effect.parameters):
        if p.name in parameters:
            row[model.layout.index(effect, k)] = p.default
    unknowns = tuple(problem.unknowns[k] for k in keep)
    return replace(problem, row=row, unknowns=unknowns), keep


def _effect(model: Joint, name: str) -> Effect:
    return next(e for e in model.library if e.name == name)
