# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The effects that the recordings could have shown: the power of a test for each."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.identification.fit.extend import with_effect
from pam_ros.identification.fit.places import Place
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.search.setting import Model, Setting
from pam_ros.identification.search.starts import guessed

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Comparison:
    """What a run with one more effect is compared with, to find how much the effect changes it.

    The runs of *problem* have the steps of a search: a change of the run needs no shorter ones.
    The noise is that of *model*, which may have been fitted with shorter steps.
    """

    model: Model
    problem: Problem
    r: Array  # (n,) residuals of *problem* at the solution
    basis: Array  # (n + k, l) orthonormal: the changes that the unknowns of *model* can make


def hidden(model: Model, names: Iterable[str], setting: Setting) -> dict[str, str]:
    """Return those of the effects *names* that the recordings could not show, each with a reason.

    If they were clearly present in addition to *model*, the best one, they would lower the score
    by less than the margin.
    """
    places = [setting.places[name] for name in names]
    base = reference(model, setting)
    powers = setting.pool.map(lambda place: power(base, place), places)
    is_held = setting.parts[0].segment.kind == 'held'
    return {
        place.name: _reason(place.effect, size, is_held)
        for place, size in zip(places, powers, strict=True)
        if size < setting.criteria.margin
    }


def reference(model: Model, setting: Setting) -> Comparison:
    """Return what runs with one effect in addition to *model* are compared with."""
    known = model.solution
    problem = replace(known.problem, step=setting.step)
    is_same = problem.step == known.problem.step
    r = known.r if is_same else problem.residuals(known.u)
    return Comparison(model, problem, r, _compensable(model))


def _compensable(model: Model) -> Array:
    """Return an orthonormal basis (n + k, l) of the changes that unknowns of *model* can make.

    The first n rows are the whitened run, in standard deviations of the noise, and the others the
    k unknowns in standard deviations of their priors.
    """
    known = model.solution
    slopes = np.vstack(
        [
            known.problem.whitened(known.jacobian, known.whitenings) / known.noise,
            np.diag(1.0 / known.problem.prior),
        ]
    )
    return np.asarray(np.linalg.qr(slopes)[0])


def power(base: Comparison, place: Place) -> float:
    """Return the most by which the effect at *place*, clearly present, would lower the score.

    This is the squared change of the whitened run by the effect, over the variance of the noise:
    the noncentrality of the likelihood-ratio test (Wald 1943). The part of the change that the
    unknowns of the model can compensate is removed. The effect is as in its example, and as at
    each start of a fit.
    """
    starts = (place.example, *place.fit_starts, *guessed(base.model, place))
    return max(_fall(base, place, start) for start in starts)


def _fall(base: Comparison, place: Place, start: Mapping[str, float]) -> float:
    """Return how much an effect from *start* on changes what the unknowns cannot compensate."""
    known = base.model.solution
    problem, added = with_effect(base.problem, base.model.setting.joint, place, start)
    u = np.clip(np.concatenate([known.u, added]), *problem.bounds)
    change = problem.residuals(u) - base.r
    change = known.problem.whitened(change, known.whitenings) / known.noise
    whole = np.concatenate([change, np.zeros(known.u.size)])
    return float(np.sum((whole - base.basis @ (base.basis.T @ whole)) ** 2))


def _reason(effect: type[Effect], size: float, is_held: bool) -> str:
    if is_held and effect.equations.reservoir is not None:
        return (
            'these data cannot show it: the pressures are measured behind the reservoir; record '
            f'commands to a free load: {effect.experiment}'
        )
    if is_held and effect.acts_on_joint() and effect.equations.drag is None:
        return (
            'these data cannot show it: it acts on a load that moves freely, but here a machine '
            f'prescribes the position; with a free load, record: {effect.experiment}'
        )
    return (
        'these data cannot show it: if it were clearly present, it would lower the score by only '
        f'{size:.1f}; record: {effect.experiment}'
    )
