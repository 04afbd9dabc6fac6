# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A loop over moves from model to model, until no move is accepted."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit.onset import keeping_onset
from pam_ros.identification.fit.places import effect_of, muscle_of
from pam_ros.identification.fit.solve import Solution, converge, initial_solution
from pam_ros.identification.search.compare import (
    is_accepted,
    is_complete,
    is_no_worse,
    is_significant,
    is_sufficient,
    is_within_margin,
    with_errors,
    within_tolerance,
)
from pam_ros.identification.search.forecast import (
    begin_search,
    of_confirming,
    of_rounds,
    of_search,
)
from pam_ros.identification.search.moves import (
    absent_effects,
    remove_effect,
    simpler_effects,
    with_each,
    with_fewer_parameters,
    with_fewer_strengths,
    with_hidden,
    with_more_parameters,
    with_one_parameter_less,
    with_simpler_effect,
    without_idle_parameters,
)
from pam_ros.identification.search.setting import Model, Setting

Array = NDArray[np.float64]
AT_ONCE = 2  # models whose errors are computed at once


@dataclass(eq=False)
class Search:
    """A search: the re-tuned model, the best one, and every model that it evaluated.

    ``kept`` are the effects that another signal shows: they are in the best model also if this
    search does not need them. ``rounds`` are the numbers of time steps that the rounds of moves
    have simulated.
    """

    setting: Setting
    retuned: Model
    best: Model
    evaluated: list[Model] = field(default_factory=list)
    kept: tuple[str, ...] = ()
    rounds: list[float] = field(default_factory=list)

    def evaluate(self, models: Iterable[Model]) -> list[Model]:
        """Add fitted *models* to those that were evaluated, and return them."""
        added = list(models)
        self.evaluated += added
        return added

    def best_evaluated(self, effects: set[str], step: float) -> Model:
        """Return the best evaluated model with exactly these *effects*, fitted with *step* s."""
        same = [m for m in self.evaluated if {*m.effects} == effects]
        return min((m for m in same if m.solution.problem.step == step), key=lambda m: m.score)


def without_effects(setting: Setting) -> Search:
    """Return a search that has only re-tuned the nominal model."""
    setting.work.step('re-tuning the parameters', of_search(setting))
    problem = setting.problem
    u = np.zeros(len(problem.unknowns))
    start = initial_solution(problem, u, pool=setting.pool)
    end = keeping_onset(start, lambda known: converge(known, pool=setting.pool))
    retuned = setting.model((), end)
    return Search(setting, retuned, retuned, [retuned])


def find_effects(setting: Setting) -> Search:
    """Find the effects that the nominal model lacks."""
    return confirmed(improved(without_effects(setting)))


def find_effects_from(search: Search, model: Model) -> Search:
    """Find the effects that the nominal model lacks, from a *model* with some of them on.

    *search* has only re-tuned the nominal model. Effects that *model* does not need are removed,
    except those that are kept.
    """
    search.evaluate([model])
    less = _without_needless_effects(model, search)
    is_better = is_no_worse if search.kept else is_accepted
    if is_better(less, search.retuned, search.setting):
        freed = _attempted(search, lambda search: free_parameters(less, search))
        search.best = freed or less
    else:
        search.kept = ()
    return confirmed(improved(search))


def improved(found: Search) -> Search:
    """Return the search after moves from its best model, until none is accepted."""
    setting, budget = found.setting, found.setting.budget
    if setting.work.is_stopped:
        return found
    begin_search(found.retuned, setting)
    for n in range(budget.rounds):
        if len(found.best.effects) >= budget.effects or is_complete(found.best, setting):
            break
        setting.work.step(f'trying effects, round {n + 1}', of_rounds(setting, found.rounds))
        before = setting.work.done
        better = _attempted(found, lambda search: _add_effect(search) or exchange_effect(search))
        found.rounds.append(setting.work.done - before)
        if better is None:
            break
        found.best = better
    return found


def confirmed(found: Search) -> Search:
    """Return the search with its best model confirmed, see :func:`confirm`."""
    if found.best.effects and not found.setting.work.is_stopped:
        rest = of_confirming(found.rounds)
        found.setting.work.step('confirming the effects with finer steps', rest)
        found.best = _attempted(found, confirm) or found.best
    return found


def _attempted(search: Search, move: Callable[[Search], Model | None]) -> Model | None:
    """Return move(search), None if the user stops it, which is possible at any time.

    The models of a move that did not end are forgotten: they were compared with no other.
    """
    work, count = search.setting.work, len(search.evaluated)
    model = work.attempt(lambda: move(search))
    if work.is_stopped:
        del search.evaluated[count:]
    return model


def _add_effect(search: Search) -> Model | None:
    """Return the model after the best round of moves, if it is accepted."""
    setting, best = search.setting, search.best
    tried = search.evaluate(with_each(best, absent_effects(best, setting), setting))
    # An effect that lowers only the score may describe a slow error that is small in the free run.
    for able in accepted(order_candidates(tried, search), best, search):
        if is_significant(able, best, search.retuned, setting):
            more = free_parameters(share_between_muscles(able, search), search)
            now = _without_needless_effects(simplify(more, more.effects, search), search)
            if is_accepted(now, best, setting):
                return now
    return None


def order_candidates(tried: list[Model], search: Search) -> list[Model]:
    """Return *tried* models in the order in which they may become the best one: by their scores.

    If choices use only recordings that are not fitted, the models that were fitted closely and are
    accepted come first, in the order of the errors of their free runs. At other operating points
    free runs contain more information than any score. In contrast, any broader effect can explain
    the continuation of the same recording as well.
    """
    if not search.setting.is_crossed:
        return tried
    close = [*accepted([model for model in tried if not model.is_screened], search.best, search)]
    close.sort(key=lambda model: model.errors.free_run * model.errors.fit)
    return [*close, *(model for model in tried if model not in close)]


def exchange_effect(search: Search) -> Model | None:
    """Return the model with a rival instead of an effect, or of a part of it, if it is accepted.

    The first effect was chosen without those that were added later, and a strength of an effect
    without those that explain the same. The new model must lower the score by the margin, as if an
    effect were added.
    """
    setting, best = search.setting, search.best
    tried: list[Model] = []
    for name in best.effects:
        if name in search.kept:
            continue
        named = setting.related(name, setting.places[name].effect.rivals)
        rivals = [one for one in named if one in absent_effects(best, setting)]
        if not rivals:
            continue
        bases = with_fewer_strengths(best, name, setting)
        if len(best.effects) > 1:
            bases.append(remove_effect(best, name, setting))
        for less in bases:
            others = with_each(less, rivals, setting)
            search.evaluate([less, *others])
            tried += others
    able = [*accepted(tried, best, search)]
    if not able:
        return None
    now = free_parameters(min(able, key=lambda m: m.score), search)
    # The other effects were compared with the simpler ones when they were added.
    now = simplify(now, [name for name in now.effects if name not in best.effects], search)
    return now if is_accepted(now, best, setting) else None


def confirm(search: Search) -> Model:
    """Return the best model, fitted with finer steps, without effects that only coarse steps need.

    A coarse step is a model error, too: if a load hits a stop, a dead time can compensate for it.
    It can also hide a parameter, which is tried once more. If finer steps hardly change the
    residuals, the fit with coarse steps remains.
    """
    setting, best = search.setting, search.best
    if not best.effects:
        return best
    known = best.solution
    problem = replace(known.problem, step=known.problem.step / setting.budget.finer)
    r = problem.residuals(known.u)
    if _can_matter(known, r, setting):
        fine = replace(known, problem=problem, r=r, is_fresh=False)
        best = setting.model(best.effects, converge(fine, setting.budget.iterations, setting.pool))
    if not is_complete(best, setting):
        wider = search.evaluate(with_hidden(best, setting))
        best = min([best, *accepted(wider, best, search)], key=lambda m: m.score)
    return _without_needless_parameters(_without_needless_effects(best, search), search)


def _can_matter(solution: Solution, r: Array, setting: Setting) -> bool:
    """Return whether a model that explains the change of the residuals to r (n,) could be chosen.

    It could if the squared change, in units of the noise, is larger than the margin: the score
    falls by at most this amount. With a discrepancy, which the free run does not have, it falls
    less.
    """
    change = r - solution.r
    return float(change @ change) > setting.criteria.margin * setting.noise**2


def accepted(models: Iterable[Model], other: Model, search: Search) -> Iterator[Model]:
    """Return those of *models*, in their order, that are accepted instead of a smaller one.

    Each is fitted again if that makes it better. The errors of a few are computed in parallel, so
    that a caller who needs only the first one does not wait for all.
    """
    setting = search.setting
    lower = (m for m in models if m.score < other.score - setting.criteria.margin)
    while some := [*islice(lower, AT_ONCE)]:
        again = [*setting.pool.map(lambda model: refit(model, setting), some)]
        with_errors(again, setting)
        search.evaluate(model for model in again if model not in some)
        yield from (m for m in again if is_accepted(m, other, setting))


def refit(model: Model, setting: Setting) -> Model:
    """Return *model*, fitted again from its nearest free run if its score is lower there.

    A fit may end in a minimum in which a slow discrepancy describes what the effects could. Least
    squares have no discrepancy, and reach another minimum from there.
    """
    near = model.nearest
    there = replace(near, discrepancy=near.most_likely())
    if there.score >= model.score:
        return model
    return setting.model(model.effects, converge(there, setting.budget.iterations))


def share_between_muscles(model: Model, search: Search) -> Model:
    """Return *model* with one effect for all muscles instead of one each, if it is nearly as good.

    This has fewer parameters, and muscles of one type have the same effects.
    """
    setting = search.setting
    for effect in dict.fromkeys(effect_of(name) for name in model.effects if muscle_of(name)):
        each = [name for name in model.effects if muscle_of(name) and effect_of(name) == effect]
        if len(each) < len(setting.joint.muscles):
            continue
        less = model
        for name in each:
            less = remove_effect(less, name, setting)
            search.evaluate([less])
        others = search.evaluate(with_each(less, [effect], setting))
        for other in others:
            if within_tolerance(other, model, setting) or is_sufficient(other, model, setting):
                model = other
    return model


def simplify(model: Model, names: Iterable[str], search: Search) -> Model:
    """Return *model* with simpler effects instead of those of *names* that contain them.

    For example, a leak of which only the refill is visible is a lag. A simpler effect that starts
    from the common parameters has fewer unknowns, and replaces the broader one if it suffices.
    Otherwise it is also fitted from its own starts and with all of its parameters, and replaces
    the broader one if it is then nearly as good. With only some of them it would seem worse for
    this reason alone.
    """
    setting = search.setting
    for name in names:
        direct = search.evaluate(with_simpler_effect(model, name, setting))
        able = [m for m in direct if is_sufficient(m, model, setting)]
        # The simpler effect can have parameters that the broader one lacks.
        best = min(able, key=lambda m: m.score, default=None)
        model = free_parameters(best, search) if best else _simplify(model, name, search)
    return model


def _simplify(model: Model, name: str, search: Search) -> Model:
    """Return *model* with a simpler effect instead of *name* that has all parameters, if good."""
    setting = search.setting
    simpler = simpler_effects(model, name, setting)
    if not simpler:
        return model
    less = remove_effect(model, name, setting)
    others = with_each(less, simpler, setting)
    search.evaluate([less, *others])
    for simple in others:
        more = free_parameters(simple, search)
        # An earlier fit of these effects may have come further.
        best = search.best_evaluated({*more.effects}, more.solution.problem.step)
        fits = [more, best, simple]
        with_errors(fits, setting)
        able = [
            m
            for m in fits
            if is_sufficient(m, model, setting) or within_tolerance(m, model, setting)
        ]
        if able:
            return min(able, key=lambda m: m.score)
    return model


def free_parameters(model: Model, search: Search) -> Model:
    """Return *model* with those additional parameters of its effects that are accepted."""
    setting = search.setting
    model = without_idle_parameters(model, setting)
    while not is_complete(model, setting):
        wider = search.evaluate(with_more_parameters(model, setting))
        able = [*accepted(wider, model, search)]
        if not able:
            break
        model = min(able, key=lambda m: m.score)
    return model


def _without_needless_effects(model: Model, search: Search) -> Model:
    """Return *model* without effects that it does not need, or that matter too little.

    Each is removed while the other unknowns begin at their present values. If a load sticks or
    hits a stop, fits end early, and any additional effect can move them to their optimum. This
    improvement must not count for the effect.
    """
    setting = search.setting
    while names := [name for name in model.effects if name not in search.kept]:
        search.evaluate(remove_effect(model, name, setting) for name in names)
        step = model.solution.problem.step
        less = [search.best_evaluated({*model.effects} - {name}, step) for name in names]
        with_errors([model, *less], setting)
        able = [
            m
            for m in less
            if not is_significant(model, m, search.retuned, setting)
            or is_sufficient(m, model, setting)
        ]
        if not able:
            break
        model = min(able, key=lambda m: m.score)
    return model


def _without_needless_parameters(model: Model, search: Search) -> Model:
    """Return *model* without those parameters of its effects that it does not need.

    They became unknown before later effects were added, or together with others. A single one
    remains if it lowers the score at all.
    """
    setting = search.setting
    while True:
        less = with_fewer_parameters(model, setting)
        narrower = with_one_parameter_less(model, setting)
        search.evaluate([*less, *narrower])
        near = [m for m in less if is_within_margin(m, model, setting)]
        near += [m for m in narrower if m.score <= model.score]
        with_errors(near, setting)
        able = [m for m in near if is_no_worse(m, model, setting)]
        if not able:
            return without_idle_parameters(model, setting)
        model = min(able, key=lambda m: m.score)


def alternatives(search: Search, name: str) -> tuple[str, ...]:
    """Return the effects that could replace *name*, with scores not worse by the margin."""
    best = search.best
    rest = set(best.effects) - {name}
    most = best.score + search.setting.criteria.margin
    near = [m for m in search.evaluated if m.score < most and rest < {*m.effects}]
    with_errors(near, search.setting)
    found_instead = [{*m.effects} - rest for m in near if is_no_worse(m, best, search.setting)]
    names = dict.fromkeys(one for some in found_instead if len(some) == 1 for one in some)
    return tuple(one for one in names if one != name)
