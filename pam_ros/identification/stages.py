# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The models on the way as a report shows them, from fits."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.candidate import Fit
from pam_ros.identification.data.segment import Segment
from pam_ros.identification.evidence import independent_samples
from pam_ros.identification.result import Estimate, Stage
from pam_ros.identification.source_units import in_source_units, with_row
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
INTERVAL = 1.96  # standard errors to each side


def estimates(fit: Fit, model: Joint) -> dict[str, Estimate]:
    """Return every unknown of *fit* but the start states, with its 95 % interval.

    Intervals are as wide as the residual's independent samples demand.
    """
    solution = fit.solution
    worth = independent_samples(fit) / solution.problem.independent
    error = np.sqrt(np.diag(solution.covariance()) / max(worth, 1e-6))
    found = {}
    for k, unknown in enumerate(solution.problem.unknowns):
        if not unknown.is_parameter:
            continue
        low, high = unknown.bounds
        u = solution.u[k]
        sides = [
            unknown.value(float(np.clip(x, low, high)))
            for x in (u - INTERVAL * error[k], u, u + INTERVAL * error[k])
        ]
        at_bound = bool(u <= low + 1e-6 or u >= high - 1e-6)
        found[unknown.name] = in_source_units(unknown, sides, model, at_bound)
    return found


def stage(name: str, model: Joint, fit: Fit, test: Sequence[Segment]) -> Stage:
    """Return the stage of a fit over all its segments and over *test*.

    Test runs start from a parabola through the first 30 ms of their own measurement and are
    free from there; their error replaces that of the samples kept back.
    """
    problem = fit.solution.problem
    simulated = tuple(problem.predict(fit.solution.u))
    held_error = fit.held_error
    tested: tuple[Array, ...] = ()
    if test:
        known = [k for k, unknown in enumerate(problem.unknowns) if unknown.is_parameter]
        again = replace(
            problem,
            segments=tuple(test),
            unknowns=tuple(problem.unknowns[k] for k in known),
            weights=(),
        )
        tested = tuple(again.predict(fit.solution.u[known]))
        e = np.concatenate([p - s.target for p, s in zip(tested, test, strict=True)])
        held_error = float(np.sqrt(np.mean(e * e)))
    parameters = estimates(fit, model)
    if name == 'declared':  # nothing of it was fitted
        parameters = {
            key: Estimate(one.value, one.value, one.value, one.unit)
            for key, one in parameters.items()
        }
    return Stage(
        name,
        with_row(model, problem.row_at(fit.solution.u), problem.segments, fit.effects),
        parameters,
        fit.fit_error,
        held_error,
        simulated,
        tested,
    )
