# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The most probable unknowns of a :class:`Problem`: Levenberg and Marquardt's method, bounded.

Minimised is -2 ln(posterior) with the variance of the noise at its most likely value,

    n ln(|W r|^2 / n) + ln det C + |z|^2,

where W whitens the residuals r and z are the unknowns in standard deviations of their priors.
scipy's ``least_squares`` computes the whole Jacobian at every step. Here each of its columns costs
a simulation, and most hardly change. So Broyden's rule updates them, and they are computed only
when steps become worse than predicted (:mod:`.slopes`). An unknown at a bound stays there if the
cost would fall beyond it. The others approach their bounds by a share of the distance in each
step, like the "fraction to the boundary" of interior-point methods (Nocedal and Wright 2006,
Numerical Optimization, eq. 19.9), but each unknown separately.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from math import log

import numpy as np
from numpy.typing import NDArray

from pam_ros.cached_property import cached_property
from pam_ros.identification.fit import score as evidence
from pam_ros.identification.fit.discrepancy import WHITE, Discrepancy, Whitening, deviance
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.slopes import Slopes
from pam_ros.identification.fit.unknowns import OF_RETUNING

Array = NDArray[np.float64]
LEAST_DAMPING = 1e-9
DAMPING = 1e-3  # of a first step that failed undamped, relative to the normal matrix's diagonal
MORE, LESS = 30.0, 0.03  # factors of the damping after a step that failed, and one that did not
LITTLE = 0.1  # fall of the cost, a -2 log likelihood, below which a step has failed
TRIALS = 6  # dampings that are tried with a fresh Jacobian; half as many with an old one
# Residual and discrepancy depend on each other. With a correct model they agree at once; with a
# wrong model the second estimate differs little from the first.
ALTERNATIONS = 3
AGREED = 0.05  # largest change of the logarithms of size and time with which they agree
# A step of an unknown goes at most this share of the distance to its bound. On the bound it would
# stay, since the gradient there may not lead back: an effect without influence at its bound gives
# its other parameters no gradient, and with their present values a stronger effect may be worse.
SHARE_TO_BOUND = 0.9
AT_BOUND = 1e-3  # distance, in units of u, from which a step may end on the bound


class FitStatus(str, Enum):
    """How a fit ended; each is also the text of its value."""

    NOT_FITTED = 'not fitted'
    CONVERGED = 'converged'
    ITERATION_LIMIT = 'iteration limit'

    def __str__(self) -> str:
        """Return the value."""
        return str(self.value)


@dataclass(frozen=True)
class FitLog:
    """How a fit ended, after how many iterations, and how many simulations of all runs.

    A column of the Jacobian counts as one simulation. A fit that continues another one counts its
    iterations and simulations, too.
    """

    status: FitStatus = FitStatus.NOT_FITTED
    iterations: int = 0
    simulations: int = 0

    def more(self, simulations: int) -> 'FitLog':
        """Return this log after more *simulations*."""
        return replace(self, simulations=self.simulations + simulations)


@dataclass(frozen=True, eq=False)
class Solution:
    """The result of a fit: u (k,), residuals r (n,) in m, rad or N, and dr/du (n, k) there.

    ``discrepancy`` is the process that whitens the residuals. ``is_fresh`` is true if the Jacobian
    was computed at u, or so near that steps along it do not lower the cost any more. ``log`` is
    how the fit ended.
    """

    problem: Problem
    u: Array
    r: Array
    jacobian: Array
    discrepancy: Discrepancy = WHITE
    is_fresh: bool = False
    log: FitLog = FitLog()

    @cached_property
    def whitenings(self) -> Sequence[Whitening]:
        """The map that whitens the residuals of each run."""
        return self.problem.whitenings(self.discrepancy)

    @cached_property
    def whitened(self) -> Array:
        """Whitened residuals (n,), which are independent and have the variance of the noise."""
        return self.problem.whitened(self.r, self.whitenings)

    @property
    def slopes(self) -> Slopes:
        """The Jacobian, as one block for each run."""
        return self.problem.slopes(self.jacobian)

    @property
    def z(self) -> Array:
        """The unknowns in standard deviations of their priors (k,)."""
        return self.u / self.problem.prior

    @property
    def noise(self) -> float:
        """Standard deviation of the white noise in m, rad or N."""
        return float(np.sqrt(np.mean(self.whitened**2)))

    @property
    def cost(self) -> float:
        """-2 ln(posterior) without a constant of the data."""
        parts = self.problem.by_run(self.whitened)
        return deviance(parts, self.whitenings) + float(self.z @ self.z)

    @cached_property
    def score(self) -> float:
        """-2 ln(evidence) without a constant of the data: the lower, the better the model."""
        return evidence.score(
            self.whitened,
            self.slopes.whitened(self.whitenings),
            self.z,
            self.problem.prior,
            sum(w.log_det for w in self.whitenings),
        )

    def most_likely(self) -> Discrepancy:
        """Return the discrepancy with the best score for the present residuals."""
        problem = self.problem
        return evidence.most_likely(problem.stamps(), self.r, self.slopes, self.z, problem.prior)

    def value(self, name: str) -> float:
        """Return the physical value of an unknown."""
        for unknown, u in zip(self.problem.unknowns, self.u, strict=True):
            if unknown.name == name:
                return unknown.value(u)
        raise KeyError(name)


def solve(
    problem: Problem,
    u: Array,
    discrepancy: Discrepancy = WHITE,
    iterations: int = 20,
    pool: Executor | None = None,
) -> Solution:
    """Return the most probable unknowns and the discrepancy with the best score, from u on."""
    return converge(initial_solution(problem, u, discrepancy, pool), iterations, pool)


def initial_solution(
    problem: Problem, u: Array, discrepancy: Discrepancy = WHITE, pool: Executor | None = None
) -> Solution:
    """Return the solution at u, clipped to its bounds, with the Jacobian there."""
    u = np.clip(u, *problem.bounds)
    r = problem.residuals(u)
    jacobian = problem.jacobian(u, r, pool)
    return Solution(problem, u, r, jacobian, discrepancy, True, FitLog().more(1 + u.size))


def converge(solution: Solution, iterations: int = 20, pool: Executor | None = None) -> Solution:
    """Improve unknowns and discrepancy alternately until they agree; the Jacobian is fresh."""
    solution = levenberg_marquardt(solution, iterations, pool)
    for _ in range(ALTERNATIONS):
        found = solution.most_likely()
        if _agree(found, solution.discrepancy):
            break
        solution = levenberg_marquardt(replace(solution, discrepancy=found), iterations, pool)
    return with_fresh_jacobian(solution, pool)


def with_nominal_constants(solution: Solution) -> list[Solution]:
    """Return *solution* with nominal constants of muscles and rig, to fit again.

    The list is empty if no constant is further from there than a standard deviation of its prior.
    Constants that a fit has moved far may have compensated for a missing effect, and a fit that
    begins there does not return.
    """
    constants = [isinstance(unknown.of, OF_RETUNING) for unknown in solution.problem.unknowns]
    if np.max(np.abs(solution.z[constants]), initial=0.0) <= 1.0:
        return []
    u = np.where(constants, 0.0, solution.u)
    return [replace(solution, u=u, r=solution.problem.residuals(u), is_fresh=False)]


def least_squares(
    solution: Solution, iterations: int = 20, pool: Executor | None = None
) -> Solution:
    """Minimise the residuals of *solution* from there, without a discrepancy.

    The Jacobian of the result is fresh.
    """
    return with_fresh_jacobian(
        levenberg_marquardt(replace(solution, discrepancy=WHITE), iterations, pool), pool
    )


def with_fresh_jacobian(solution: Solution, pool: Executor | None = None) -> Solution:
    """Return *solution* with a fresh Jacobian."""
    if solution.is_fresh:
        return solution
    jacobian = solution.problem.jacobian(solution.u, solution.r, pool)
    log = solution.log.more(solution.u.size)
    return replace(solution, jacobian=jacobian, is_fresh=True, log=log)


def _cost(prior: Array, u: Array, white: Array) -> float:
    """Return the cost of unknowns *u* with the whitened residuals *white* (n,)."""
    z, n = u / prior, white.size
    return n * log(float(white @ white) / n + 1e-300) + float(z @ z)


def levenberg_marquardt(
    solution: Solution,
    iterations: int = 20,
    pool: Executor | None = None,
    renew: bool = True,
) -> Solution:
    """Minimise the cost of *solution* from there with the same discrepancy; it never increases.

    A Jacobian that is not fresh is used, too, and updated by Broyden's rule. It is computed again
    when steps do not lower the cost, or lower it by much less than predicted. Without *renew* it
    is never computed, and the fit ends when steps hardly lower the cost, which is cheap.
    """
    problem, u, r, j = solution.problem, solution.u, solution.r, solution.slopes
    stale = not solution.is_fresh
    low, high = problem.bounds
    prior, maps = problem.prior, solution.whitenings
    n, cost_of = r.size, partial(_cost, prior)
    white = problem.whitened(r, maps)
    cost, damping = cost_of(u, white), LEAST_DAMPING
    status, done, simulations = FitStatus.ITERATION_LIMIT, 0, 0
    for _ in range(iterations):
        done += 1
        slope = j.whitened(maps)
        weight = n / max(float(white @ white), 1e-300)
        normal = weight * slope.normal() + np.diag(prior**-2.0)
        gradient = weight * slope.onto(problem.by_run(white)) + u / prior**2.0
        free = ~(((u <= low) & (gradient > 0.0)) | ((u >= high) & (gradient < 0.0)))
        gain, hoped = 0.0, np.inf
        for _ in range(TRIALS // 2 if stale and renew else TRIALS):
            trial = _within(u, _step(normal, gradient, free, damping), low, high)
            r_trial = problem.residuals(trial)
            simulations += 1
            white_trial = problem.whitened(r_trial, maps)
            lower = cost - cost_of(trial, white_trial)
            if lower > 0.0:
                hoped = cost - cost_of(trial, white + slope.along(trial - u))
                gain, cost = lower, cost - lower
                j = j.updated(trial - u, problem.by_run(r_trial - r))
                u, r, white = trial, r_trial, white_trial
                damping = LESS * damping if LESS * damping > DAMPING else LEAST_DAMPING
                break
            damping = max(MORE * damping, DAMPING)
        if gain >= LITTLE and gain >= 0.5 * hoped:
            stale = True
            continue
        if gain < LITTLE and not (stale and renew):
            status = FitStatus.CONVERGED
            break
        if not renew:
            continue
        # Steps along an old Jacobian may have failed because it was inaccurate: begin undamped.
        j = problem.slopes(problem.jacobian(u, r, pool))
        simulations += u.size
        stale, damping = False, LEAST_DAMPING
    before = solution.log
    ended = FitLog(status, before.iterations + done, before.simulations + simulations)
    return Solution(problem, u, r, j.dense, solution.discrepancy, not stale, ended)


def _agree(a: Discrepancy, b: Discrepancy) -> bool:
    if a.size == 0.0 or b.size == 0.0:
        return a.size == b.size
    return abs(log(a.size / b.size)) < AGREED and abs(log(a.time / b.time)) < AGREED


def _within(u: Array, step: Array, low: Array, high: Array) -> Array:
    """Return u after *step*, which goes at most SHARE_TO_BOUND of the distance to each bound."""
    down, up = low - u, high - u
    down = np.where(down < -AT_BOUND, SHARE_TO_BOUND * down, down)
    up = np.where(up > AT_BOUND, SHARE_TO_BOUND * up, up)
    return np.clip(u + np.clip(step, down, up), low, high)


def _step(normal: Array, gradient: Array, free: NDArray[np.bool_], damping: float) -> Array:
    """Return the damped step of the unknowns that are *free*, 0 for the others."""
    step = np.zeros_like(gradient)
    k = np.flatnonzero(free)
    if k.size == 0:
        return step
    a = normal[np.ix_(k, k)]
    scale = np.sqrt(np.diag(a))
    a = a / np.outer(scale, scale) + damping * np.eye(k.size)
    step[k] = -np.linalg.lstsq(a, gradient[k] / scale, rcond=1e-12)[0] / scale
    return step
