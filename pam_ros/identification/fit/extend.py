# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Problems with one effect more or less, or with more or fewer of its parameters."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import gmean

from pam_ros.identification.data.segment import Segment
from pam_ros.identification.fit.places import Place
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.unknowns import (
    MemoryStart,
    OfEffect,
    OnsetTime,
    Unknown,
    effect_unknowns,
    memory_unknowns,
    parameters_of,
    proper,
)
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]


def with_effect(
    problem: Problem, joint: Joint, place: Place, start: Mapping[str, float]
) -> tuple[Problem, Array]:
    """Return the problem with the effect's parameters in *start* unknown, and the new ones' u.

    If the problem lacks the effect at *place*, its other parameters have their defaults, and its
    memory at the start of each run becomes unknown, too. If the problem has the effect, the other
    parameters do not change, and those that are unknown already are the same unknowns.
    """
    there = parameters_of(problem.unknowns, place.name)
    is_new = not there
    more = {name: value for name, value in start.items() if name not in there}
    added = [proper(one) for one in effect_unknowns(joint, place, more)]
    row = problem.row.copy()
    for k, p in enumerate(place.parameters):
        indices = place.indices(joint.layout, k)
        row[indices] = start.get(p.name, p.default if is_new else row[indices[0]])
    memory = memories(problem, place) if is_new else []
    u = [k.coordinate(start[k.of.parameter]) for k in added if isinstance(k.of, OfEffect)]
    new = replace(
        problem,
        row=row,
        active=joint.library,
        unknowns=(*problem.unknowns, *added, *memory),
    )
    return new, np.array([*u, *(0.0 for _ in memory)])


def started(problem: Problem, u: Array, place: Place, start: Mapping[str, float]) -> Array:
    """Return u with those unknowns of the effect at *place* that are in *start* at its values."""
    moved: Array = u.copy()
    for k, unknown in enumerate(problem.unknowns):
        of = unknown.of
        if isinstance(of, OfEffect) and of.place == place.name and of.parameter in start:
            moved[k] = unknown.coordinate(start[of.parameter])
    return moved


def bounded(problem: Problem, u: Array, joint: Joint, place: Place) -> Problem:
    """Return the problem, whose fit begins at u, with the bounds that the effect at *place* gives.

    With values within these bounds *joint* can have the effect.
    """
    fitted = parameters_of(problem.unknowns, place.name)
    near = _values(problem.row_at(u), joint, place)
    bounds = place.effect.fit_bounds(near, fitted, joint.load.mass, _duration(problem.segments))

    def within(unknown: Unknown) -> Unknown:
        of = unknown.of
        if not (isinstance(of, OfEffect) and of.place == place.name and of.parameter in bounds):
            return unknown
        low, high = bounds[of.parameter]
        return replace(unknown, low=max(unknown.low, low), high=min(unknown.high, high))

    return replace(problem, unknowns=tuple(map(within, problem.unknowns)))


def _duration(segments: Sequence[Segment]) -> float:
    """Return the duration in s of the longest recording, which may be cut into several runs."""
    ends: dict[int, list[float]] = {}
    for s in segments:
        ends.setdefault(s.recording, []).extend((float(s.t[0]), float(s.t[-1])))
    return max(max(times) - min(times) for times in ends.values())


def _values(row: Array, joint: Joint, place: Place) -> dict[str, float]:
    """Return the values of the effect at *place* in the parameter *row* of *joint*."""
    return {
        p.name: float(row[place.indices(joint.layout, k)[0]])
        for k, p in enumerate(place.parameters)
    }


def memories(problem: Problem, place: Place) -> list[Unknown]:
    """Return the memory of the effect at *place* at the start of each run, as unknowns.

    An effect that begins later has no memory there.
    """
    if any(isinstance(k.of, OnsetTime) for k in problem.unknowns):
        return []
    return memory_unknowns(problem.layout, place, len(problem.segments))


def finer_starts(
    unknowns: Sequence[Unknown], row: Array, joint: Joint, place: Place
) -> list[dict[str, float]]:
    """Return starting values for the parameters at *place* that are not among *unknowns*.

    Either all of them with their values in the parameter *row*, or some with the values of a start
    of the effect. If that start has several strengths in the same unit, of which one is already
    fitted, they keep their ratios, and their geometric mean becomes the fitted value, because a
    strength that is fitted alone is a mean of all: for example, a friction between those of a
    sliding and of a resting load. The values then include that of the fitted strength.
    """
    there = parameters_of(unknowns, place.name)
    values = _values(row, joint, place)
    rest = {name: value for name, value in values.items() if name not in there}
    options = [rest] if rest else []
    for start in place.fit_starts:
        some = {name: value for name, value in start.items() if name in rest}
        for same in _same_units(place, some, start):
            known = {name: values[name] for name in same if name in there}
            if known and all(start[name] * value > 0.0 for name, value in known.items()):
                factor = gmean(np.abs([*known.values()])) / gmean(np.abs([*same.values()]))
                some.update({name: float(factor) * value for name, value in same.items()})
        if some and some not in options:
            options.append(some)
    return options


def hidden_start(unknowns: Sequence[Unknown], place: Place) -> dict[str, float]:
    """Return the typical sizes of those parameters at *place* that long steps hide.

    Those that are among *unknowns* are left out.
    """
    there = parameters_of(unknowns, place.name)
    hidden = [p for p in place.parameters if p.needs_fine_steps and p.name not in there]
    return {p.name: p.scale for p in hidden}


def _same_units(
    place: Place, some: Mapping[str, float], start: Mapping[str, float]
) -> list[dict[str, float]]:
    """Return the strengths in *start* for each unit in which *some* has a strength."""
    units = {p.name: p.unit for p in place.parameters if p.strength}
    new = dict.fromkeys(units[name] for name in some if name in units)
    return [{n: value for n, value in start.items() if units.get(n) == unit} for unit in new]


def without_effect(problem: Problem, joint: Joint, place: Place) -> tuple[Problem, list[int]]:
    """Return the problem without the effect at *place*, and indices of the remaining unknowns."""
    row = problem.row.copy()
    for k, p in enumerate(place.parameters):
        row[place.indices(joint.layout, k)] = p.default
    keep = [k for k, unknown in enumerate(problem.unknowns) if not belongs(unknown, place.name)]
    unknowns = tuple(problem.unknowns[k] for k in keep)
    return replace(problem, row=row, unknowns=unknowns), keep


def plainer_sets(unknowns: Sequence[Unknown], place: Place) -> list[set[str]]:
    """Return the smaller sets of parameters at *place* with which a fit may also begin."""
    there = parameters_of(unknowns, place.name)
    found: list[set[str]] = []
    for start in place.fit_starts:
        if {*start} < there and {*start} not in found:
            found.append({*start})
    return found


def in_common(
    problem: Problem, u: Array, joint: Joint, place: Place, simple: str
) -> dict[str, float]:
    """Return the values at u of the parameters that an effect shares with a *simple* one.

    The effect at *place* contains the simple one. The values have the names of the parameters of
    the simple one; only parameters that are unknown are returned.
    """
    there = parameters_of(problem.unknowns, place.name)
    values = _values(problem.row_at(u), joint, place)
    pairs = place.effect.contains[simple].items()
    return {own: values[name] for own, name in pairs if name in there}


def with_parameters(
    problem: Problem, joint: Joint, place: Place, names: set[str]
) -> tuple[Problem, list[int]]:
    """Return the problem in which, of the parameters at *place*, only *names* are unknown.

    The others have their defaults. Also returns the indices of the remaining unknowns.
    """
    row = problem.row.copy()
    for k, p in enumerate(place.parameters):
        if p.name not in names:
            row[place.indices(joint.layout, k)] = p.default
    keep = [
        k
        for k, unknown in enumerate(problem.unknowns)
        if not isinstance(unknown.of, OfEffect)
        or unknown.of.place != place.name
        or unknown.of.parameter in names
    ]
    unknowns = tuple(problem.unknowns[k] for k in keep)
    return replace(problem, row=row, unknowns=unknowns), keep


def belongs(unknown: Unknown, place: str) -> bool:
    """Return whether an unknown is a parameter or a memory of the effect at the named *place*."""
    return isinstance(unknown.of, OfEffect | MemoryStart) and unknown.of.place == place
