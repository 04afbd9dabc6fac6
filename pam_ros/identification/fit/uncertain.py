# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The accuracy of the nominal values: the priors of the unknowns of re-tuning.

The constants of a muscle differ between specimens of its type, and always have a prior. Masses and
lengths are measured, and are treated as exact, unless a user gives the standard deviation with
which they are known.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite, log1p

from pam_ros.arguments import instance, refuse
from pam_ros.errors import ParameterError
from pam_ros.identification.fit.of_rig import OfRig, numbers_of
from pam_ros.identification.fit.unknowns import Constant, Unknown, nominal_unknowns
from pam_ros.parameters import Parameter
from pam_ros.rig.joint import Joint

Spreads = Mapping[str, float | str]
ALLOWED = "a standard deviation above 0: in the parameter's unit, or as a share such as 50%"


def spread_unknowns(joint: Joint, muscles: Sequence[str], spreads: Spreads) -> list[Unknown]:
    """Return the unknowns of re-tuning: the constants of muscles, and those in *spreads*.

    *spreads* are standard deviations by the names of parameters, ``inertia`` or ``agonist.a3``: a
    number in the parameter's unit, or a share of the nominal value as a text, ``'50%'``. A
    constant's name without a muscle applies to all muscles. A parameter that cannot be negative
    has a normal prior of its logarithm.

    Raises ParameterError for a name that is not such a parameter, for a standard deviation that is
    not above 0, and for a share of 0.
    """
    instance('uncertain', spreads, Mapping, "standard deviations by name, {'inertia': '50%'}")
    found = nominal_unknowns(joint, muscles)
    numbers = numbers_of(joint)
    for name, given in spreads.items():
        constants = [k for k, one in enumerate(found) if name in _names(one)]
        own = [of for of in numbers if of.name == name]
        if not constants and not own:
            known = [one for k in found for one in _names(k)] + [of.name for of in numbers]
            raise ParameterError(
                f'the uncertain parameter {name} is not one that a recording of this joint can '
                f'determine: give one of {", ".join(dict.fromkeys(known))}'
            )
        for k in constants:
            found[k] = _constant(found[k], _deviation(name, given, 1.0, is_share=True))
        found += [_number(of, *numbers[of], given) for of in own]
    return found


def _names(unknown: Unknown) -> tuple[str, ...]:
    """Return the names of a constant of a muscle: its own, and that of all muscles."""
    if not isinstance(unknown.of, Constant):
        return ()
    return unknown.name, unknown.name.rpartition('.')[2]


def _constant(unknown: Unknown, share: float) -> Unknown:
    scale = log1p(share) if unknown.logarithmic else share * abs(unknown.base)
    return replace(unknown, scale=scale)


def _number(of: OfRig, value: float, about: Parameter, given: float | str) -> Unknown:
    """Return the number *of* a rig, whose nominal value is *value*, with its prior."""
    deviation = _deviation(of.name, given, value, is_share=False, unit=about.unit)
    low = -float('inf') if about.low is None else about.low
    high = float('inf') if about.high is None else about.high
    if low >= 0.0 and value > 0.0:
        scale = log1p(deviation / value)
        return Unknown(of, value, scale, max(low, 1e-6 * value), high, 1.0, logarithmic=True)
    return Unknown(of, value, deviation, low, high, 1.0)


def _deviation(
    name: str, given: float | str, value: float, *, is_share: bool, unit: str = ''
) -> float:
    """Return the standard deviation that is *given*, in the unit of *value*.

    With *is_share* only a share is allowed, since the unit of a constant depends on its source.
    """
    what = f'uncertain {name}'
    text = given.strip() if isinstance(given, str) else given
    allowed = 'a standard deviation above 0, as a share such as 10%' if is_share else ALLOWED
    in_share = isinstance(text, str) and text.endswith('%')
    try:
        number = float(str(text).rstrip('%'))
    except ValueError:
        refuse(what, given, allowed)
    if isinstance(given, bool) or not isfinite(number) or number <= 0.0:
        refuse(what, given, allowed)
    if is_share and not in_share:
        refuse(what, given, allowed)
    if not in_share:
        return number
    if value == 0.0:
        raise ParameterError(
            f'{what} = {given}: a share of a nominal value of 0 is 0; give the standard '
            f'deviation in {unit or "its unit"}'
        )
    return 0.01 * number * abs(value)
