# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of a load, of a transmission and of the muscles' mounting, with other values."""

from collections.abc import Mapping
from dataclasses import dataclass, is_dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import ParameterError
from pam_ros.parameters import Parameter, described
from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.joint import CONTRACTION, Joint
from pam_ros.rig.layout import fill_load

Array = NDArray[np.float64]
LOAD, TRANSMISSION, MOUNTING = 'load', 'transmission', 'mounting'


@dataclass(frozen=True)
class OfRig:
    """A number of the load or of the transmission, or how a muscle is mounted.

    *part* is LOAD, TRANSMISSION or MOUNTING, and *name* that of the parameter in a file: the field
    of the load or of the transmission, or ``contraction_1`` of the muscle with the number 0.
    """

    name: str
    part: str
    muscle: int = 0


def numbers_of(joint: Joint) -> dict[OfRig, tuple[float, Parameter]]:
    """Return all these numbers of *joint*, with their values and descriptions."""
    found: dict[OfRig, tuple[float, Parameter]] = {}
    for name, part in ((LOAD, joint.load), (TRANSMISSION, joint.transmission)):
        fields = described(type(part)) if is_dataclass(part) else {}
        for field, (kind, _, about) in fields.items():
            if kind is float:
                found[OfRig(field, name)] = getattr(part, field), about
    if not statics.is_direct(joint):
        for i, actuator in enumerate(joint.actuators):
            one = OfRig(f'contraction_{i + 1}', MOUNTING, i)
            found[one] = actuator.contraction, CONTRACTION
    return found


def given_numbers(joint: Joint, numbers: Mapping[str, float]) -> dict[OfRig, float]:
    """Return the *numbers* of the rig that a recording states by name.

    Raises ParameterError for a name that is not one of *joint*.
    """
    known = {of.name: of for of in numbers_of(joint)}
    for name in numbers:
        if name not in known:
            raise ParameterError(
                f'{name} cannot differ between recordings of this joint: it can be one of '
                f'{", ".join(known)}'
            )
    return {known[name]: value for name, value in numbers.items()}


def joint_with(joint: Joint, numbers: Mapping[str, float]) -> Joint:
    """Return *joint* with the *numbers* that a recording states by name.

    Raises ParameterError for a name that is not one of *joint*, and for a value that is not
    allowed.
    """
    return changed(joint, given_numbers(joint, numbers)) if numbers else joint


def fill(q: Array, joint: Joint, values: Mapping[OfRig, float]) -> None:
    """Write *joint* with other *values* into its parameter matrix q, without changing effects."""
    fill_load(
        q[at.JOINT],
        joint.layout,
        _part(joint.load, LOAD, values),
        _part(joint.transmission, TRANSMISSION, values),
    )
    for of, value in values.items():
        if of.part == MOUNTING:
            q[at.MUSCLE + of.muscle, at.AT_ZERO] = value * joint.muscles[of.muscle].l0


def changed(joint: Joint, values: Mapping[OfRig, float]) -> Joint:
    """Return *joint* with other *values*; raises ParameterError if the joint is not valid."""
    actuators = list(joint.actuators)
    for of, value in values.items():
        if of.part == MOUNTING:
            actuators[of.muscle] = replace(actuators[of.muscle], contraction=value)
    return replace(
        joint,
        actuators=tuple(actuators),
        load=_part(joint.load, LOAD, values),
        transmission=_part(joint.transmission, TRANSMISSION, values),
    )


def _part(part: Any, name: str, values: Mapping[OfRig, float]) -> Any:
    """Return a load or a transmission, the *part* of this *name*, with those *values* for it."""
    own = {of.name: value for of, value in values.items() if of.part == name}
    return replace(part, **own) if own else part
