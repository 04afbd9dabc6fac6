# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The problem of re-tuning the declared parameters, with no effect yet."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.candidate import Fit, fitted
from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import Segment
from pam_ros.identification.fit.unknowns import Unknown, declared_unknowns, run_unknowns
from pam_ros.identification.problem import Problem
from pam_ros.identification.solve import Solution, solve
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
OUTLIER = 1.48  # median residuals beyond which one is an outlier


def problem_of(
    model: Joint, segments: Sequence[Segment], noise: Noise, step: float, stride: int = 0
) -> Problem:
    """Return the problem of re-tuning *model* to the segments, at most *step* s a step.

    *stride* says how many samples apart those of thinned segments were in the recording, 0 where
    they are not thinned. Starts stay near to the measurement, but for those of the windows that
    a load without a muscle is cut into: there the rest of a wrong model must find room.
    """
    sigma = np.inf if stride and model.is_driven else noise.sigma
    unknowns: list[Unknown] = [*declared_unknowns(model), *run_unknowns(segments, sigma)]
    rho = noise.rho ** max(stride, 1)
    samples = sum(int(np.count_nonzero(s.fit)) for s in segments)
    return Problem(
        tuple(segments),
        model.layout,
        model.active,
        model.parameters().ravel(),
        tuple(unknowns),
        samples * (1.0 - rho) / (1.0 + rho),
        step,
    )


def only_starts(problem: Problem, u: Array, pool: Executor) -> Solution:
    """Return u with its start states fitted and the rest as it is, all columns computed."""
    starts = [k for k, unknown in enumerate(problem.unknowns) if not unknown.is_parameter]
    if starts:
        rest = [k for k in range(len(u)) if k not in starts]
        row = replace(problem, unknowns=tuple(problem.unknowns[k] for k in rest)).row_at(u[rest])
        only = replace(problem, row=row, unknowns=tuple(problem.unknowns[k] for k in starts))
        u = u.copy()
        u[starts] = solve(only, u[starts], pool=pool).u
    r = problem.residuals(u)
    return Solution(problem, u, r, problem.jacobian(u, r, pool), 0)


def robust(fit: Fit, pool: Executor) -> Fit:
    """Return *fit* with outliers limited: a force cell that slipped spoils a whole recording.

    A residual is an outlier beyond the normal one's scale, by the median of its size.
    """
    for _ in range(2):
        solution = fit.solution
        e = np.concatenate(
            [
                (p - s.target)[s.fit]
                for p, s in zip(
                    solution.problem.predict(solution.u), solution.problem.segments, strict=True
                )
            ]
        )
        limited = replace(solution.problem, outlier=OUTLIER * float(np.median(np.abs(e))))
        fit = fitted(fit.effects, solve(limited, solution.u, pool=pool))
    return fit
