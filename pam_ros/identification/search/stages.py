# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The final fits in a form for reports: models, parameters with intervals, errors, free runs."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.parts import Part
from pam_ros.identification.data.segment import Segment
from pam_ros.identification.fit.discrepancy import Discrepancy
from pam_ros.identification.fit.intervals import half_widths
from pam_ros.identification.fit.onset import interval
from pam_ros.identification.fit.places import Place
from pam_ros.identification.fit.solve import Solution
from pam_ros.identification.fit.unknowns import OF_RUNS, OnsetTime, Unknown
from pam_ros.identification.result import Estimate, Stage
from pam_ros.identification.search.final import FinalFits, errors_of, simulated
from pam_ros.identification.search.onset import OnsetEstimate
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.setting import Setting, rms, simulate_on
from pam_ros.identification.source_units import in_source_units, with_row
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
BLOCK = 0.25  # s, in which the error of a model is compared with that of its fit
NEAR = 1e-6  # distance of u from its bound that counts as 0


def stages(ends: FinalFits, search: Search, test: Sequence[Segment]) -> tuple[Stage, Stage, Stage]:
    """Return the nominal, the re-tuned and the augmented model of a search, after the final fits.

    Errors on held-out data are those of free runs over *test* from their measured start, or
    without *test* those over the judging part.
    """
    joint = search.setting.joint
    problem = search.setting.problem
    known = [unknown for unknown in problem.unknowns if unknown.is_parameter]
    nominal = {k.name: in_source_units(k, 3 * [k.value(0.0)], joint, False) for k in known}
    retuned, augmented = search.setting.pool.map(
        lambda one: estimates(one, one.most_likely(), joint), (ends.retuned, ends.augmented)
    )
    effects = search.best.effects

    def stage(
        name: str, fit: Solution, parameters: dict[str, Estimate], added: Sequence[str]
    ) -> Stage:
        runs = simulated(fit, ends.parts, search.setting)
        error, held = errors_of(runs, ends.parts)
        # Effects that began in one recording act in others from the start.
        tested = simulate_on(fit, test, without=(*OF_RUNS, OnsetTime)) if test else []
        if tested:
            off = [run - s.target for run, s in zip(tested, test, strict=True)]
            held = rms(np.concatenate(off))
        row, segments = fit.problem.row_at(fit.u), fit.problem.segments
        places = [search.setting.places[effect] for effect in added]
        numbers = fit.problem.numbers_at(fit.u)
        model, problem = with_row(joint, row, segments, places, numbers)
        return Stage(
            name, model, problem, parameters, error, held, tuple(runs), tuple(tested), fit.log
        )

    return (
        stage('declared', ends.nominal, nominal, ()),
        stage('retuned', ends.retuned, retuned, ()),
        stage('augmented', ends.augmented, augmented, effects),
    )


def at_place(estimates: Mapping[str, Estimate], place: Place) -> dict[str, Estimate]:
    """Return those named *estimates* that are parameters at *place*, by the parameter."""
    names = [p.name for p in place.parameters]
    return {name: estimates[place.flat(name)] for name in names if place.flat(name) in estimates}


def estimates(solution: Solution, process: Discrepancy, joint: Joint) -> dict[str, Estimate]:
    """Return the parameters of a fit with their 95 % intervals, for errors with a *process*.

    Each is in the unit in which *joint* gives it. Starts of runs and memories are not included.
    """
    widths = half_widths(solution, process)
    return {
        unknown.name: _estimate(unknown, u, width, joint)
        for unknown, u, width in zip(solution.problem.unknowns, solution.u, widths, strict=True)
        if unknown.is_parameter
    }


def onset_of(solution: Solution) -> Estimate:
    """Return the time in s at which the effects of a fit begin, with its 95 % interval."""
    return Estimate(*interval(solution), 's')


def development_of(last: Stage, parts: Sequence[Part], setting: Setting) -> float | None:
    """Return the s after the onset within which effects develop, None if they appear at once.

    *last* is the model with the effects, after the last fits to *parts*. They have developed when
    its error in BLOCK s is no longer larger than that of the fit by the factor 1/``left``.
    """
    if setting.transition is None or setting.onset is None:
        return None
    start, end = setting.transition
    most = max(setting.noise, last.fit_error) / setting.criteria.left
    t = np.concatenate([part.segment.t for part in parts])
    e = np.concatenate(
        [run - p.segment.target for run, p in zip(last.simulated, parts, strict=True)]
    )
    edges = np.arange(start, end + BLOCK, BLOCK)
    errors = [e[(t >= a) & (t < b)] for a, b in pairwise(edges)]
    large = [b for one, b in zip(errors, edges[1:], strict=True) if one.size and rms(one) > most]
    return float(max(large, default=end)) - setting.onset


def visible_since(
    since: OnsetEstimate, retuned: Solution, setting: Setting, development: float | None
) -> Estimate:
    """Return the time in s from which effects are visible, with the interval of their beginning.

    Effects that develop in *development* s are visible only after they have grown to the share of
    the error of the *retuned* model that :mod:`.onset` detects.
    """
    low = since.low
    if development is not None:
        share = setting.noise / setting.criteria.left / rms(retuned.r)
        low = min(low, since.time - share * development)
    return Estimate(since.time, low, since.high, 's')


def _estimate(unknown: Unknown, u: float, width: float, joint: Joint) -> Estimate:
    low, high = unknown.bounds
    sides = [unknown.value(float(np.clip(x, low, high))) for x in (u - width, u, u + width)]
    return in_source_units(unknown, sides, joint, bool(u <= low + NEAR or u >= high - NEAR))
