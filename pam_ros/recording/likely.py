# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Likely meanings of columns with unknown names, for the message on missing signals.

These guesses are not used to read data: the user decides, with ``--column``.
"""

import re
import shlex
from collections.abc import Collection, Sequence

from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.quantities import (
    ATMOSPHERE,
    OF_MUSCLE,
    OF_ONE,
    QUANTITIES,
    Target,
    target_of,
    unit_in,
)

# Words that other programs use for the quantities, together with a unit of the quantity.
_WORDS = {
    'pressure': ('p', 'u', 'pres', 'press', 'pressure'),
    'position': (
        *('x', 'y', 'z', 's', 'l', 'pos', 'position', 'disp', 'displacement', 'stroke', 'travel'),
        *('length', 'contraction'),
    ),
    'contraction': ('contraction', 'kappa', 'strain'),
    'angle': ('q', 'pos', 'position', 'angle', 'theta', 'phi', 'joint'),
    'force': ('f', 'force', 'load', 'loadcell', 'pull', 'tension'),
    'time': ('t', 'time', 'timestamp', 'stamp', 'elapsed', 'clock'),
}
_COMMAND = {
    *('u', 'cmd', 'command', 'commanded', 'set', 'setpoint', 'sp', 'target'),
    *('ref', 'reference', 'des', 'desired', 'demand', 'input'),
}
_ABSOLUTE = {'abs', 'absolute'}
_WITH_UNIT = re.compile(
    r'(?P<stem>.+?)(?:\s*[\[(]\s*(?P<unit>[^\])]+?)\s*[\])]|_(?P<word>[^_\[\]()]+))'
)
MOST_COLUMNS = 12  # the most columns that a message lists


def found_columns(header: Sequence[str], mapping: ColumnMapping, known: Collection[str]) -> str:
    """Return a text with the columns of a file, and options with likely meanings of unknown ones.

    *known* are the signals that were read; no options are proposed for them. Columns that may have
    the same meaning are alternatives.
    """
    shown = ', '.join(repr(name) for name in header[:MOST_COLUMNS])
    more = f' and {len(header) - MOST_COLUMNS} more' if len(header) > MOST_COLUMNS else ''
    read = {*known, *map(_linear, known)}
    options: dict[str, list[str]] = {}
    for name in header:
        if name in mapping or mapping.meaning(name) is not None:
            continue
        target = likely_target(name)
        if target is not None and _linear(target.key) not in read:
            option = shlex.quote(f'{name}={_rule(name, target)}')
            options.setdefault(_linear(target.key), []).append(f'--column {option}')
    text = ' '.join(' or '.join(alike) for alike in options.values())
    said = f'its columns are {shown}{more}' + (f': say what they are with {text}' if text else '')
    return said if 'position' in read else said + _of_joints(header, mapping)


def may_have_output(header: Sequence[str], mapping: ColumnMapping) -> bool:
    """Return whether a column that is not read may be a position or a force."""
    likely = (
        likely_target(name)
        for name in header
        if name not in mapping and mapping.meaning(name) is None
    )
    return any(one and _linear(one.quantity) in ('position', 'force') for one in likely)


def _of_joints(header: Sequence[str], mapping: ColumnMapping) -> str:
    """Return a sentence on the columns that give positions of joints with names, if any."""
    named = [name for name in header if name not in mapping and _is_of_joint(name)]
    if not named:
        return ''
    plain = named[0].partition('.')[2]
    option = shlex.quote(f'{named[0]}={plain}')
    return (
        f'. A recording is of one joint, and its position has no name: use {" or ".join(named)} '
        f'with --column {option}, and the commands of the muscles of that joint'
    )


def _is_of_joint(name: str) -> bool:
    """Return whether a column is a position with a name before it, such as left.position_rad."""
    match = OF_ONE.fullmatch(name.strip())
    target = target_of(match['rest']) if match else None
    return target is not None and target.quantity in ('position', 'angle')


def likely_target(name: str) -> Target | None:
    """Return the likely meaning of a column *name*, from a word and a unit; None if unknown."""
    of_muscle = OF_ONE.fullmatch(name)
    muscle, rest = (of_muscle['muscle'], of_muscle['rest']) if of_muscle else ('', name)
    match = _WITH_UNIT.fullmatch(rest.strip())
    if match is None:
        return None
    words = _words(match['stem'])
    for quantity, spellings in _WORDS.items():
        unit = unit_in((match['unit'] or match['word']).replace('%', 'percent'), quantity)
        if unit is None or words.isdisjoint(spellings):
            continue
        if muscle and quantity not in OF_MUSCLE:
            return None
        is_command = quantity == 'pressure' and not words.isdisjoint(_COMMAND)
        return Target('pressure_command' if is_command else quantity, unit, muscle)
    return None


def _words(stem: str) -> set[str]:
    """Return the words of a name without its digits: p1, pCmd and p_cmd contain the word p."""
    parts = re.split(r'[^A-Za-z]+', re.sub(r'([a-z])([A-Z])', r'\1_\2', stem))
    return {part.lower() for part in parts if part}


def _linear(key: str) -> str:
    """Return the signal to which an angle or a contraction is converted, else *key*."""
    return 'position' if key in ('angle', 'contraction') else key


def _rule(name: str, target: Target) -> str:
    """Return the right side of the option; an absolute pressure is converted to gauge."""
    is_pressure = target.quantity in ('pressure', 'pressure_command')
    if is_pressure and not target.offset and _words(name) & _ABSOLUTE:
        return f'{target}-{ATMOSPHERE / QUANTITIES[target.quantity].units[target.unit]:g}'
    return str(target)
