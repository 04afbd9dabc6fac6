# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The units of a revolute joint that correspond to those of a prismatic joint.

A force becomes a torque, and a length along the motion becomes an angle.
"""

import re

from pam_ros.errors import ParameterError

REVOLUTE = {
    'm': 'rad',
    'm/s': 'rad/s',
    'm/s^2': 'rad/s^2',
    'm/s^3': 'rad/s^3',
    'N': 'N m',
    'N/s': 'N m/s',
    'N^2': 'N^2 m^2',
    'N/m': 'N m/rad',
    'N/(m s)': 'N m/(rad s)',
    'N s/m': 'N m s/rad',
    'N/Pa': 'N m/Pa',
    's/m': 's/rad',
    'Pa/m': 'Pa/rad',
    'Pa/(m s)': 'Pa/(rad s)',
    'Pa s/m': 'Pa s/rad',
    # A contraction describes a position: it becomes the angle itself.
    'fraction': 'rad',
    # These units do not depend on the coordinate.
    '': '',
    'kg': 'kg',
    's': 's',
    '1/s': '1/s',
    'rad/s': 'rad/s',
    'Hz': 'Hz',
    'Pa': 'Pa',
    'Pa/s': 'Pa/s',
    'fraction of l0': 'fraction of l0',
}

# A value in this unit is multiplied by this power of the arm in m; other units have the power 0.
ARM_POWER = {
    'm': -1,
    'm/s': -1,
    'm/s^2': -1,
    'm/s^3': -1,
    'N': 1,
    'N/s': 1,
    'N/m': 2,
    'N/(m s)': 2,
    'N s/m': 2,
    'N/Pa': 1,
    's/m': 1,
    'Pa/m': 1,
    'Pa/(m s)': 1,
    'Pa s/m': 1,
}


def powers(unit: str) -> dict[str, int]:
    """Return the power of each symbol in a *unit*: N 1, s 1, m -2 of ``N s/m^2``."""
    above, _, below = unit.partition('/')
    found: dict[str, int] = {}
    for sign, part in ((1, above), (-1, below)):
        for symbol, power in re.findall(r'([A-Za-z]+)(?:\^(\d+))?', part):
            found[symbol] = found.get(symbol, 0) + sign * int(power or 1)
    return found


def revolute_unit(unit: str, whose: str) -> str:
    """Return *unit* as it is for a revolute joint; raises ParameterError if it is not known.

    *whose* is the name of the parameter that has the unit.
    """
    if unit not in REVOLUTE:
        raise ParameterError(
            f'{whose} is in {unit}: the unit for a revolute joint is not known; add the '
            'unit to REVOLUTE in pam_ros/units.py'
        )
    return REVOLUTE[unit]
