# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The stiffness of a joint, and the pressures of two muscles for it, in closed form.

As in :mod:`pam_ros.rig.statics`, all of it is the nominal model. Desired values of stiffness and
effort give two linear equations for the two pressures.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from pam_ros.arguments import array, instance, number, one_each
from pam_ros.errors import RangeError
from pam_ros.rig import pair, statics
from pam_ros.rig.joint import Joint


def joint_stiffness(joint: Joint, p: ArrayLike, s: ArrayLike) -> Any:
    """Return the stiffness of the joint at s by its muscles, without that of gravity.

    p: gauge Pa, (muscles,) or one number for all. s: m or rad, a number or an array; the result
    in N/m or N m/rad has the same shape. Raises ParameterError for a p of another shape, for
    numbers that are not finite, and for an s that the muscles cannot have.
    """
    muscles = len(instance('joint', joint, Joint, 'a Joint').actuators)
    places = array('s', s)
    for end in (places.min(), places.max()) if places.size else ():
        statics.refuse_position('s', float(end), joint)
    return statics.stiffness(joint, one_each('p', p, muscles, 'muscle'), places)


def co_contraction_pressures(
    joint: Joint, s: float, stiffness: float, effort: float | None = None
) -> tuple[float, float]:
    """Return the pressures at which two muscles give *effort* and *stiffness* at s.

    The default effort holds the load there. Raises RangeError if the stiffness is outside
    :func:`joint_stiffness_range`, and the errors of that function.
    """
    low, high = joint_stiffness_range(joint, s, effort)
    number('stiffness', stiffness)
    geometry = joint.transmission.equations
    if not low * (1.0 - 1e-9) <= stiffness <= high * (1.0 + 1e-9):
        raise RangeError(
            f'a stiffness of {stiffness:.6g} {geometry.effort_unit}/{geometry.unit} at '
            f'{s:.4g} {geometry.unit} is out of reach: {low:.6g} to {high:.6g} is possible there'
        )
    tau = float(statics.weight(joint, s)) if effort is None else effort
    return pair.pressures(_line(joint, 0, s), _line(joint, 1, s), tau, stiffness)


def joint_stiffness_range(
    joint: Joint, s: float, effort: float | None = None
) -> tuple[float, float]:
    """Return the least and the greatest stiffness with which two muscles give *effort* at s.

    The default effort holds the load there. Within the range no muscle pushes (its force is at
    least 0), and the pressures are within p_min and p_max. Raises RangeError in three cases: there
    is no such pair of pressures; the effort determines the stiffness, as for two equal muscles in
    parallel; the joint does not have two muscles. Raises ParameterError for numbers that are not
    finite and for an s that the muscles cannot have.
    """
    instance('joint', joint, Joint, 'a Joint')
    statics.refuse_position('s', number('s', s), joint)
    if effort is not None:
        number('effort', effort)
    if len(joint.muscles) != 2:
        raise RangeError(
            f'a stiffness can be chosen for two muscles: this joint has {len(joint.muscles)}'
        )
    one, two = _line(joint, 0, s), _line(joint, 1, s)
    tau = float(statics.weight(joint, s)) if effort is None else effort
    geometry = joint.transmission.equations
    unit = f'{tau:.4g} {geometry.effort_unit} at {s:.4g} {geometry.unit}'
    if pair.is_settled(one, two):
        raise RangeError(f'an effort of {unit} determines the stiffness: it cannot be chosen')
    within = _limits(joint, 0, one), _limits(joint, 1, two)
    low, high = pair.piece(one, two, tau, within)
    if low > high:
        raise RangeError(
            f'an effort of {unit} is out of reach: there are no pressures within p_min and '
            'p_max that give it without a muscle that pushes'
        )
    k1, k2 = sorted(pair.stiffness_at(one, two, tau, p) for p in (low, high))
    return k1, k2


def _line(joint: Joint, i: int, s: float) -> pair.Line:
    """Return effort and stiffness of muscle i at s as functions of its pressure."""
    return pair.Line(*(float(number) for number in statics.line(joint, i, s)))


def _limits(joint: Joint, i: int, line: pair.Line) -> pair.Limits:
    """Return the least pressure of muscle i at which it does not push, and its greatest one."""
    m = joint.muscles[i]
    return max(m.p_min, line.slack), m.p_max
