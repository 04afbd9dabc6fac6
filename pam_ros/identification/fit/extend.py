# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Problems with one effect more or less, or with more or less of an effect."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.unknowns import (
    MemoryStart,
    OfEffect,
    Unknown,
    effect_unknowns,
    memory_unknowns,
    parameters_of,
    proper,
)
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]


def with_effect(
    problem: Problem, joint: Joint, effect: Effect, start: Mapping[str, float]
) -> tuple[Problem, Array]:
    """Return the problem with the parameters of *effect* that *start* names, and their u there.

    Of an effect that the problem lacks the others keep their defaults, and where its memory stands
    at the start of each run becomes unknown, too; of one that it has they stay as they are.
    """
    added = [proper(one) for one in effect_unknowns(joint, effect, dict(start))]
    is_new = not parameters_of(problem.unknowns, effect.name)
    row = problem.row.copy()
    for k, p in enumerate(effect.parameters):
        index = joint.layout.index(effect, k)
        row[index] = start.get(p.name, p.default if is_new else row[index])
    memory = memory_unknowns(joint.layout, effect, len(problem.segments)) if is_new else []
    u = [k.coordinate(start[k.of.which.parameter]) for k in added if isinstance(k.of, OfEffect)]
    new = replace(
        problem,
        row=row,
        active=joint.library,
        unknowns=(*problem.unknowns, *added, *memory),
    )
    return new, np.array([*u, *(0.0 for _ in memory)])


def finer_starts(
    unknowns: Sequence[Unknown], row: Array, joint: Joint, effect: Effect
) -> list[dict[str, float]]:
    """Return values from which to free the parameters of *effect* that are not among *unknowns*.

    All of them from where they are in the parameter *row*, or some from where a start has them;
    strengths in the proportion to one that is fitted already in which that start has both.
    """
    there = parameters_of(unknowns, effect.name)
    values = {
        p.name: float(row[joint.layout.index(effect, k)]) for k, p in enumerate(effect.parameters)
    }
    rest = {name: value for name, value in values.items() if name not in there}
    units = {p.name: p.unit for p in effect.parameters if p.strength}
    options = [rest] if rest else []
    for start in effect.fit_starts:
        some = {name: value for name, value in start.items() if name in rest}
        for name in some:
            shared = [n for n in start if n not in rest and units.get(n) == units.get(name, '')]
            if shared and start[shared[0]] * values[shared[0]] > 0.0:
                some[name] *= values[shared[0]] / start[shared[0]]
        if some and some not in options:
            options.append(some)
    return options


def without_effect(problem: Problem, joint: Joint, effect: Effect) -> tuple[Problem, list[int]]:
    """Return the problem without *effect*, and which of the unknowns are left."""
    row = problem.row.copy()
    for k, p in enumerate(effect.parameters):
        row[joint.layout.index(effect, k)] = p.default
    keep = [k for k, unknown in enumerate(problem.unknowns) if not belongs(unknown, effect.name)]
    unknowns = tuple(problem.unknowns[k] for k in keep)
    return replace(problem, row=row, unknowns=unknowns), keep


def plainer_sets(unknowns: Sequence[Unknown], effect: Effect) -> list[set[str]]:
    """Return the smaller sets of parameters of *effect* with which a fit may begin as well."""
    there = parameters_of(unknowns, effect.name)
    found: list[set[str]] = []
    for start in effect.fit_starts:
        if {*start} < there and {*start} not in found:
            found.append({*start})
    return found


def with_parameters(
    problem: Problem, joint: Joint, effect: Effect, names: set[str]
) -> tuple[Problem, list[int]]:
    """Return the problem with *names* alone of the parameters of *effect* unknown.

    The others are at their defaults. Also returns which of the unknowns are left.
    """
    row = problem.row.copy()
    for k, p in enumerate(effect.parameters):
        if p.name not in names:
            row[joint.layout.index(effect, k)] = p.default
    keep = [
        k
        for k, unknown in enumerate(problem.unknowns)
        if not isinstance(unknown.of, OfEffect)
        or unknown.of.which.effect != effect.name
        or unknown.of.which.parameter in names
    ]
    unknowns = tuple(problem.unknowns[k] for k in keep)
    return replace(problem, row=row, unknowns=unknowns), keep


def belongs(unknown: Unknown, effect: str) -> bool:
    """Say whether an unknown is a parameter or a memory of the effect of this name."""
    of = unknown.of
    if isinstance(of, OfEffect):
        return of.which.effect == effect
    return isinstance(of, MemoryStart) and of.effect == effect
