# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One round of the search: every effect that a model might lack, fitted on top of it."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.identification import evidence
from pam_ros.identification.admission import (
    IMPLAUSIBLE,
    Tried,
    absorbed,
    is_static,
    p_of,
    strain,
)
from pam_ros.identification.candidate import (
    EARNED,
    PROMISING,
    Fit,
    began,
    extended,
    fitted,
    guessed,
    look,
    refine,
    whisper,
)
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.elimination import dropped
from pam_ros.identification.problem import Problem
from pam_ros.identification.retuning import only_starts
from pam_ros.identification.solve import Solution, predicted_cost, solve
from pam_ros.identification.weak import Motion, at_weak, weak_fits, weak_starts
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]

REFINED = 4  # candidates of a round that get a full fit
COMPARABLE = 0.15  # share of the best fall from which they do
OBVIOUS = 0.8  # ratio of errors kept back below which no odd parameter needs a reason
CREDITED = 2  # best candidates of a round from which its parent is fitted anew
NEAR = 1.2  # noise floors at which nothing is left to refine
TRIED = (2, 1)  # starts of an effect from which looks are taken: re-tuned, as declared


@dataclass(frozen=True, eq=False)
class Setting:
    """What every round is given: the model, its fit as declared, the data's noise and motion."""

    model: Joint
    declared: Fit
    noise: Noise
    motions: Sequence[Motion]
    pool: Executor


def try_effects(
    parent: Fit, effects: Sequence[Effect], setting: Setting
) -> tuple[Fit, tuple[Tried, ...]]:
    """Return each of *effects* on top of *parent*, the promising fitted in full, the best first.

    And the parent, which may have come down itself from where a candidate has led.
    """
    model, pool = setting.model, setting.pool
    weak = weak_fits(parent, setting.motions, pool)
    if parent.effects and parent.fit_error > NEAR * setting.noise.sigma:
        anew = pool.map(lambda one, fit=parent: at_weak(fit, one), weak)
        parent = min([parent, *anew], key=lambda fit: fit.score)
    parents = (parent, _as_declared(parent, pool) if parent.effects else setting.declared)
    read = {e.name: guessed(parent, e) for e in effects}
    led = weak_starts(parent, model, effects, read, weak, pool)
    looks = list(pool.map(lambda e: _looks(parents, model, e, read[e.name], led[e.name]), effects))
    fits = {
        e.name: fitted((*parent.effects, e.name), found[0])
        for e, found in zip(effects, looks, strict=True)
    }
    falls = np.array([parent.solution.cost - found[0].cost for found in looks])
    worth = falls > max(PROMISING, COMPARABLE * falls.max())
    chosen = [i for i in np.argsort(-falls)[:REFINED] if worth[i]]
    # Side by side: a fit by itself is one simulation after the other.
    for fit in pool.map(lambda i: refine(parent, effects[i], looks[i], None), chosen):
        fits[fit.effects[-1]] = fit
    nearest = min(fits.values(), key=lambda fit: fit.score)
    if nearest.held_error > OBVIOUS * parent.held_error:
        static = [e for e in effects if is_static(e) and strain(parent) > IMPLAUSIBLE]
        for fit in pool.map(lambda e: _from_declared(parents[1], model, e), static):
            name = fit.effects[-1]
            fits[name] = min(fits[name], fit, key=lambda fit: fit.score)
    if parent.effects:
        # No effect gets the credit for where its start has led the parameters of others.
        for fit in sorted(fits.values(), key=lambda fit: fit.score)[:CREDITED]:
            if fit.score < parent.score - EARNED:
                without = dropped(fit, fit.effects[-1], model, pool)
                parent = min(parent, without, key=lambda fit: fit.score)
    return parent, _weighed(parent, effects, fits, setting.noise)


def _weighed(
    parent: Fit, effects: Sequence[Effect], fits: dict[str, Fit], noise: Noise
) -> tuple[Tried, ...]:
    """Return what speaks for each fit on top of *parent*, the best first."""
    p = evidence.holm(np.array([p_of(parent, fits[e.name], noise) for e in effects]))
    tried = []
    for effect, p_corrected in zip(effects, p, strict=True):
        fit = fits[effect.name]
        found = _evidence(parent, fit, effect, float(p_corrected), noise)
        tried.append(Tried(effect, parent.effects, fit, found, fit.rank))
    return tuple(sorted(tried, key=lambda t: t.rank))


def weighed(parent: Fit, fit: Fit, name: str, setting: Setting, count: int = 1) -> Tried:
    """Return a chosen *fit* with what speaks for its effect *name* on top of *parent*.

    It is one of *count* that were tried.
    """
    effect = next(e for e in setting.model.library if e.name == name)
    fit = replace(fit, effects=(*parent.effects, name))
    p = min(1.0, count * p_of(parent, fit, setting.noise))
    found = _evidence(parent, fit, effect, p, setting.noise)
    return Tried(effect, parent.effects, fit, found, fit.rank, chosen=True)


def _evidence(parent: Fit, fit: Fit, effect: Effect, p: float, noise: Noise) -> evidence.Evidence:
    """Return what speaks for *fit* on top of *parent*; p is corrected for the candidates."""
    gain = 1.0 - fit.held_error / parent.held_error
    return evidence.Evidence(
        p,
        gain,
        evidence.strengths_clear(fit, p),
        absorbed(parent, fit, effect, noise) and gain > -evidence.LOSS,
    )


def _as_declared(fit: Fit, pool: Executor) -> Fit:
    """Return *fit* with its re-tuned constants taken back to those declared.

    Where something is missing they have gone astray to make up for it, and so far at times that
    no fit with what was missing finds the way back.
    """
    u = fit.solution.u.copy()
    for k, unknown in enumerate(fit.solution.problem.unknowns):
        if unknown.is_parameter and unknown.prior < np.inf:
            u[k] = 0.0
    return fitted(fit.effects, only_starts(fit.solution.problem, u, pool))


def _looks(
    parents: Sequence[Fit],
    model: Joint,
    effect: Effect,
    read: Sequence[dict[str, float]],
    led: Sequence[tuple[Problem, Array]],
) -> list[Solution]:
    """Return the best cheap fit of *effect* on top of each parent, the best first.

    And the better one of those that begin where weak fits have *led*.
    """
    best = [
        look(parent, model, effect, tried, read)[0]
        for parent, tried in zip(parents, TRIED, strict=True)
    ]
    if led:
        begun = [began(parents[0], problem, u) for problem, u in led]
        best.append(min(begun, key=lambda solution: solution.cost))
    if min(solution.cost for solution in best) > parents[0].solution.cost:
        best.append(whisper(parents[0], model, effect))
    return sorted(best, key=lambda solution: solution.cost)


def _from_declared(declared: Fit, model: Joint, effect: Effect) -> Fit:
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
