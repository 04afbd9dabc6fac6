# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Every model that a search evaluated: its parent, its errors, and why it was not chosen."""

from collections.abc import Sequence
from dataclasses import replace
from math import nan

from scipy.stats import chi2

from pam_ros.identification.fit.places import spelled
from pam_ros.identification.result import Candidate
from pam_ros.identification.search.compare import is_no_worse, is_significant, with_errors
from pam_ros.identification.search.power import hidden
from pam_ros.identification.search.search import Search, alternatives
from pam_ros.identification.search.setting import Model
from pam_ros.identification.search.stages import at_place, estimates

Set = frozenset[str]


def candidates(search: Search) -> tuple[Candidate, ...]:
    """Return the candidates of a search, first those whose parents have fewer effects.

    Of several models with the same effects from fits with long steps, the one of the best score is
    used.
    """
    parents: dict[Set, Model] = {}
    children: dict[tuple[Set, str], Model] = {}
    for model in sorted(search.evaluated, key=lambda m: m.score):
        if model.solution.problem.step == search.setting.step:
            parents.setdefault(frozenset(model.effects), model)
            if model.effects:
                *before, name = model.effects
                children.setdefault((frozenset(before), name), model)
    with_errors({*parents.values(), *children.values()}, search.setting)
    made = []
    for effects in sorted(parents, key=len):
        tried = [child for (before, _), child in children.items() if before == effects]
        made += [_candidate(child, parents[effects], tried, search) for child in tried]
    return _without_power(made, search)


def _without_power(made: Sequence[Candidate], search: Search) -> tuple[Candidate, ...]:
    """Return the candidates, those that the recordings could not show marked as untestable.

    A row that lowers the score by the margin keeps its reason in any case.
    """
    margin = search.setting.criteria.margin
    able = [c for c in made if c.decision == 'rejected' and c.score_fall < margin]
    names = dict.fromkeys(c.effect for c in able if c.effect not in search.best.effects)
    reasons = hidden(search.best, names, search.setting)
    return tuple(
        replace(c, p=nan, decision='untestable', reason=reasons[c.effect])
        if c in able and c.effect in reasons
        else c
        for c in made
    )


def _candidate(model: Model, parent: Model, tried: list[Model], search: Search) -> Candidate:
    fall, more = parent.solution.cost - model.solution.cost, _more(model, parent)
    decision, reason = _decision(model, parent, tried, search)
    name = model.effects[-1]
    known = estimates(model.solution, model.solution.discrepancy, search.setting.joint)
    own = at_place(known, search.setting.places[name])
    strengths = [p.name for p in search.setting.places[name].parameters if p.strength]
    intervals = [own[strength] for strength in strengths if strength in own]
    return Candidate(
        name,
        parent.effects,
        model.errors.fit,
        model.errors.choose,
        parent.score - model.score,
        _gain(model, parent),
        min(1.0, len(tried) * float(chi2.sf(max(fall, 0.0), more))),
        all(one.low > 0.0 or one.high < 0.0 for one in intervals),
        own,
        decision,
        reason,
    )


def _more(model: Model, parent: Model) -> int:
    """Return how many unknowns a model has beyond its parent."""
    return max(1, model.solution.u.size - parent.solution.u.size)


def _gain(model: Model, parent: Model) -> float:
    return 1.0 - model.errors.choose / parent.errors.choose


def _decision(model: Model, parent: Model, tried: list[Model], search: Search) -> tuple[str, str]:
    """Return the decision on a model, and its reason."""
    best = search.best
    if model.effects == best.effects[: len(model.effects)]:
        return 'chosen', _why(model, parent, search)
    for name in best.effects:
        rest = {*best.effects} - {name}
        if any({*model.effects} == rest | {other} for other in alternatives(search, name)):
            return 'ambiguous', f'explains the data as well as {spelled(name)}'
    return 'rejected', _why_not(model, parent, tried, search)


def _why_not(model: Model, parent: Model, tried: list[Model], search: Search) -> str:
    """Return the first reason why a model was not chosen."""
    fall, margin = parent.score - model.score, search.setting.criteria.margin
    if fall < margin:
        verb = 'lowers' if fall >= 0.0 else 'raises'
        return f'{verb} the score by {abs(fall):.1f}; a decrease of {margin:g} is required'
    if not is_no_worse(model, parent, search.setting):
        a, b = parent.errors, model.errors
        return (
            f'the error of the free run is {_changed(b.free_run / a.free_run)} over samples that '
            f'were not fitted, and {_changed(b.fit / a.fit)} over those that were'
        )
    if not is_significant(model, parent, search.retuned, search.setting):
        return 'explains too little of the error that remains after re-tuning'
    winner = min(tried, key=lambda one: one.score)
    if winner is not model:
        more = model.score - winner.score
        return f'{spelled(winner.effects[-1])} lowers the score by {more:.0f} more'
    return 'not needed in addition to the effects that were found later'


def _changed(ratio: float) -> str:
    """Return in words how an error has changed."""
    percent = f'{100.0 * abs(ratio - 1.0):.0f} %'
    return f'{percent} larger' if ratio > 1.0 else f'{percent} smaller'


def reason_for(search: Search, name: str) -> str:
    """Return why an effect is in the best model, compared with the best model without it."""
    return _why(search.best, _without(name, search), search)


def is_instead_of_constants(search: Search, name: str) -> bool:
    """Return whether the best model without this effect explains as much, by far constants."""
    best = search.best
    return _avoids_strain(best, _without(name, search), search)


def _without(name: str, search: Search) -> Model:
    step = search.best.solution.problem.step
    return search.best_evaluated({*search.best.effects} - {name}, step)


def _avoids_strain(model: Model, parent: Model, search: Search) -> bool:
    criteria = search.setting.criteria
    lowers = parent.strain - model.strain >= criteria.strain
    return _gain(model, parent) < criteria.gain and lowers


def _why(model: Model, parent: Model, search: Search) -> str:
    """Return why the effect of a chosen model was chosen."""
    fall = f'lowers the score by {parent.score - model.score:.0f}'
    gain = _gain(model, parent)
    if _avoids_strain(model, parent, search):
        return (
            f'{fall}: explains by its own parameters what re-tuning explains only by constants '
            'far from the nominal ones'
        )
    return f'{fall}, and the error of samples that were not fitted by {100.0 * gain:.0f} %'
