# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time from which a model fails: up to this time it explains a recording.

The constants of the nominal model are fitted to the beginning of a recording, and the simulation
continues. As long as the continuation is as good as the fit, more of the recording is fitted. If
the error of the next block is much larger, and stays so even if this block is fitted, too, an
effect has begun.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.parts import FEWEST, Part, run_of
from pam_ros.identification.data.segment import Segment
from pam_ros.identification.data.thinning import thinned
from pam_ros.identification.fit.onset import WILKS
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.solve import initial_solution, least_squares
from pam_ros.identification.fit.unknowns import OF_RUNS
from pam_ros.identification.search.setting import Model, Setting, rms, transfer

Array = NDArray[np.float64]
BLOCKS, WITHIN = 20, 10  # blocks of a recording (3 s of a minute), and of a block
FIRST = 3  # blocks that are fitted first: a seventh of the data roughly gives seven constants
ITERATIONS = 8  # of these fits; each begins at the result of the one before


@dataclass(frozen=True)
class OnsetEstimate:
    """The time in s, with a 95 % interval, up to which a model explains a recording."""

    time: float
    low: float
    high: float


def estimate_onset(setting: Setting) -> OnsetEstimate | None:
    """Return the time from which the re-tuned model fails, None if there is none.

    It is evaluated only for a single recording of a load that moves and has a spring: only there
    the continuation tests the model.
    """
    runs = _runs(setting)
    if not runs:
        return None
    whole = setting.problem_of(runs, setting.step)
    edges = _edges(runs)[FIRST:]
    if _count(runs[0], edges[0]) < FEWEST:
        return None
    known = _fitted(whole, edges[0], np.zeros(len(whole.unknowns)), setting)
    return _estimate(whole, edges, known, setting)


def estimate_onset_after(model: Model) -> OnsetEstimate | None:
    """Return the time after the fitted part from which a model fails, None if there is none.

    It is evaluated for the same recordings as :func:`moment`.
    """
    setting = model.setting
    runs = _runs(setting)
    if not runs:
        return None
    whole, known = transfer(model.nearest, runs)
    end = max(float(part.segment.t[part.fit][-1]) for part in setting.parts if part.fit.any())
    edges = _edges(runs)
    later = edges[edges > end]
    return _estimate(whole, np.concatenate([[end], later]), known, setting) if later.size else None


def _edges(runs: Sequence[Segment]) -> Array:
    """Return the ends of the blocks of a recording in s, from its start on."""
    first, last = runs[0].t[0], runs[-1].t[-1]
    edges: Array = first + (last - first) * np.arange(BLOCKS + 1) / BLOCKS
    return edges


def _estimate(
    whole: Problem, edges: Array, known: Array, setting: Setting
) -> OnsetEstimate | None:
    """Return the time from which the model of *whole* fails in blocks between *edges* in s.

    *known* are its unknowns, fitted to the samples before the first edge.
    """
    t = np.concatenate([s.t for s in whole.segments])
    found = _failing(whole, t, edges, known, setting)
    if found is None:
        return None
    first, known = found
    within = np.linspace(edges[first], edges[first + 1], WITHIN + 1)
    finer = _failing(whole, t, within, known, setting)
    if finer is not None:
        edges, (first, known) = within, finer
    near, left = t <= edges[first + 1], whole.residuals(known)
    located = _located(t[near], left[near])
    if rms(left[t < located.time]) > setting.noise / setting.criteria.left:
        return None
    # Constants of an earlier fit leave slow errors, which are as large as what only just begins.
    left = whole.residuals(_fitted(whole, float(edges[first]), known, setting))
    located = _located(t[near], left[near])
    # An effect becomes visible only some time after it begins.
    return replace(located, low=min(located.low, float(edges[first])))


def _runs(setting: Setting) -> list[Segment]:
    """Return the stretches of a single recording in their order, thinned; none of several.

    None either of a load without a spring, and of one that a machine holds.
    """
    segments = sorted((part.segment for part in setting.parts), key=lambda s: float(s.t[0]))
    numbers = {s.recording for s in segments}
    if len(numbers) > 1 or any(a.t[-1] >= b.t[0] for a, b in pairwise(segments)):
        return []
    if setting.drifts or segments[0].kind != 'free':
        return []
    runs = [thinned(s, setting.period) for s in segments]
    return [s for s in runs if s.t.size >= FEWEST]


def shares_after(
    since: OnsetEstimate, parts: Sequence[Part], shares: tuple[float, float], least: float
) -> tuple[float, float] | None:
    """Return the shares of a recording that are fitted, and that are fitted or decide.

    They are the *shares* of the time after *since*, since only this time shows what has begun.
    None if less than *least* s of it would be fitted.
    """
    t = [t for part in parts for t in (part.segment.t[0], part.segment.t[-1])]
    first, last = min(t), max(t)
    gone = (since.time - first) / (last - first)
    # A share of 1 remains exactly 1.
    fit, choose = (1.0 - (1.0 - share) * (1.0 - gone) for share in shares)
    return (fit, choose) if (fit - gone) * (last - first) >= least else None


def _failing(
    whole: Problem, t: Array, edges: Array, known: Array, setting: Setting
) -> tuple[int, Array] | None:
    """Return the first block between *edges* in s that the model does not explain, and a fit.

    The fit is to the samples before this block; *known* is the fit to those before the first edge.
    None if the model explains all blocks.
    """
    for k, (end, next_end) in enumerate(pairwise(edges)):
        before, block = t <= end, (t > end) & (t <= next_end)
        if not block.any():
            continue
        left = whole.residuals(known)
        most = rms(left[before]) / setting.criteria.left
        if rms(left[block]) <= most:
            continue
        further = _fitted(whole, next_end, known, setting)
        if rms(whole.residuals(further)[block]) > most:
            return k, known
        known = further
    return None


def _fitted(whole: Problem, end: float, u: Array, setting: Setting) -> Array:
    """Return the unknowns of *whole*, fitted to the samples up to *end* s, from u."""
    # Stretches are in order, so that the last ones are left out.
    runs = [s for s in whole.segments if _count(s, end) >= FEWEST]
    keep = [
        n
        for n, unknown in enumerate(whole.unknowns)
        if not isinstance(unknown.of, OF_RUNS) or unknown.of.run < len(runs)
    ]
    problem = replace(
        whole,
        segments=tuple(run_of(s, s.t <= end) for s in runs),
        unknowns=tuple(whole.unknowns[n] for n in keep),
    )
    found = least_squares(
        initial_solution(problem, u[keep], pool=setting.pool), ITERATIONS, setting.pool
    )
    moved: Array = u.copy()
    moved[keep] = found.u
    return moved


def _count(segment: Segment, end: float) -> int:
    return int(np.count_nonzero(segment.t <= end))


def _located(t: Array, left: Array) -> OnsetEstimate:
    """Return the most likely time at which the variance of *left* (n,) changes, at stamps t.

    For each time, the variances before and after it have their most likely values.
    """
    power = left**2
    n = np.arange(1, t.size)
    sums = np.cumsum(power)
    first = sums[:-1] / n
    last = (sums[-1] - sums[:-1]) / (t.size - n)
    deviance = n * np.log(first + 1e-300) + (t.size - n) * np.log(last + 1e-300)
    best = int(np.argmin(deviance))
    near = np.flatnonzero(deviance <= deviance[best] + WILKS)
    return OnsetEstimate(float(t[best + 1]), float(t[near[0]]), float(t[near[-1] + 1]))
