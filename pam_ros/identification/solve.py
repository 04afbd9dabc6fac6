# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bounded nonlinear least squares for :class:`Problem`: Levenberg and Marquardt's method.

scipy's ``least_squares`` recomputes every column at every step. Here a simulation is a column,
most columns hardly change, and many nested fits share them: so columns can be handed in, and
bounds are kept by projection with the active ones held.
"""

from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.problem import Problem

Array = NDArray[np.float64]
LEAST_DAMPING = 1e-9
DAMPING = 1e-3  # of a first step that failed undamped, relative to the normal matrix's diagonal
FASTER = 10.0  # times what the last step brought that steps to come may bring


@dataclass(frozen=True, eq=False)
class Solution:
    """Where a fit ended: u, residuals and Jacobian there."""

    problem: Problem
    u: Array
    r: Array
    jacobian: Array
    iterations: int

    @property
    def cost(self) -> float:
        """-2 log posterior, see :meth:`Problem.cost`."""
        return self.problem.cost(self.u, self.r)

    def value(self, name: str) -> float:
        """Return the physical value of an unknown."""
        for unknown, u in zip(self.problem.unknowns, self.u, strict=True):
            if unknown.name == name:
                return unknown.value(u)
        raise KeyError(name)

    @property
    def normal(self) -> Array:
        """Second derivatives of half the cost over u (k, k), of the linearised problem."""
        weight = self.problem.independent / float(self.r @ self.r)
        prior = np.array([k.prior for k in self.problem.unknowns])
        return np.asarray(weight * self.jacobian.T @ self.jacobian + np.diag(prior**-2.0))

    def covariance(self) -> Array:
        """Return the posterior covariance of u (k, k), of the linearised problem."""
        normal = self.normal
        scale = np.sqrt(np.maximum(np.diag(normal), 1e-30))
        inverse = np.linalg.pinv(normal / np.outer(scale, scale), rcond=1e-13, hermitian=True)
        return np.asarray(inverse / np.outer(scale, scale))


def solve(
    problem: Problem,
    u: Array,
    iterations: int = 20,
    pool: Executor | None = None,
    jacobian: Array | None = None,
    goal: float = np.inf,
) -> Solution:
    """Minimise the problem's cost from u; never ends higher than it began.

    A Jacobian that is handed in is used as it is, and a *goal* that cannot be reached is given
    up, see :func:`improved`.
    """
    low, high = np.array([k.bounds for k in problem.unknowns]).reshape(-1, 2).T
    u = np.clip(u, low, high)
    r = problem.residuals(u)
    j = problem.jacobian(u, r, pool) if jacobian is None else jacobian
    known = Solution(problem, u, r, j, 0)
    return improved(known, iterations, pool, jacobian is not None, goal=goal)


def improved(
    known: Solution,
    iterations: int = 20,
    pool: Executor | None = None,
    stale: bool = True,
    frozen: int = 0,
    goal: float = np.inf,
) -> Solution:
    """Minimise the cost of the problem of *known* from there; never ends higher.

    The noise variance is that of the residuals at each step. A *stale* Jacobian, not of this
    place, is used as it is and, like any other, kept up to date by Broyden's rule; it is computed
    anew when steps stop to lower the cost, a -2 log likelihood, by a tenth or by half of what
    they promise. With *frozen* its first columns never are, and the others before every step: a
    cheap look, not a converged fit. A fit that counts only below a *goal* of the cost ends where
    a step along a Jacobian of its place brings far too little to arrive there.
    """
    problem, u, r, cost = known.problem, known.u, known.r, known.cost
    low, high = np.array([k.bounds for k in problem.unknowns]).reshape(-1, 2).T
    prior = np.array([k.prior for k in problem.unknowns])
    j = known.jacobian.copy()
    damping, done = LEAST_DAMPING, 0
    while done < iterations:
        done += 1
        is_fresh = not stale
        if frozen:
            j[:, frozen:] = problem.jacobian(u, r, pool, range(frozen, len(u)))
        weight = problem.independent / float(r @ r)
        normal = weight * (j.T @ j) + np.diag(prior**-2.0)
        gradient = weight * (j.T @ r) + u / prior**2.0
        free = ~(((u <= low) & (gradient > 0.0)) | ((u >= high) & (gradient < 0.0)))
        before, hoped = cost, np.inf
        for _ in range(3 if stale else 6):
            trial = np.clip(u + _step(normal, gradient, free, damping), low, high)
            r_trial = problem.residuals(trial)
            cost_trial = problem.cost(trial, r_trial)
            if cost_trial < cost:
                hoped = cost - problem.cost(trial, r + j @ (trial - u))
                j = _broyden(j, trial - u, r_trial - r)
                u, r, cost = trial, r_trial, cost_trial
                damping = 0.03 * damping if 0.03 * damping > DAMPING else LEAST_DAMPING
                break
            damping = max(30.0 * damping, DAMPING)
        gain = before - cost
        if is_fresh and cost - FASTER * gain * (iterations - done) > goal:
            break
        if frozen:
            if gain < 0.1:
                break
        elif gain < max(0.1, 0.5 * hoped) if np.isfinite(hoped) else True:
            if gain < 0.1 and not stale:
                break
            # Steps along an old Jacobian may have failed by its own fault: begin undamped.
            j, stale, damping = problem.jacobian(u, r, pool), False, LEAST_DAMPING
        else:
            stale = True
    return Solution(problem, u, r, j, known.iterations + done)


def _broyden(j: Array, du: Array, dr: Array) -> Array:
    """Return j with the least change that makes it give dr for the step du just taken."""
    return np.asarray(j + np.outer(dr - j @ du, du) / max(float(du @ du), 1e-300))


def predicted_cost(problem: Problem, u: Array, r: Array, jacobian: Array) -> float:
    """Return the cost that the linearised problem promises after one step from u."""
    prior = np.array([k.prior for k in problem.unknowns])
    low, high = np.array([k.bounds for k in problem.unknowns]).reshape(-1, 2).T
    weight = problem.independent / float(r @ r)
    normal = weight * (jacobian.T @ jacobian) + np.diag(prior**-2.0)
    gradient = weight * (jacobian.T @ r) + u / prior**2.0
    step = _step(normal, gradient, np.ones(len(u), dtype=bool), LEAST_DAMPING)
    there = np.clip(u + step, low, high)
    return problem.cost(there, r + jacobian @ (there - u))


def amplified_cost(known: Solution, r: Array) -> float:
    """Return the cost that an effect promises which turns the residuals of *known* into r.

    Linear in its size, which is free but not negative, and in the unknowns of *known*.
    """
    problem = known.problem
    prior = np.array([k.prior for k in problem.unknowns] + [np.inf])
    jacobian = np.column_stack([known.jacobian, r - known.r])
    weight = problem.independent / float(known.r @ known.r)
    normal = weight * (jacobian.T @ jacobian) + np.diag(prior**-2.0)
    u = np.append(known.u, 0.0)
    gradient = weight * (jacobian.T @ known.r) + u / prior**2.0
    step = _step(normal, gradient, np.ones(len(u), dtype=bool), LEAST_DAMPING)
    if step[-1] <= 0.0:
        return known.cost
    return problem.cost((u + step)[:-1], known.r + jacobian @ step)


def _step(normal: Array, gradient: Array, free: NDArray[np.bool_], damping: float) -> Array:
    step = np.zeros_like(gradient)
    k = np.flatnonzero(free)
    if k.size == 0:
        return step
    a = normal[np.ix_(k, k)]
    scale = np.sqrt(np.maximum(np.diag(a), 1e-12))
    a = a / np.outer(scale, scale) + damping * np.eye(k.size)
    step[k] = -np.linalg.lstsq(a, gradient[k] / scale, rcond=1e-12)[0] / scale
    return step
