# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The models of a search, fitted to every sample by short steps, and what then is not needed."""

from collections.abc import Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.names import EffectName
from pam_ros.identification.candidate import Fit, fitted
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import Segment
from pam_ros.identification.data.thinning import coarse_step
from pam_ros.identification.drift import Drift, shares
from pam_ros.identification.elimination import plain, promises_little, without_needless
from pam_ros.identification.fit.unknowns import Unknown
from pam_ros.identification.problem import Problem
from pam_ros.identification.retuning import only_starts, problem_of
from pam_ros.identification.round import NEAR
from pam_ros.identification.selection import Search
from pam_ros.identification.solve import Solution, solve
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
STEP = 1e-3  # s, longest step of the final fits
HOPE = 100.0  # rise of the cost that a plainer fit of all samples may promise to be tried
FAR_FROM_THIN = 1.5  # errors of the thinned runs at which a final fit has not arrived
SHARES = (0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3)  # of a strength, at which a final fit may begin
SHORTER = (4e-3, 2e-3, STEP)  # s, the steps by which it is led there
POLISH = 10  # iterations of a final fit, which starts where the thinned one ended


def polished(
    found: Search,
    model: Joint,
    segments: Sequence[Segment],
    noise: Noise,
    drifting: Sequence[Drift] = (),
) -> tuple[Fit, Fit, Fit]:
    """Return the declared, re-tuned and augmented models fitted to every sample.

    Effects that are not needed there are dropped, and finer parameters of theirs. Runs that are
    *drifting* count by how late they are.
    """
    whole = replace(problem_of(model, segments, noise, STEP), slope_step=coarse_step(model))
    starts = [k for k in whole.unknowns if not k.is_parameter]
    weights = tuple(np.sqrt(shares(drifting, len(segments))))
    fits = []
    with ThreadPoolExecutor() as pool:
        for fit in (found.declared, found.retuned, found.augmented):
            thin = fit.solution.problem
            kept = [k for k, x in enumerate(thin.unknowns) if x.is_parameter]
            unknowns = (*(thin.unknowns[k] for k in kept), *starts)
            full = replace(
                whole,
                row=thin.row,
                active=thin.active,
                unknowns=unknowns,
                outlier=thin.outlier,
                weights=weights,
            )
            u = np.concatenate([fit.solution.u[kept], _same_starts(fit, starts)])
            if fit is found.declared:
                solution = only_starts(full, u, pool)
            else:
                solution = _settled(full, u, fit.fit_error, noise, pool)
            fits.append(fitted(fit.effects, solution))
        declared, retuned, augmented = fits
        # What finer parameters made up for may be the longer steps of the thinned runs.
        augmented = plain(augmented, model, pool, HOPE)
        augmented = without_needless(
            augmented, _doubted(augmented, model, noise), retuned, model, noise, pool
        )
    if augmented.score > retuned.score:
        # A nested model is never worse: what the thinned runs saw is not in the full ones.
        augmented = retuned
    return declared, retuned, augmented


def _settled(full: Problem, u: Array, thin_error: float, noise: Noise, pool: Executor) -> Solution:
    """Return the fit to every sample that begins at u, where thinned runs leave *thin_error*.

    One that does not come near the noise begins anew from strengths that do better than those of
    the thinned runs. And since a load that sticks slips elsewhere with other steps, so that u says
    little, one that is far from what long steps left goes there by shorter and shorter ones. Of
    such ends the one is taken that also carries over to the samples kept back: where slips are
    fitted one by one, the cost alone says little.
    """
    ends = [solve(full, u, POLISH, pool)]
    exact = replace(full, slope_step=0.0)
    if _rms(ends[0]) > NEAR * noise.sigma:
        weaker = _scanned(exact, u)
        if weaker is not None:
            ends.append(solve(exact, weaker, 2 * POLISH, pool))
    if min(map(_rms, ends)) > FAR_FROM_THIN * thin_error:
        for step in SHORTER:
            end = solve(replace(exact, step=step), u, 2 * POLISH, pool)
            u = end.u
        ends.append(end)
    best = min(ends, key=lambda one: fitted((), one).rank)
    return replace(best, problem=full)


def _rms(solution: Solution) -> float:
    return float(np.sqrt(np.mean(solution.r**2)))


def _scanned(problem: Problem, u: Array) -> Array | None:
    """Return u with strengths of effects at a share of theirs that leaves less; None without any.

    Long steps soften a stiff stop: there no stiffness is too high, and a derivative at one that
    is far too high does not say so.
    """
    every = ((e, p) for e in problem.active for p in e.parameters)
    strengths = {EffectName(e.name, p.name).flat for e, p in every if p.strength}
    found, cost = u, problem.cost(u, problem.residuals(u))
    for k, unknown in enumerate(problem.unknowns):
        for share in SHARES if unknown.name in strengths else ():
            moved = u.copy()
            moved[k] *= share
            other = problem.cost(moved, problem.residuals(moved))
            if other < cost:
                found, cost = moved, other
    return None if found is u else found


def _doubted(fit: Fit, model: Joint, noise: Noise) -> list[str]:
    """Return the effects of *fit* that the fit to every sample may not need.

    All of them where it is far from the noise: thinned runs may have stopped at a place where
    one of them made up for another. None of them where no sample is kept back to say so.
    """
    if np.isnan(fit.held_error):
        return []
    is_near = fit.fit_error < NEAR * noise.sigma
    return [n for n in fit.effects if not is_near or promises_little(fit, n, HOPE, model)]


def _same_starts(fit: Fit, starts: Sequence[Unknown]) -> Array:
    """Return *starts* at the values that *fit* gave them, as far as the measurement allows.

    Runs that were cut into windows have starts of their own: then the measured ones.
    """
    thin = fit.solution.problem
    values = {
        x.name: x.value(u)
        for x, u in zip(thin.unknowns, fit.solution.u, strict=True)
        if not x.is_parameter
    }
    if len(values) != len(starts):
        return np.zeros(len(starts))
    return np.array([np.clip(x.coordinate(values[x.name]), -2.0, 2.0) for x in starts])
