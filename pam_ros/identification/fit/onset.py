# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time at which effects begin (onset), as an unknown whose derivative can be 0.

A lag that begins while the command is constant is visible only from the next command on. All
onsets in this interval are equally good, and those in the next interval are worse by a step. So
the onset is found, and its interval is computed, from the cost with the other unknowns fixed.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit.intervals import half_widths
from pam_ros.identification.fit.solve import Solution
from pam_ros.identification.fit.unknowns import OnsetTime

Array = NDArray[np.float64]
# Range around an onset that is searched, and step, in s: an effect is visible up to 1 s later.
EARLIER, LATER, APART = 1.0, 0.5, 0.02
# Change of -2 ln(likelihood) at the ends of a 95 % interval of one number (Wilks 1938).
WILKS = 3.84
FINEST, HALVINGS = 1e-4, 8  # s, first step to the side, and bisections to find an end


def index_of_onset(solution: Solution) -> int | None:
    """Return the index of the onset among the unknowns of a fit, None if there is none."""
    unknowns = solution.problem.unknowns
    return next((k for k, one in enumerate(unknowns) if isinstance(one.of, OnsetTime)), None)


def refine_onset(solution: Solution) -> Solution:
    """Return *solution* at the best onset near its own, with the other unknowns fixed."""
    k = index_of_onset(solution)
    if k is None:
        return solution
    low, high = (float(side[k]) for side in solution.problem.bounds)
    # Its unknown is in s.
    count = round((EARLIER + LATER) / APART) + 1
    times = solution.u[k] + np.linspace(-EARLIER, LATER, count)
    tried = [with_unknown(solution, k, u) for u in times[(times > low) & (times < high)]]
    return min([solution, *tried], key=lambda one: one.cost)


def keeping_onset(solution: Solution, fit: Callable[[Solution], Solution]) -> Solution:
    """Return what *fit* makes of *solution* while the onset keeps its value.

    Without an effect the onset has no influence, and where an effect is only roughly known, the
    steps of a fit are large: they can move the onset into a minimum from which it does not return.
    """
    problem, k = solution.problem, index_of_onset(solution)
    if k is None:
        return fit(solution)
    onset = problem.unknowns[k]
    there = onset.value(solution.u[k])
    held = replace(onset, low=there, high=there)
    unknowns = (*problem.unknowns[:k], held, *problem.unknowns[k + 1 :])
    found = fit(replace(solution, problem=replace(problem, unknowns=unknowns)))
    return replace(found, problem=problem)


def with_unknown(solution: Solution, k: int, u: float) -> Solution:
    """Return *solution* with unknown number *k* at u and an unchanged Jacobian."""
    there = solution.u.copy()
    there[k] = u
    return replace(solution, u=there, r=solution.problem.residuals(there), is_fresh=False)


def interval(solution: Solution) -> tuple[float, float, float]:
    """Return the onset in s of a fit with the ends of its 95 % interval.

    The cost with the other unknowns fixed gives the distance of each end. It is multiplied by the
    ratio of the interval of :mod:`.intervals`, with all unknowns free, to the one that the
    derivative gives with the others fixed.
    """
    k = index_of_onset(solution)
    assert k is not None
    process = replace(solution, discrepancy=solution.most_likely())
    slope = process.problem.whitened(solution.jacobian[:, k : k + 1], process.whitenings)
    known_by = float(np.sum(slope**2)) / process.noise**2 + solution.problem.prior[k] ** -2.0
    ratio = half_widths(solution, process.discrepancy)[k] / (WILKS / known_by) ** 0.5
    unknown, u = solution.problem.unknowns[k], float(solution.u[k])
    low, high = (unknown.value(u + (_end(process, k, side) - u) * ratio) for side in (-1.0, 1.0))
    return unknown.value(u), low, high


def _end(solution: Solution, k: int, side: float) -> float:
    """Return the u at which the cost has risen by WILKS to one *side*, or its bound there."""
    u, bound = float(solution.u[k]), float(solution.problem.bounds[side > 0.0][k])
    most = solution.cost + WILKS

    def is_over(away: float) -> bool:
        return with_unknown(solution, k, u + side * away).cost > most

    limit = abs(bound - u)
    inside, outside = 0.0, FINEST
    while outside < limit and not is_over(outside):
        inside, outside = outside, 2.0 * outside
    if outside >= limit:
        return bound
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        inside, outside = (inside, middle) if is_over(middle) else (middle, outside)
    return u + side * 0.5 * (inside + outside)
