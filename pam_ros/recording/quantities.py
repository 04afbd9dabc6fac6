# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quantities of a recording, their units, and their largest plausible values."""

import re
from dataclasses import dataclass, replace
from math import pi

from pam_ros.errors import RecordingError

ATMOSPHERE = 101325.0  # Pa: messages have absolute pressures, a recording's are gauge
_TIME = {'s': 1.0, 'sec': 1.0, 'seconds': 1.0, 'ms': 1e-3, 'us': 1e-6, 'ns': 1e-9}
_PRESSURE = {
    'Pa': 1.0,
    'hPa': 1e2,
    'mbar': 1e2,
    'kPa': 1e3,
    'bar': 1e5,
    'MPa': 1e6,
    'psi': 6894.757293168,
}
_LENGTH = {'m': 1.0, 'cm': 1e-2, 'mm': 1e-3, 'um': 1e-6}
_FORCE = {'N': 1.0, 'kN': 1e3}
_SPEED = {'m_s': 1.0, 'mm_s': 1e-3}
_CONTRACTION = {'fraction': 1.0, 'percent': 1e-2}
_ANGLE = {'rad': 1.0, 'deg': pi / 180.0}
_TURN = {'rad_s': 1.0, 'deg_s': pi / 180.0}


@dataclass(frozen=True)
class Quantity:
    """One signal: its units with their factors to SI, and its largest plausible value.

    ``si`` names the SI unit for messages. ``limit`` is in SI; above it the unit must be wrong.
    """

    name: str
    units: dict[str, float]
    si: str
    limit: float


QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity('time', _TIME, 's', float('inf')),
        Quantity('pressure_command', _PRESSURE, 'Pa', 1e7),
        Quantity('pressure', _PRESSURE, 'Pa', 1e7),
        Quantity('position', _LENGTH, 'm', 10.0),
        Quantity('contraction', _CONTRACTION, 'fraction', 1.0),
        Quantity('velocity', _SPEED, 'm/s', 100.0),
        Quantity('force', _FORCE, 'N', 1e6),
        Quantity('angle', _ANGLE, 'rad', 2.0 * pi),
        Quantity('angular_velocity', _TURN, 'rad/s', 1e3),
    )
}
# The quantities that replace position and velocity for a revolute joint (units of an angle).
ANGULAR = {'position': 'angle', 'velocity': 'angular_velocity'}
OF_MUSCLE = ('pressure_command', 'pressure', 'force')  # quantities of each muscle of a joint
# Spellings of the time axis without a unit; ROS and most loggers mean seconds.
_BARE_TIME = ('t', 'time')
OF_ONE = re.compile(r'(?P<muscle>[A-Za-z]\w*)\.(?P<rest>.+)')
_TIME_NAMES = ('t', 'time', 'timestamp', 'stamp', 'elapsed', 'elapsed_time')


def quantity_in(unit: str, name: str) -> Quantity:
    """Return the quantity called *name* if positions are in *unit*, m or rad."""
    return QUANTITIES[ANGULAR.get(name, name) if unit == 'rad' else name]


@dataclass(frozen=True)
class Target:
    """A quantity in a unit: the meaning of a column or of a field of a message.

    ``muscle`` is the name of the muscle of a joint to which it belongs, or empty.
    """

    quantity: str
    unit: str
    muscle: str = ''

    @property
    def key(self) -> str:
        """Return the name of the signal: ``pressure``, or ``agonist.pressure``."""
        return f'{self.muscle}.{self.quantity}' if self.muscle else self.quantity

    @property
    def factor(self) -> float:
        """Return the SI value of one unit."""
        return QUANTITIES[self.quantity].units[self.unit]

    def __str__(self) -> str:
        """Return the column name that has this meaning."""
        return f'{"t" if self.quantity == "time" else self.key}_{self.unit}'


def target_of(name: str) -> Target | None:
    """Return the meaning of a column called *name*, or None if it has none.

    ``position_mm``, ``position [mm]`` and ``Position (mm)`` are the same. The name of a muscle may
    precede a quantity that each muscle has: ``agonist.pressure_kPa``. Raises RecordingError for a
    known quantity without a unit or with an unknown unit.
    """
    match = OF_ONE.fullmatch(name.strip())
    if match:
        target = _target(name, match['rest'])
        is_own = target is not None and target.quantity in OF_MUSCLE
        return replace(target, muscle=match['muscle']) if target and is_own else None
    return _target(name, name)


def _target(name: str, rest: str) -> Target | None:
    """Return the meaning of *rest*, the *name* of a column without that of its muscle."""
    words = re.sub(r'[\s\[\](){},/]+', '_', rest.strip().replace('%', 'percent'))
    words = words.strip('_')
    if words.lower() in _BARE_TIME:
        return Target('time', 's')
    for quantity in sorted(QUANTITIES, key=len, reverse=True):
        for spelling in _TIME_NAMES if quantity == 'time' else (quantity,):
            if words.lower() == spelling:
                raise RecordingError(_unit_sentence(name, quantity, 'has no unit'))
            if not words.lower().startswith(spelling + '_'):
                continue
            word = words[len(spelling) + 1 :]
            unit = _unit(word, QUANTITIES[quantity].units)
            if unit is not None:
                return Target(quantity, unit)
            unit = _unit(word, _LENGTH)
            if quantity == 'contraction' and unit is not None:
                return Target('position', unit)
            angular = ANGULAR.get(quantity)
            unit = None if angular is None else _unit(word, QUANTITIES[angular].units)
            if angular is not None and unit is not None:
                return Target(angular, unit)
            # One further word is meant as a unit; several words are the name of another signal.
            if '_' not in word:
                raise RecordingError(
                    _unit_sentence(name, quantity, f'has the unit {word!r}, which is not known')
                )
    return None


def unit_in(word: str, quantity: str) -> str | None:
    """Return the unit of *quantity* that *word* spells, None if it is not a unit of it."""
    return _unit(word, QUANTITIES[quantity].units)


def _unit(word: str, units: dict[str, float]) -> str | None:
    if word in units:
        return word
    # MPa and mPa differ only in upper and lower case; no other units do.
    same = [unit for unit in units if unit.lower() == word.lower()]
    return same[0] if len(same) == 1 and word != 'mPa' else None


def _unit_sentence(name: str, quantity: str, what: str) -> str:
    angular = QUANTITIES[ANGULAR[quantity]].units if quantity in ANGULAR else {}
    units = ', '.join((*QUANTITIES[quantity].units, *angular))
    example = Target(quantity, next(iter(QUANTITIES[quantity].units)))
    return (
        f'{name!r} {what}: {quantity} is given in {units}; say what it is with '
        f"--column '{name}={example}', or leave it out with --column '{name}=ignore'"
    )
