# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Conversion of the constants a1..a6 from the units of their source to SI, and back.

``exp(a3 kappa)`` has no unit, so constants published for pressure in bar and contraction in
percent convert exactly: each is multiplied by powers of two factors, without a new fit.
"""

from pam_ros.errors import ParameterError

PRESSURE_UNITS = {'Pa': 1.0, 'kPa': 1e3, 'bar': 1e5}
CONTRACTION_UNITS = {'fraction': 1.0, 'percent': 0.01}
Constants = tuple[float, float, float, float, float, float]
CONSTANTS = ('a1', 'a2', 'a3', 'a4', 'a5', 'a6')  # their names, also as parameters

# Exponents of "per unit of pressure" and "per unit of contraction" in the unit of each constant.
_PER_PRESSURE = (1, 0, 0, 1, 1, 0)
_PER_CONTRACTION = (0, 0, 1, 1, 0, 0)


def _scales(pressure_unit: str, contraction_unit: str) -> list[float]:
    if pressure_unit not in PRESSURE_UNITS:
        raise ParameterError(
            f'pressure_unit = {pressure_unit!r} is not known: give one of '
            + ', '.join(PRESSURE_UNITS)
        )
    if contraction_unit not in CONTRACTION_UNITS:
        raise ParameterError(
            f'contraction_unit = {contraction_unit!r} is not known: give one of '
            + ', '.join(CONTRACTION_UNITS)
        )
    p, kappa = PRESSURE_UNITS[pressure_unit], CONTRACTION_UNITS[contraction_unit]
    return [p**i * kappa**j for i, j in zip(_PER_PRESSURE, _PER_CONTRACTION, strict=True)]


def to_si(constants: Constants, pressure_unit: str, contraction_unit: str) -> Constants:
    """Return a1..a6 for p in Pa and kappa as a fraction.

    *constants* are those of (1) for p in *pressure_unit* and kappa in *contraction_unit*; the
    force is in N in both cases. Raises ParameterError for an unknown unit.
    """
    scales = _scales(pressure_unit, contraction_unit)
    a1, a2, a3, a4, a5, a6 = (a / s for a, s in zip(constants, scales, strict=True))
    return a1, a2, a3, a4, a5, a6


def from_si(constants: Constants, pressure_unit: str, contraction_unit: str) -> Constants:
    """Return SI constants in the units of their source: the inverse of :func:`to_si`."""
    scales = _scales(pressure_unit, contraction_unit)
    a1, a2, a3, a4, a5, a6 = (a * s for a, s in zip(constants, scales, strict=True))
    return a1, a2, a3, a4, a5, a6
