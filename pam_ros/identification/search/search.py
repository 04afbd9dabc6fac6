# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A loop over moves from model to model, until no move is accepted."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit.moment import keeping_onset
from pam_ros.identification.fit.places import effect_of, muscle_of
from pam_ros.identification.fit.solve import Solution, begun, settled
from pam_ros.identification.search.compare import (
    hardly_more,
    is_complete,
    is_near,
    matters,
    no_worse,
    pays,
    suffices,
    with_errors,
)
from pam_ros.identification.search.moves import (
    absent,
    contained,
    dropped,
    fixed,
    freed,
    simplified,
    weakened,
    with_each,
    with_hidden,
    with_one_less,
    without_idle_parameters,
)
from pam_ros.identification.search.setting import Model, Setting

Array = NDArray[np.float64]
AT_ONCE = 2  # models whose errors are computed at once
Progress = Callable[[float, str], None]  # share of the work that is done, and the next step


@dataclass(eq=False)
class Search:
    """A search: every model that it evaluated, and its final models."""

    setting: Setting
    retuned: Model
    best: Model
    looked_at: list[Model] = field(default_factory=list)


def search(setting: Setting, progress: Progress = lambda share, text: None) -> Search:
    """Find the effects that the nominal model lacks; *progress* is called at each step."""
    progress(0.0, 're-tuning the parameters')
    problem = setting.problem
    u = np.zeros(len(problem.unknowns))
    start = begun(problem, u, pool=setting.pool)
    end = keeping_onset(start, lambda known: settled(known, pool=setting.pool))
    retuned = setting.model((), end)
    found = Search(setting, retuned, retuned, [retuned])
    budget = setting.budget
    for n in range(budget.rounds):
        progress(0.05 + 0.75 * n / budget.rounds, f'trying effects, round {n + 1}')
        if len(found.best.effects) == budget.effects or is_complete(found.best, setting):
            break
        better = _better(found) or exchanged(found)
        if better is None:
            break
        found.best = better
    progress(0.8, 'confirming the effects with finer steps')
    found.best = confirmed(found)
    return found


def _better(found: Search) -> Model | None:
    """Return the model after the best round of moves, if it is accepted."""
    setting, best = found.setting, found.best
    tried = with_each(best, absent(best, setting), setting)
    found.looked_at += tried
    # An effect that lowers only the score may describe a slow error that is small in the free run.
    for able in accepted(leading(tried, found), best, found):
        if matters(able, best, found.retuned, setting):
            more = with_more(joined(able, found), found)
            now = _reduced(plainer(more, more.effects, found), found)
            if pays(now, best, setting):
                return now
    return None


def leading(tried: list[Model], found: Search) -> list[Model]:
    """Return *tried* models in the order in which they may become the best one: by their scores.

    If choices use only recordings that are not fitted, the models that were fitted closely and are
    accepted come first, in the order of the errors of their free runs. At other operating points
    free runs contain more information than any score. In contrast, any broader effect can explain
    the continuation of the same recording as well.
    """
    if not found.setting.is_crossed:
        return tried
    close = [*accepted([model for model in tried if not model.is_look], found.best, found)]
    close.sort(key=lambda model: model.errors.carried * model.errors.fit)
    return [*close, *(model for model in tried if model not in close)]


def exchanged(found: Search) -> Model | None:
    """Return the model with a rival instead of an effect, or of a part of it, if it is accepted.

    The first effect was chosen without those that were added later, and a strength of an effect
    without those that explain the same. The new model must lower the score by the margin, as if an
    effect were added.
    """
    setting, best = found.setting, found.best
    tried: list[Model] = []
    for name in best.effects:
        named = setting.related(name, setting.places[name].effect.rivals)
        rivals = [one for one in named if one in absent(best, setting)]
        if not rivals:
            continue
        bases = weakened(best, name, setting)
        if len(best.effects) > 1:
            bases.append(dropped(best, name, setting))
        for less in bases:
            others = with_each(less, rivals, setting)
            found.looked_at += [less, *others]
            tried += others
    able = [*accepted(tried, best, found)]
    if not able:
        return None
    now = with_more(min(able, key=lambda m: m.score), found)
    # The other effects were compared with the simpler ones when they were added.
    now = plainer(now, [name for name in now.effects if name not in best.effects], found)
    return now if pays(now, best, setting) else None


def confirmed(found: Search) -> Model:
    """Return the best model, fitted with finer steps, without effects that only coarse steps need.

    A coarse step is a model error, too: if a load hits a stop, a dead time can compensate for it.
    It can also hide a parameter, which is tried once more. If finer steps hardly change the
    residuals, the fit with coarse steps remains.
    """
    setting, best = found.setting, found.best
    if not best.effects:
        return best
    known = best.solution
    problem = replace(known.problem, step=known.problem.step / setting.budget.finer)
    r = problem.residuals(known.u)
    if _are_different(known, r, setting):
        fine = replace(known, problem=problem, r=r, is_fresh=False)
        best = setting.model(best.effects, settled(fine, setting.budget.iterations, setting.pool))
    if not is_complete(best, setting):
        wider = with_hidden(best, setting)
        found.looked_at += wider
        best = min([best, *accepted(wider, best, found)], key=lambda m: m.score)
    return _fixed(_reduced(best, found), found)


def _are_different(known: Solution, r: Array, setting: Setting) -> bool:
    """Return whether a model that explains the change of the residuals to r (n,) could be chosen.

    It could if the squared change, in units of the noise, is larger than the margin: the score
    falls by at most this amount. With a discrepancy, which the free run does not have, it falls
    less.
    """
    change = r - known.r
    return float(change @ change) > setting.criteria.margin * setting.noise**2


def accepted(models: Iterable[Model], than: Model, found: Search) -> Iterator[Model]:
    """Return those of *models*, in their order, that are accepted instead of a smaller one.

    Each is fitted again if that makes it better. The errors of a few are computed in parallel, so
    that a caller who needs only the first one does not wait for all.
    """
    setting = found.setting
    lower = (m for m in models if m.score < than.score - setting.criteria.margin)
    while some := [*islice(lower, AT_ONCE)]:
        again = [*setting.pool.map(lambda model: refitted(model, setting), some)]
        with_errors(again, setting)
        found.looked_at += [model for model in again if model not in some]
        yield from (m for m in again if pays(m, than, setting))


def refitted(model: Model, setting: Setting) -> Model:
    """Return *model*, fitted again from its nearest free run if its score is lower there.

    A fit may end in a minimum in which a slow discrepancy describes what the effects could. Least
    squares have no discrepancy, and reach another minimum from there.
    """
    near = model.nearest
    there = replace(near, discrepancy=near.most_likely())
    if there.score >= model.score:
        return model
    return setting.model(model.effects, settled(there, setting.budget.iterations))


def joined(now: Model, found: Search) -> Model:
    """Return *now* with one effect for all muscles instead of one each, if it is nearly as good.

    This has fewer parameters, and muscles of one type have the same effects.
    """
    setting = found.setting
    for effect in dict.fromkeys(effect_of(name) for name in now.effects if muscle_of(name)):
        each = [name for name in now.effects if muscle_of(name) and effect_of(name) == effect]
        if len(each) < len(setting.joint.muscles):
            continue
        less = now
        for name in each:
            less = dropped(less, name, setting)
            found.looked_at.append(less)
        others = with_each(less, [effect], setting)
        found.looked_at += others
        for other in others:
            if hardly_more(other, now, setting) or suffices(other, now, setting):
                now = other
    return now


def plainer(now: Model, names: Iterable[str], found: Search) -> Model:
    """Return *now* with simpler effects instead of those of *names* that contain them.

    For example, a leak of which only the refill is visible is a lag. A simpler effect that starts
    from the common parameters has fewer unknowns, and replaces the broader one if it suffices.
    Otherwise it is also fitted from its own starts and with all of its parameters, and replaces
    the broader one if it is then nearly as good. With only some of them it would seem worse for
    this reason alone.
    """
    setting = found.setting
    for name in names:
        direct = simplified(now, name, setting)
        found.looked_at += direct
        able = [m for m in direct if suffices(m, now, setting)]
        # The simpler effect can have parameters that the broader one lacks.
        best = min(able, key=lambda m: m.score, default=None)
        now = with_more(best, found) if best else _plainer(now, name, found)
    return now


def _plainer(now: Model, name: str, found: Search) -> Model:
    """Return *now* with a simpler effect instead of *name*, if one with all parameters is good."""
    setting = found.setting
    simpler = contained(now, name, setting)
    if not simpler:
        return now
    less = dropped(now, name, setting)
    others = with_each(less, simpler, setting)
    found.looked_at += [less, *others]
    for simple in others:
        more = with_more(simple, found)
        # An earlier fit of these effects may have come further.
        best = best_with({*more.effects}, more.solution.problem.step, found)
        fits = [more, best, simple]
        with_errors(fits, setting)
        able = [m for m in fits if suffices(m, now, setting) or hardly_more(m, now, setting)]
        if able:
            return min(able, key=lambda m: m.score)
    return now


def with_more(now: Model, found: Search) -> Model:
    """Return *now* with those additional parameters of its effects that are accepted."""
    setting = found.setting
    now = without_idle_parameters(now, setting)
    while not is_complete(now, setting):
        wider = freed(now, setting)
        found.looked_at += wider
        able = [*accepted(wider, now, found)]
        if not able:
            break
        now = min(able, key=lambda m: m.score)
    return now


def _reduced(now: Model, found: Search) -> Model:
    """Return *now* without those of its effects that it does not need, or that matter too little.

    Each is removed while the other unknowns begin at their present values. If a load sticks or
    hits a stop, fits end early, and any additional effect can move them to their optimum. This
    improvement must not count for the effect.
    """
    setting = found.setting
    while now.effects:
        found.looked_at += [dropped(now, name, setting) for name in now.effects]
        step = now.solution.problem.step
        less = [best_with({*now.effects} - {name}, step, found) for name in now.effects]
        with_errors([now, *less], setting)
        able = [
            m
            for m in less
            if not matters(now, m, found.retuned, setting) or suffices(m, now, setting)
        ]
        if not able:
            break
        now = min(able, key=lambda m: m.score)
    return now


def _fixed(now: Model, found: Search) -> Model:
    """Return *now* without those parameters of its effects that it does not need.

    They became unknown before later effects were added, or together with others. A single one
    remains if it lowers the score at all.
    """
    setting = found.setting
    while True:
        less = fixed(now, setting)
        narrower = with_one_less(now, setting)
        found.looked_at += [*less, *narrower]
        near = [m for m in less if is_near(m, now, setting)]
        near += [m for m in narrower if m.score <= now.score]
        with_errors(near, setting)
        able = [m for m in near if no_worse(m, now, setting)]
        if not able:
            return without_idle_parameters(now, setting)
        now = min(able, key=lambda m: m.score)


def best_with(effects: set[str], step: float, found: Search) -> Model:
    """Return the best evaluated model with exactly these effects and this step."""
    same = [m for m in found.looked_at if {*m.effects} == effects]
    return min((m for m in same if m.solution.problem.step == step), key=lambda m: m.score)


def alternatives(found: Search, name: str) -> tuple[str, ...]:
    """Return the effects that could replace *name*, with scores not worse by the margin."""
    best = found.best
    rest = set(best.effects) - {name}
    most = best.score + found.setting.criteria.margin
    near = [m for m in found.looked_at if m.score < most and rest < {*m.effects}]
    with_errors(near, found.setting)
    found_instead = [{*m.effects} - rest for m in near if no_worse(m, best, found.setting)]
    names = dict.fromkeys(one for some in found_instead if len(some) == 1 for one in some)
    return tuple(one for one in names if one != name)
