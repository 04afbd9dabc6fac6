# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time by which the outputs of each recording precede the input that causes them.

A model whose input acts d earlier than it was stamped has the output s(t + d). The profile of the
cost over d uses one simulation: for each d, the other unknowns are those of linear least squares.
From the least cost on, Gauss and Newton's method improves d and the other unknowns together.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit import score as evidence
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.slopes import Slopes
from pam_ros.identification.fit.solve import Solution, converge, initial_solution

Array = NDArray[np.float64]
MOST = 0.5  # s, largest offset that is searched
SHARE = 0.2  # of the longest run, up to which an offset is searched
LAG = 0.01  # s between the offsets of a profile
PRIOR = 0.1  # s, standard deviation of the prior of an offset
STEPS = 8  # of Gauss and Newton's method
LONGEST = 0.05  # s, longest of these steps
REACHED = 0.3  # a step of fewer standard deviations is the last one


@dataclass(frozen=True, eq=False)
class OffsetFit:
    """A fit with an offset in s for each recording (k,), and their standard deviations (k,).

    ``score`` is that of a model in which the offsets are unknown, too. Samples whose input is not
    known with an offset are left out: models are compared by the score of a sample.
    """

    solution: Solution
    offsets: Array
    deviations: Array
    score: float

    def fall_from(self, score: float, samples: int) -> float:
        """Return by how much the score is lower than *score* of a fit to that many *samples*."""
        own = self.solution.r.size
        return min(own, samples) * (score / samples - self.score / own)


def profile_offsets(solution: Solution, owners: Sequence[int], count: int) -> tuple[Array, Array]:
    """Return the offset in s of each recording with the least cost, and by how much it is less.

    *owners* are the numbers of the recordings to which the runs belong, of *count* recordings. The
    offset of a recording without a run is 0.
    """
    problem = solution.problem
    span = max(float(s.t[-1] - s.t[0]) for s in problem.segments)
    most = min(MOST, SHARE * span)
    lags = LAG * np.arange(-int(most / LAG), int(most / LAG) + 1)
    runs = list(
        zip(
            owners,
            problem.segments,
            problem.predict(solution.u),
            problem.by_run(solution.jacobian),
            strict=True,
        )
    )
    offsets, falls = np.zeros(count), np.zeros(count)
    for k in range(offsets.size):
        own = [(s.t[s.fit], run[s.fit], s.target[s.fit], j) for of, s, run, j in runs if of == k]
        if not own:
            continue
        costs = np.array([_cost(own, solution, lag, lags[-1]) for lag in lags])
        if np.isfinite(costs).all():
            offsets[k] = lags[np.argmin(costs)]
            falls[k] = costs[lags.size // 2] - costs.min()
    return offsets, falls


def _cost(
    runs: Sequence[tuple[Array, Array, Array, Array]],
    solution: Solution,
    lag: float,
    most: float,
) -> float:
    """Return the least cost of *runs* with the output s(t + lag), by linear least squares.

    Each run has stamps (n,), simulated and measured values (n,), and derivatives (n, k). All lags
    up to *most* are compared on the same samples.
    """
    slopes, left = [], []
    for t, run, target, jacobian in runs:
        kept = (t - t[0] >= most) & (t[-1] - t >= most)
        at = t[kept] + lag
        left.append(np.interp(at, t, run) - target[kept])
        moved = np.empty((at.size, jacobian.shape[1]))
        for k, column in enumerate(jacobian.T):
            moved[:, k] = np.interp(at, t, column)
        slopes.append(moved)
    r, j, prior = np.concatenate(left), np.concatenate(slopes), solution.problem.prior
    if r.size <= prior.size:
        return np.inf
    variance, u = float(np.mean(r**2)), solution.u
    normal, gradient = j.T @ j, j.T @ r
    for _ in range(3):  # the variance of what is left follows from the fit
        precision = np.diag(prior**-2.0)
        step = -np.linalg.solve(normal + variance * precision, gradient + variance * u / prior**2)
        variance = max(float(np.mean((r + j @ step) ** 2)), 1e-300)
    return float(r.size * np.log(variance) + np.sum(((u + step) / prior) ** 2))


def fit_offsets(
    problem_at: Callable[[Array], tuple[Problem, Sequence[int]]],
    u: Array,
    offsets: Array,
    pool: Executor,
) -> OffsetFit:
    """Return the fit with the best score of those that begin at u and at *offsets* in s.

    problem_at(offsets) returns the problem with inputs that are earlier by the offsets, and the
    numbers of the recordings to which its runs belong.
    """
    best: OffsetFit | None = None
    for _ in range(STEPS):
        problem, owners = problem_at(offsets)
        solution = converge(initial_solution(problem, u, pool=pool), pool=pool)
        step, deviations, score = _with_offsets(solution, owners, offsets.size)
        found = OffsetFit(solution, offsets, deviations, score)
        if best is None or found.fall_from(best.score, best.solution.r.size) > 0.0:
            best = found
        if np.all(np.abs(step) < REACHED * deviations):
            break
        u = solution.u
        offsets = np.maximum(offsets + np.clip(step, -LONGEST, LONGEST), 0.0)
    assert best is not None
    return best


def _with_offsets(
    solution: Solution, owners: Sequence[int], count: int
) -> tuple[Array, Array, float]:
    """Return the next step of each offset (count,), its deviation, and the score with offsets."""
    problem = solution.problem
    rates = [
        np.gradient(run, s.t)[s.fit]
        for s, run in zip(problem.segments, problem.predict(solution.u), strict=True)
    ]
    columns = np.zeros((solution.r.size, count))
    ends = np.cumsum([rate.size for rate in rates])
    for owner, rate, end in zip(owners, rates, ends, strict=True):
        columns[end - rate.size : end, owner] = rate
    jacobian = problem.whitened(np.hstack([solution.jacobian, columns]), solution.whitenings)
    prior = np.append(problem.prior, np.full(count, PRIOR))
    u = np.append(solution.u, np.zeros(count))
    variance = max(float(np.mean(solution.whitened**2)), 1e-300)
    normal = jacobian.T @ jacobian / variance + np.diag(prior**-2.0)
    gradient = jacobian.T @ solution.whitened / variance + u / prior**2
    spread = np.linalg.inv(normal)
    log_det = sum(w.log_det for w in solution.whitenings)
    slopes = Slopes.of([jacobian], [np.arange(prior.size)])
    score = evidence.score(solution.whitened, slopes, u / prior, prior, log_det)
    deviations = np.sqrt(np.diag(spread)[-count:])
    return -(spread @ gradient)[-count:], deviations, score
