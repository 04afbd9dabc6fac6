# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values with units as a person types them: ``300kPa``, ``60mm``, ``20deg``, ``0.06``."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from pam_ros.errors import PamError
from pam_ros.recording.quantities import QUANTITIES, SHOWN_UNITS, Target, unit_in

AMOUNT = re.compile(r'([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)')
# The quantity whose units convert to each SI unit.
QUANTITY_OF = {
    'Pa': 'pressure_command',
    'm': 'position',
    'rad': 'angle',
    's': 'time',
    'N': 'force',
    'm/s': 'velocity',
    'rad/s': 'angular_velocity',
}
EXAMPLES = {'Pa': '300e3, 300kPa or 3bar', 'm': '0.06 or 60mm', 'rad': '0.35 or 20deg'}


@dataclass(frozen=True)
class Amount:
    """A value in SI, gauge if it is a pressure; ``text`` is what was typed.

    ``unit`` is the SI unit to which the typed unit belongs, '' if none was typed.
    """

    value: float
    unit: str
    text: str


def amount_of(text: str, units: Sequence[str], what: str) -> Amount:
    """Return the value that *text* gives, in one of the SI *units*.

    A number without a unit is in SI. *what* names the value in messages. Raises PamError for a
    text that is not a finite number, and for a unit that does not belong to *units*.
    """
    text = text.strip()
    match = AMOUNT.fullmatch(text)
    if match is None or not isfinite(float(match[1])):
        examples = [EXAMPLES[unit] for unit in units if unit in EXAMPLES]
        such = f', such as {" or ".join(examples)}' if examples else ''
        raise PamError(f'{what} {text!r} is not a finite number with or without a unit{such}')
    number, word = float(match[1]), match[2].strip()
    if not word:
        return Amount(number, '', text)
    for unit in units:
        value = _converted(number, word, unit)
        if value is not None:
            return Amount(value, unit, text)
    known = ', '.join(filter(None, map(_units_text, units)))
    raise PamError(
        f'{what} {text!r}: {word!r} is not a unit of it: give {known or "a number without a unit"}'
    )


def _converted(number: float, word: str, unit: str) -> float | None:
    """Return *number* of the unit *word* in the SI *unit*, None if they do not belong together."""
    if unit and _plain(word) == _plain(unit):
        return number
    quantity = QUANTITY_OF.get(unit)
    found = None if quantity is None else unit_in(word.replace('/', '_'), quantity)
    if quantity is None or found is None:
        return None
    target = Target(quantity, found)
    return number * target.factor + target.offset


def _plain(unit: str) -> str:
    """Return a unit without spaces and signs of multiplication."""
    return re.sub(r'[\s*·]', '', unit)


def _units_text(unit: str) -> str:
    """Return the most common units of an SI unit for a message."""
    if unit not in QUANTITY_OF:
        return _plain(unit)
    names = [name.replace('_', '/') for name in QUANTITIES[QUANTITY_OF[unit]].units]
    return ', '.join(names[:SHOWN_UNITS])


def joined(words: Sequence[str]) -> list[str]:
    """Return *words* with each unit joined to the number before it: 300 kPa is 300kPa."""
    found: list[str] = []
    for word in words:
        before = AMOUNT.fullmatch(found[-1].rpartition(':=')[2].strip()) if found else None
        is_unit = AMOUNT.fullmatch(word.strip()) is None and ':=' not in word
        if before is not None and not before[2] and is_unit:
            found[-1] += word
        else:
            found.append(word)
    return found
