# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The moves of a search: one effect more or less, or more or fewer of its parameters."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from math import inf, log
from typing import TypeVar

import numpy as np

from pam_ros.identification.fit.extend import (
    finer_starts,
    hidden_start,
    in_common,
    plainer_sets,
    with_parameters,
    without_effect,
)
from pam_ros.identification.fit.intervals import covariance
from pam_ros.identification.fit.onset import refine_onset
from pam_ros.identification.fit.places import Place, effect_of
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.solve import (
    Solution,
    converge,
    levenberg_marquardt,
    with_fresh_jacobian,
)
from pam_ros.identification.fit.unknowns import OfEffect, parameters_of
from pam_ros.identification.search.setting import Model, Setting
from pam_ros.identification.search.starts import extended, have_influence, screen

Option = TypeVar('Option')
# A fit with fewer parameters whose score after a few iterations is so many margins above the
# present one does not reach it: in 7 fits of 8 trials it was 160 and more, and ended 60 above.
HOPELESS_MARGIN = 30.0


def with_each(parent: Model, names: list[str], setting: Setting) -> list[Model]:
    """Return *parent* with one more effect, for each of *names*; the best score first.

    Each effect is fitted by a few cheap iterations. The most promising ones are fitted more
    closely, and the best of them until it converges, also from its next best starts.
    """
    budget = setting.budget

    def look(name: str) -> list[Model]:
        found = screen(parent, setting.places[name], setting)[: budget.fits]
        return [setting.model((*parent.effects, name), one, is_screened=True) for one in found]

    def closer(model: Model) -> Model:
        return setting.model(model.effects, converge(refine_onset(model.solution), budget.closer))

    # An effect has no start if all of its starts are derived from the residual, and none is found.
    # The effects with most starts come first, so that no thread has a long task at the end.
    longest = sorted(names, key=lambda name: -len(setting.places[name].fit_starts))
    some = [found for found in setting.pool.map(look, longest) if found]
    if not some:
        return []
    looked = sorted(some, key=lambda found: found[0].score)
    rivals, others = looked[: budget.rivals], [found[0] for found in looked[budget.rivals :]]
    fits = sorted(setting.pool.map(closer, [found[0] for found in rivals]), key=_score)
    best = fits[0].effects
    again = [m for found in rivals for m in found[1:] if m.effects == best]
    nearest = min([fits[0], *setting.pool.map(closer, again)], key=_score)
    end = converge(refine_onset(nearest.solution), budget.iterations, setting.pool)
    fits[0] = setting.model(best, end)
    return sorted([*fits, *others], key=_score)


def _score(model: Model) -> float:
    return model.score


def with_more_parameters(model: Model, setting: Setting) -> list[Model]:
    """Return *model* with more parameters of each of its effects, each fitted until it converges.

    If another effect is still missing, these fits converge slowly, and a choice after a few
    iterations would be wrong.
    """
    known = model.solution
    row = known.problem.row_at(known.u)
    options = [
        (place, option)
        for place in (setting.places[name] for name in model.effects)
        for option in finer_starts(known.problem.unknowns, row, setting.joint, place)
    ]
    return _with_parameters(model, options, setting)


def with_hidden(model: Model, setting: Setting) -> list[Model]:
    """Return *model* with those parameters of each of its effects that long steps hide.

    Each is fitted until it converges. The steps of *model* are the finest of the search.
    """
    known = model.solution
    places = [setting.places[name] for name in model.effects]
    starts = [(place, hidden_start(known.problem.unknowns, place)) for place in places]
    return _with_parameters(model, [option for option in starts if option[1]], setting)


def _with_parameters(
    model: Model, options: Sequence[tuple[Place, dict[str, float]]], setting: Setting
) -> list[Model]:
    """Return *model* with more parameters of an effect, for each place and its starting values."""

    def fit(option: tuple[Place, dict[str, float]], pool: Executor | None) -> Model:
        wider = extended(model.solution, *option, setting)
        return setting.model(model.effects, converge(wider, setting.budget.iterations, pool))

    return _in_parallel(fit, options, setting.pool)


def _in_parallel(
    fit: Callable[[Option, Executor | None], Model], options: Sequence[Option], pool: Executor
) -> list[Model]:
    """Return the fit of each option; if there is only one, its simulations run in parallel."""
    if len(options) == 1:
        return [fit(options[0], pool)]
    return list(pool.map(lambda option: fit(option, None), options))


def without_idle_parameters(model: Model, setting: Setting) -> Model:
    """Return *model* without those unknown parameters of its effects that have no influence.

    They get their defaults, and can become unknown again from another start. For example, a fit
    can move a breakaway friction below the sliding friction, where it has no influence and no
    gradient leads back.
    """
    for name in model.effects:
        known = with_fresh_jacobian(model.solution, setting.pool)
        names = _with_influence(known, name, setting)
        if not names or names == parameters_of(known.problem.unknowns, name):
            continue
        place = setting.places[name]
        problem, keep = with_parameters(known.problem, setting.joint, place, names)
        less = _restricted(known, problem, keep)
        if less.score <= known.score:
            model = setting.model(model.effects, less)
    return model


def _with_influence(solution: Solution, name: str, setting: Setting) -> set[str]:
    """Return the unknown parameters of an effect that can change the residuals visibly."""
    moves = have_influence(solution, setting.noise)
    return {
        unknown.of.parameter
        for unknown, moves_it in zip(solution.problem.unknowns, moves, strict=True)
        if isinstance(unknown.of, OfEffect) and unknown.of.place == name and moves_it
    }


def with_fewer_parameters(model: Model, setting: Setting) -> list[Model]:
    """Return *model* with fewer parameters of each of its effects, fitted from its present values.

    The remaining ones suffice for a fit of this effect alone, or of a simpler one that it
    contains; the others have their defaults. A fit that is far from the present score after a few
    iterations is not continued.
    """
    unknowns = model.solution.problem.unknowns
    options = [
        (place, names)
        for place in (setting.places[name] for name in model.effects)
        for names in plainer_sets(unknowns, place)
    ]
    far = model.score + HOPELESS_MARGIN * setting.criteria.margin
    less = _narrowed(model, options, setting, far)
    return [
        *less,
        *(one for name in model.effects for one in with_simpler_effect(model, name, setting)),
    ]


def with_one_parameter_less(model: Model, setting: Setting) -> list[Model]:
    """Return *model* without one of the parameters of its effects, fitted from its values.

    The parameter has its default. Parameters that are clearly needed, as far as the residuals are
    linear in them, are left out, and so are the sets of :func:`with_fewer_parameters`. One
    strength of each effect remains.
    """
    known, far = model.solution, HOPELESS_MARGIN * setting.criteria.margin
    expected = score_rises(known, setting)
    options = []
    for place in (setting.places[name] for name in model.effects):
        others = plainer_sets(known.problem.unknowns, place)
        there = [p for p in place.parameters if (place.name, p.name) in expected]
        strengths = {p.name for p in there if p.strength}
        for p in there:
            rest = {one.name for one in there} - {p.name}
            is_tried = expected[place.name, p.name] < far and rest not in others
            if is_tried and rest & strengths:
                options.append((place, rest))
    return _narrowed(model, options, setting, model.score + far)


def score_rises(solution: Solution, setting: Setting) -> dict[tuple[str, str], float]:
    """Return by how much the score rises without each parameter, by its place and its name.

    This is exact if the residuals are linear in the unknowns. With the standard deviations s of
    its posterior and P of its prior around 0, an unknown u that is fixed at d raises misfit and
    prior by (u - d)^2/s^2 (Wald 1943). It saves its own prior d^2/P^2 and the cost ln(P^2/s^2). Of
    a parameter with several unknowns, the one that is needed most counts.
    """
    variances = np.diag(covariance(solution, solution.discrepancy))
    found: dict[tuple[str, str], float] = {}
    for unknown, u, variance in zip(solution.problem.unknowns, solution.u, variances, strict=True):
        if isinstance(unknown.of, OfEffect):
            place = setting.places[unknown.of.place]
            default = next(p.default for p in place.parameters if p.name == unknown.of.parameter)
            at, square = np.clip(unknown.coordinate(default), *unknown.bounds), unknown.prior**2
            rise = (u - at) ** 2 / variance - at**2 / square - log(square / variance)
            key = place.name, unknown.of.parameter
            found[key] = max(found.get(key, -inf), float(rise))
    return found


def with_fewer_strengths(model: Model, name: str, setting: Setting) -> list[Model]:
    """Return *model* with fewer strengths of the effect called *name*, fitted from its values.

    For each set of strengths with which a fit may also begin, it has the fewest parameters.
    """
    unknowns, place = model.solution.problem.unknowns, setting.places[name]
    strengths = {p.name for p in place.parameters if p.strength}
    there = strengths & parameters_of(unknowns, name)
    fewest: dict[frozenset[str], set[str]] = {}
    for names in sorted(plainer_sets(unknowns, place), key=len):
        left = frozenset(strengths & names)
        if left < there:
            fewest.setdefault(left, names)
    return _narrowed(model, [(place, names) for names in fewest.values()], setting)


def _narrowed(
    model: Model,
    options: Sequence[tuple[Place, set[str]]],
    setting: Setting,
    far: float = inf,
) -> list[Model]:
    """Return *model* with only some parameters of an effect, for each place and set of names.

    The fits begin from the present values. One whose score is above *far* after a few iterations
    ends there.
    """
    known = model.solution

    def fit(option: tuple[Place, set[str]], pool: Executor | None) -> Model:
        place, names = option
        less = _restricted(known, *with_parameters(known.problem, setting.joint, place, names))
        near = levenberg_marquardt(less, setting.budget.screening, pool)
        if near.score > far:
            return setting.model(model.effects, near, is_screened=True)
        return setting.model(model.effects, converge(near, setting.budget.iterations, pool))

    return _in_parallel(fit, options, setting.pool)


def with_simpler_effect(model: Model, name: str, setting: Setting) -> list[Model]:
    """Return *model* with each simpler effect that the effect called *name* contains, instead.

    The fits begin from the present values, also from those of the parameters that both have in
    common. The other effects were fitted together with this one: without it they would move far.
    """
    known, place = model.solution, setting.places[name]
    starts = {
        simple: in_common(known.problem, known.u, setting.joint, place, effect_of(simple))
        for simple in simpler_effects(model, name, setting)
    }
    if not any(starts.values()):
        return []
    less = _restricted(known, *without_effect(known.problem, setting.joint, place))
    effects = tuple(one for one in model.effects if one != name)

    def fit(simple: str, start: dict[str, float]) -> Model:
        wider = extended(less, setting.places[simple], start, setting)
        end = converge(wider, setting.budget.iterations, setting.pool)
        return setting.model((*effects, simple), end)

    return [fit(simple, start) for simple, start in starts.items() if start]


def simpler_effects(model: Model, name: str, setting: Setting) -> list[str]:
    """Return the places of those simpler effects that *name* contains and *model* could have."""
    named = setting.related(name, setting.places[name].effect.contains)
    able = absent_effects(model, setting)
    return [one for one in named if one in able]


def absent_effects(model: Model, setting: Setting) -> list[str]:
    """Return the places of the effects that *model* lacks and its rig could have."""
    joint, places = setting.joint, setting.places
    there = [places[name] for name in model.effects]
    nominal = {effect.name for effect in joint.all_present}
    return [
        name
        for name, place in places.items()
        if place.effect.name not in nominal
        and not any(place.overlaps(other) for other in there)
        and not (place.effect.needs_muscle and joint.is_driven)
    ]


def remove_effect(model: Model, name: str, setting: Setting) -> Model:
    """Return *model* without an effect, fitted from the present values of the other unknowns.

    So an effect is not accepted only because its start led the others to better values.
    """
    if name not in model.without:
        model.without[name] = _removed(model, name, setting)
    return model.without[name]


def _removed(model: Model, name: str, setting: Setting) -> Model:
    problem, keep = without_effect(model.solution.problem, setting.joint, setting.places[name])
    effects = tuple(e for e in model.effects if e != name)
    less = _restricted(model.solution, problem, keep)
    return setting.model(effects, converge(less, setting.budget.iterations, setting.pool))


def _restricted(solution: Solution, problem: Problem, keep: list[int]) -> Solution:
    """Return the solution of a *problem* at the unknowns *keep* of *solution*, without a fit."""
    u = solution.u[keep]
    slopes = solution.jacobian[:, keep]
    return Solution(problem, u, problem.residuals(u), slopes, solution.discrepancy)
