# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From a fit's numbers back to a declared model: constants in their source's units, effects."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.names import EffectName
from pam_ros.errors import ParameterError
from pam_ros.identification.candidate import Fit
from pam_ros.identification.data.segment import HeldSegment, Segment
from pam_ros.identification.evidence import independent_samples
from pam_ros.identification.fit.unknowns import CONSTANTS, OfEffect, Unknown
from pam_ros.identification.problem import Problem
from pam_ros.identification.result import Estimate, Stage
from pam_ros.muscle.constants import Constants, from_si
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint, changed

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
        found[unknown.name] = _in_source_units(unknown, sides, model, at_bound)
    return found


def _in_source_units(
    unknown: Unknown, sides: list[float], model: Joint, at_bound: bool
) -> Estimate:
    if isinstance(unknown.of, OfEffect):
        unit = _effect_unit(model, unknown.of.which)
    elif unknown.name in CONSTANTS:
        k = CONSTANTS.index(unknown.name)
        muscle = model.muscle
        sides = [
            from_si(_only(k, x), muscle.pressure_unit, muscle.contraction_unit)[k] for x in sides
        ]
        unit = _constant_unit(model, unknown.name)
    else:
        unit = ''  # zeta
    return Estimate(sides[1], min(sides), max(sides), unit, at_bound)


def _only(k: int, value: float) -> Constants:
    values = [0.0] * 6
    values[k] = value
    a1, a2, a3, a4, a5, a6 = values
    return a1, a2, a3, a4, a5, a6


def _constant_unit(model: Joint, name: str) -> str:
    p, kappa = model.muscle.pressure_unit, model.muscle.contraction_unit
    return {
        'a1': f'N/{p}',
        'a2': 'N',
        'a3': f'1/{kappa}',
        'a4': f'N/({p} {kappa})',
        'a5': f'N/{p}',
        'a6': 'N',
    }[name]


def _effect_unit(model: Joint, name: EffectName) -> str:
    effect = next(e for e in model.library if e.name == name.effect)
    return next(p.unit for p in effect.parameters if p.name == name.parameter)


def model_of(model: Joint, problem: Problem, u: Array, effects: Sequence[str]) -> Joint:
    """Return *model* with the parameters at u: constants in the units in which it gives them.

    *effects* are the names of those that the fit added to the declared ones. Constants that
    were fitted where the rig went may make no muscle beyond: then the model's contraction is
    limited to where it went, and in the last resort its constants are taken back towards those
    declared until they make a muscle.
    """
    q = problem.row_at(u)
    values = {name: dict(given) for name, given in model.all_effects.items()}
    for effect in model.library:
        if effect.name in effects:
            values[effect.name] = {
                p.name: float(q[model.layout.index(effect, k)])
                for k, p in enumerate(effect.parameters)
            }
    went = np.concatenate(
        [s.position if isinstance(s, HeldSegment) else s.target for s in problem.segments]
    )
    limits = {
        'kappa_min': min(0.0, float(went.min()) / model.muscle.l0),
        'kappa_max': max(0.01, float(went.max()) / model.muscle.l0),
    }
    declared = model.parameters().ravel()
    for back, changes in ((0.0, {}), *((a, limits) for a in np.linspace(0.0, 1.0, 11))):
        row = q + back * (declared - q)
        try:
            return changed(model, _muscle(model, row, changes), values)
        except ParameterError:
            continue
    return changed(model, model.muscle, values)


def _muscle(model: Joint, q: Array, changes: dict[str, float]) -> Muscle:
    si = tuple(float(q[model.layout.constant(a)]) for a in range(at.A1, at.A6 + 1))
    source = from_si(
        (si[0], si[1], si[2], si[3], si[4], si[5]),
        model.muscle.pressure_unit,
        model.muscle.contraction_unit,
    )
    values: dict[str, Any] = {**dict(zip(CONSTANTS, source, strict=True)), **changes}
    return replace(model.muscle, **values, zeta=float(q[model.layout.constant(at.ZETA)]))


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
        model_of(model, problem, fit.solution.u, fit.effects),
        parameters,
        fit.fit_error,
        held_error,
        simulated,
        tested,
    )
