# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quantities of a recording, their units, and their largest plausible values."""

import re
from dataclasses import dataclass, replace
from math import pi

from pam_ros.errors import RecordingError

ATMOSPHERE = 101325.0  # Pa: messages have absolute pressures, a recording's are gauge
_TIME = {'s': 1.0, 'sec': 1.0, 'seconds': 1.0, 'ms': 1e-3, 'us': 1e-6, 'ns': 1e-9}
_TIME |= {'min': 60.0, 'h': 3600.0, 'days': 86400.0}
_PSI, _INCH, _KGF, _LBF = 6894.757293168, 0.0254, 9.80665, 4.4482216152605
_GAUGE = {'Pa': 1.0, 'hPa': 1e2, 'mbar': 1e2, 'kPa': 1e3, 'bar': 1e5, 'MPa': 1e6, 'psi': _PSI}
_GAUGE |= {'torr': ATMOSPHERE / 760.0, 'mmHg': 133.322387415, 'inHg': 3386.388640341}
_GAUGE |= {'atm': ATMOSPHERE, 'kgf_cm2': _KGF * 1e4, 'mmH2O': _KGF}
_GAUGE |= {f'{unit}g': _GAUGE[unit] for unit in ('kPa', 'bar', 'MPa', 'psi')}
_ABSOLUTE = {f'{unit}a': _GAUGE[unit] for unit in ('kPa', 'bar', 'MPa', 'psi')}
_PRESSURE = _GAUGE | _ABSOLUTE
_LENGTH = {'m': 1.0, 'cm': 1e-2, 'mm': 1e-3, 'um': 1e-6, 'in': _INCH, 'inch': _INCH}
_LENGTH |= {'inches': _INCH, '\N{MICRO SIGN}m': 1e-6, '\N{GREEK SMALL LETTER MU}m': 1e-6}
_FORCE = {'N': 1.0, 'kN': 1e3, 'kgf': _KGF, 'gf': 1e-3 * _KGF, 'lbf': _LBF}
_SPEED = {'m_s': 1.0, 'cm_s': 1e-2, 'mm_s': 1e-3, 'in_s': _INCH}
_CONTRACTION = {'fraction': 1.0, 'percent': 1e-2}
_ANGLE = {'rad': 1.0, 'mrad': 1e-3, 'deg': pi / 180.0, '°': pi / 180.0}
_TURN = {'rad_s': 1.0, 'deg_s': pi / 180.0, 'rpm': pi / 30.0}
SHOWN_UNITS = 7  # of a quantity in a message, those that are most common
# Units of a mass, which stand for the weight of this mass.
_WEIGHTS = {'kg': 'kgf', 'g': 'gf', 'lb': 'lbf', 'lbs': 'lbf'}


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

    @property
    def offset(self) -> float:
        """Return what is added to a value in SI: it makes an absolute pressure a gauge one."""
        return -ATMOSPHERE if self.unit in _ABSOLUTE else 0.0

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
                raise RecordingError(_unit_sentence(name, quantity, ''))
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
                raise RecordingError(_unit_sentence(name, quantity, word))
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


def _unit_sentence(name: str, quantity: str, unit: str) -> str:
    """Return the sentence on a column whose *unit* is missing ('') or not known."""
    angular = QUANTITIES[ANGULAR[quantity]].units if quantity in ANGULAR else {}
    every = [*QUANTITIES[quantity].units, *angular]
    units = ', '.join(every[:SHOWN_UNITS]) + (' and others' if len(every) > SHOWN_UNITS else '')
    target = Target(quantity, next(iter(QUANTITIES[quantity].units)))
    what, option = 'has no unit', f"'{name}={target}', if it is in {target.unit}"
    if unit:
        what = f'has the unit {unit!r}, which is not known'
        meant = _WEIGHTS.get(unit, '') if quantity == 'force' else ''
        option = f"'{name}={target}*FACTOR' and how many {target.unit} one {unit} is"
        option = f"'{name}={replace(target, unit=meant)}'" if meant else option
    return (
        f'{name!r} {what}: {quantity} is given in {units}; say what it is with '
        f"--column {option}, or leave it out with --column '{name}=ignore'"
    )
