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
from pam_ros.identification.data.segment import HeldSegment, Segment
from pam_ros.identification.fit.unknowns import CONSTANTS, OfEffect, Unknown
from pam_ros.identification.result import Estimate
from pam_ros.muscle.constants import Constants, from_si
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint, changed

Array = NDArray[np.float64]


def in_source_units(
    unknown: Unknown, sides: list[float], model: Joint, at_bound: bool
) -> Estimate:
    """Return the estimate of a parameter, in the unit in which *model* gives it.

    *sides* are the low end of its interval, its value and the high end, in SI.
    """
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


def with_row(model: Joint, q: Array, segments: Sequence[Segment], effects: Sequence[str]) -> Joint:
    """Return *model* with the parameter row q: constants in the units in which it gives them.

    *effects* are the names of those that a fit to *segments* added to the declared ones. Constants
    that were fitted where the rig went may make no muscle beyond: then the model's contraction is
    limited to where it went, and in the last resort its constants are taken back towards those
    declared until they make a muscle.
    """
    values = {name: dict(given) for name, given in model.all_effects.items()}
    for effect in model.library:
        if effect.name in effects:
            values[effect.name] = {
                p.name: float(q[model.layout.index(effect, k)])
                for k, p in enumerate(effect.parameters)
            }
    went = np.concatenate(
        [s.position if isinstance(s, HeldSegment) else s.target for s in segments]
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
