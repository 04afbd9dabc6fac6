# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Uncertain numbers of a rig that recordings do not determine, and those that act alike."""

from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit.discrepancy import WHITE
from pam_ros.identification.fit.intervals import covariance
from pam_ros.identification.fit.of_rig import OfRig
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.solve import Solution, initial_solution

Array = NDArray[np.float64]
# Standard deviation, as a share of that of the prior, above which a number is not determined: the
# recordings have then at most halved its variance.
UNDETERMINED = 0.7
# Of the unknowns that act like such a number, those are named whose squared correlation with it is
# at least this share of the largest one, and at most so many.
ALIKE, MOST_ALIKE = 0.5, 3


def undetermined_before(problem: Problem, noise: float, pool: Executor) -> tuple[str, ...]:
    """Return the sentences of :func:`undetermined` that are known before a fit.

    They result from the Jacobian at the nominal values, for errors that are not larger than the
    *noise*, a standard deviation in the unit of the target.
    """
    if not _has_numbers_of_rig(problem):
        return ()
    start = initial_solution(problem, np.zeros(len(problem.unknowns)), pool=pool)
    quiet = replace(start, r=np.full_like(start.r, noise))
    return undetermined(problem, covariance(quiet, WHITE))


def undetermined_after(solution: Solution) -> tuple[str, ...]:
    """Return the sentences of :func:`undetermined` after a fit, for errors like its residuals."""
    if not _has_numbers_of_rig(solution.problem):
        return ()
    return undetermined(solution.problem, covariance(solution, solution.most_likely()))


def _has_numbers_of_rig(problem: Problem) -> bool:
    return any(isinstance(one.of, OfRig) for one in problem.unknowns)


def undetermined(problem: Problem, spread: Array) -> tuple[str, ...]:
    """Return a sentence on each number of the rig that the fitted recordings do not determine.

    *spread* is the covariance (k, k) of the unknowns of *problem*. A number is not determined if
    it has no influence, or if other unknowns have the same influence, such as an inertia and the
    scale of a torque. Those that act most like it are named then. It remains unknown, with its
    prior: if it were held at its nominal value, the intervals of the others would be too short.
    """
    spread = spread / np.outer(problem.prior, problem.prior)
    variance = np.diag(spread)
    alone = 1.0 / np.diag(np.linalg.inv(spread))  # if all others were known
    share = spread**2 / np.outer(variance, variance)  # squared correlation
    can_be_named = np.array([one.is_parameter for one in problem.unknowns])
    found: dict[frozenset[str], str] = {}
    for k, one in enumerate(problem.unknowns):
        if not isinstance(one.of, OfRig) or variance[k] <= UNDETERMINED**2:
            continue
        if alone[k] > UNDETERMINED**2:
            found[frozenset([one.name])] = (
                f'the recordings hardly determine {one.name}: it stays near its nominal value, '
                'within the given standard deviation'
            )
            continue
        others = np.where(can_be_named, share[k], 0.0)
        others[k] = 0.0
        alike = [
            problem.unknowns[m].name
            for m in np.argsort(-others)[:MOST_ALIKE]
            if others[m] >= ALIKE * others.max()
        ]
        found.setdefault(
            frozenset([one.name, *alike]),
            f'the recordings hardly distinguish {one.name} from {", ".join(alike)}: it stays '
            'near its nominal value, within the given standard deviation, until the others are '
            'known more exactly',
        )
    return tuple(found.values())
