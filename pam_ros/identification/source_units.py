# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Convert the result of a fit to a model with constants in the units of their source."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import ParameterError
from pam_ros.identification.data.segment import HeldSegment, Segment
from pam_ros.identification.fit.of_rig import OfRig, changed, numbers_of
from pam_ros.identification.fit.places import Place, effect_of
from pam_ros.identification.fit.unknowns import Constant, OfEffect, Unknown
from pam_ros.identification.result import Estimate
from pam_ros.muscle.constants import CONSTANTS, Constants, from_si
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]


def in_source_units(
    unknown: Unknown, sides: list[float], model: Joint, at_bound: bool
) -> Estimate:
    """Return the estimate of a parameter, in the unit in which *model* gives it.

    *sides* are the low end of its interval, its value and the high end, in SI.
    """
    of, unit = unknown.of, ''
    if isinstance(of, OfEffect):
        unit = _effect_unit(model, effect_of(of.place), of.parameter)
    elif isinstance(of, Constant) and of.which != at.ZETA:
        k, muscle = of.which - at.A1, model.muscles[of.muscle]
        sides = [
            from_si(_only(k, x), muscle.pressure_unit, muscle.contraction_unit)[k] for x in sides
        ]
        unit = _constant_unit(muscle, CONSTANTS[k])
    elif isinstance(of, OfRig):
        unit = numbers_of(model)[of][1].unit
    return Estimate(sides[1], min(sides), max(sides), unit, at_bound)


def _only(k: int, value: float) -> Constants:
    values = [0.0] * 6
    values[k] = value
    a1, a2, a3, a4, a5, a6 = values
    return a1, a2, a3, a4, a5, a6


def _constant_unit(muscle: Muscle, name: str) -> str:
    p, kappa = muscle.pressure_unit, muscle.contraction_unit
    return {
        'a1': f'N/{p}',
        'a2': 'N',
        'a3': f'1/{kappa}',
        'a4': f'N/({p} {kappa})',
        'a5': f'N/{p}',
        'a6': 'N',
    }[name]


def _effect_unit(model: Joint, effect: str, parameter: str) -> str:
    found = next(e for e in model.library if e.name == effect)
    is_revolute = found.acts_on_joint() and model.is_revolute
    each = found.parameters(revolute=is_revolute)
    return next(p.unit for p in each if p.name == parameter)


def with_row(
    model: Joint,
    q: Array,
    segments: Sequence[Segment],
    added: Sequence[Place],
    numbers: Mapping[OfRig, float],
) -> tuple[Joint, str]:
    """Return *model* with the parameter row q, and why it is not valid, '' if it is.

    Constants are in the units in which *model* gives them. *added* are the places of the effects
    that a fit to *segments* added to the configured ones, and *numbers* are its results for load,
    transmission and mounting.

    Constants that were fitted in the recorded range may not give a valid muscle outside it. Then
    the contractions of the model are limited to the recorded range. Constants that are not valid
    there either, such as those of a force with the wrong sign, give the reason, and for drawings a
    valid joint between them and the nominal ones.
    """
    kinds = [{type(e): e for e in actuator.effects} for actuator in model.actuators]
    kinds_on_joint = {type(e): e for e in model.effects}
    for place in added:
        targets = [kinds[i] for i in place.muscles] or [kinds_on_joint]
        rows = [place.indices(model.layout, k) for k in range(len(place.parameters))]
        for n, target in enumerate(targets):
            target[place.effect] = place.effect(
                **{p.name: float(q[row[n]]) for p, row in zip(place.parameters, rows, strict=True)}
            )
    on_joint = tuple(kinds_on_joint.values())
    effects = [tuple(of_muscle.values()) for of_muscle in kinds]
    configured, nominal = model.parameters().ravel(), numbers_of(model)
    lengths = [_contractions(model, i, segments) for i in range(len(kinds))]
    nowhere: list[dict[str, float]] = [{} for _ in kinds]
    attempts = [(0.0, nowhere), *((back, lengths) for back in np.linspace(0.0, 1.0, 11).tolist())]
    problem = ''
    for back, limits in attempts:
        row = q + back * (configured - q)
        try:
            actuators = tuple(
                replace(actuator, muscle=_muscle(model, row, i, limits[i]), effects=effects[i])
                for i, actuator in enumerate(model.actuators)
            )
            there = {of: x + back * (nominal[of][0] - x) for of, x in numbers.items()}
            moved = changed(replace(model, actuators=actuators, effects=on_joint), there)
        except ParameterError as error:
            problem = problem or str(error)
            continue
        return moved, problem if back else ''
    plain = zip(model.actuators, effects, strict=True)
    actuators = tuple(replace(actuator, effects=own) for actuator, own in plain)
    return replace(model, actuators=actuators, effects=on_joint), problem


def _contractions(model: Joint, i: int, segments: Sequence[Segment]) -> dict[str, float]:
    """Return the limits of the contraction of muscle i at the recorded positions."""
    positions = np.concatenate([_positions(s) for s in segments])
    contraction = statics.contraction(model, i, positions)
    return {
        'kappa_min': min(0.0, float(contraction.min())),
        'kappa_max': max(0.01, float(contraction.max())),
    }


def _positions(segment: Segment) -> Array:
    """Return the recorded positions of a run; that of its start if only pressures were."""
    if isinstance(segment, HeldSegment):
        return segment.position
    return segment.target if segment.quantity == 'position' else np.array([segment.y0])


def _muscle(model: Joint, q: Array, i: int, changes: dict[str, float]) -> Muscle:
    """Return muscle number i with its constants from the row q."""
    muscle, constant = model.muscles[i], model.layout.constant
    a1, a2, a3, a4, a5, a6 = (float(q[constant(a, i)]) for a in range(at.A1, at.A6 + 1))
    source = from_si((a1, a2, a3, a4, a5, a6), muscle.pressure_unit, muscle.contraction_unit)
    values: dict[str, Any] = {**dict(zip(CONSTANTS, source, strict=True)), **changes}
    return replace(muscle, **values, zeta=float(q[constant(at.ZETA, i)]))
