# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that are found two at a time: where neither explains much while the other is missing.

The free run of a model with one of two effects goes astray as long as the other one is missing,
and may then show neither. The weak form does not go astray, and a fit to it is cheap: so pairs
are fitted there, and the best few of them to the free run.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from pam_ros.effects.base import Effect
from pam_ros.identification.admission import Tried, admitted
from pam_ros.identification.candidate import EARNED, Fit, fitted, guessed
from pam_ros.identification.elimination import dropped, plain
from pam_ros.identification.round import Setting, weighed
from pam_ros.identification.solve import Solution, solve
from pam_ros.identification.weak import STEPS, as_free, finer, fitted_to, weak_fits

FAR = 3.0  # noise floors above which a search has not arrived
FIRST = 5  # effects on top of which others are tried
REFINED = 6  # pairs that get a full fit to the weak form
FOLLOWED = 3  # and to the free run
MUCH_LESS = 0.4  # share of the error that a pair may leave of what is left without it


@dataclass(frozen=True, eq=False)
class _Pair:
    effects: tuple[Effect, Effect]
    weak: Solution


def paired(
    fit: Fit, retuned: Fit, effects: Sequence[Effect], setting: Setting
) -> tuple[Fit, tuple[tuple[Tried, ...], ...]]:
    """Return the two of *effects* that leave much less than *fit*, each with its evidence.

    Or *fit* itself, with no evidence: where it is near the noise, or where there are no such two.
    """
    if fit.fit_error < FAR * setting.noise.sigma:
        return fit, ()
    ends: list[Fit] = []
    count = 0
    read = {effect.name: guessed(retuned, effect) for effect in effects}
    for base in weak_fits(retuned, setting.motions, setting.pool):
        pairs = _pairs(base, effects, read, setting)
        count += len(pairs)
        best = list(setting.pool.map(lambda p: _in_full(p, setting), pairs[:REFINED]))
        best.sort(key=lambda pair: pair.weak.cost)
        ends += setting.pool.map(lambda p, b=base: _run(p, b, retuned), best[:FOLLOWED])
    for end in sorted(ends, key=lambda end: end.score):
        if end.score > fit.score - EARNED or end.held_error > MUCH_LESS * fit.held_error:
            continue
        pair = plain(end, setting.model, setting.pool)
        parents = [dropped(pair, name, setting.model, setting.pool) for name in pair.effects]
        tried = [
            weighed(parent, pair, name, setting, count)
            for parent, name in zip(parents, pair.effects, strict=True)
        ]
        if all(
            admitted(one, parent, retuned, setting.noise)
            for one, parent in zip(tried, parents, strict=True)
        ):
            return pair, tuple((one,) for one in tried)
    return fit, ()


def _pairs(
    base: Solution,
    effects: Sequence[Effect],
    read: dict[str, tuple[dict[str, float], ...]],
    setting: Setting,
) -> list[_Pair]:
    """Return weak fits of two effects on top of *base*, the best first."""
    model, pool = setting.model, setting.pool
    single = list(pool.map(lambda e: fitted_to(base, model, e, read[e.name]), effects))
    order = sorted(range(len(effects)), key=lambda k: single[k].cost)[:FIRST]
    single = list(pool.map(lambda k: finer(single[k], model, effects[k]), order))
    jobs = [
        (fit, effects[k], other)
        for fit, k in zip(single, order, strict=True)
        for other in effects
        if other is not effects[k]
    ]
    found = pool.map(
        lambda j: _Pair((j[1], j[2]), fitted_to(j[0], model, j[2], read[j[2].name])), jobs
    )
    return sorted(found, key=lambda pair: pair.weak.cost)


def _in_full(pair: _Pair, setting: Setting) -> _Pair:
    """Return a pair with all of its parameters fitted together, and the finer ones it earns."""
    weak = solve(pair.weak.problem, pair.weak.u, STEPS)
    for effect in pair.effects:
        weak = finer(weak, setting.model, effect)
    return replace(pair, weak=weak)


def _run(pair: _Pair, base: Solution, retuned: Fit) -> Fit:
    """Return the fit of the free run that begins where a weak one has ended."""
    names = tuple(effect.name for effect in pair.effects)
    return fitted((*retuned.effects, *names), solve(*as_free(retuned.solution, base, pair.weak)))
