# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The meaning of columns and topics with other names: ``SOURCE=TARGET[*SCALE][+OFFSET]``.

SOURCE is a column of a CSV file, or a topic with the field of its message (``/cell/wrench.
wrench.force.z``). TARGET is a quantity with its unit, named like the package's own columns
(``force_N``), or ``ignore``. SCALE and OFFSET convert the number of the source to the unit of the
target: ``adc=force_N*0.392-4.1786``. A YAML file contains the same strings, as a mapping under
``columns``: ``adc: force_N*0.392-4.1786``.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from pam_ros.arguments import as_path, sequence
from pam_ros.errors import ParameterError, RecordingError
from pam_ros.plain_yaml import read_yaml
from pam_ros.recording.quantities import QUANTITIES, Target, target_of

IGNORE = 'ignore'
UNUSED = '-'  # in a list of the names of columns: a column that is not used
_NUMBER = r'[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?'
_RULE = re.compile(
    rf'(?P<target>(?:[A-Za-z]\w*\.)?[^\W\d][\w/°]*)\s*(?:\*\s*(?P<scale>{_NUMBER}))?\s*'
    rf'(?P<offset>[+-]\s*(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)?'
)


@dataclass(frozen=True)
class Meaning:
    """The meaning of a source's number x: (x * scale + offset) in the target's unit."""

    target: Target
    scale: float = 1.0
    offset: float = 0.0

    @property
    def to_si(self) -> tuple[float, float]:
        """Return (factor, offset) that convert the source's number to SI."""
        factor = self.target.factor
        return self.scale * factor, self.offset * factor + self.target.offset


@dataclass(frozen=True)
class ColumnMapping:
    """Source -> meaning; None for a source that is to be ignored."""

    meanings: Mapping[str, Meaning | None] = field(default_factory=dict)

    def __contains__(self, source: str) -> bool:
        """Return whether the user has given a meaning for *source*."""
        return source in self.meanings

    def __iter__(self) -> Iterator[str]:
        """Iterate over the sources."""
        return iter(self.meanings)

    def meaning(self, source: str) -> Meaning | None:
        """Return the meaning of *source*: the one that the user gave, else that of its name.

        None if it is ignored or its name is not known. Raises RecordingError for an unknown or
        missing unit.
        """
        if source in self.meanings:
            return self.meanings[source]
        target = target_of(source)
        return None if target is None else Meaning(target)

    def need(self, sources: Sequence[str], where: str) -> None:
        """Raise RecordingError when a mapped source is not among *sources*."""
        for source in self.meanings:
            if source not in sources:
                raise RecordingError(
                    f'{where} has no {source!r}, which a column mapping names: it has '
                    + ', '.join(repr(name) for name in sources)
                )


def read_mapping(rules: Sequence[str] = (), file: str | Path | None = None) -> ColumnMapping:
    """Return the mapping of a YAML file, overridden by the *rules* of the command line.

    Raises RecordingError for a file that cannot be read and for a rule that is not valid, and
    ParameterError for arguments of a wrong type.
    """
    rules = sequence('rules', rules, str, "a text such as 'adc=force_N*0.392'")
    meanings: dict[str, Meaning | None] = {}
    if file is not None:
        for source, text in _read_yaml(as_path('file', file, 'the path of a YAML file')).items():
            meanings[source] = _meaning(source, text)
    for rule in rules:
        source, equals, text = rule.rpartition('=')
        if not equals or not source.strip():
            raise RecordingError(
                f'column mapping {rule!r} is not understood: give SOURCE=TARGET[*SCALE][+OFFSET], '
                "such as 'motor_voltage_V=pressure_command_Pa' or 'adc=force_N*0.392-4.18'"
            )
        meanings[source.strip()] = _meaning(source.strip(), text)
    return ColumnMapping(meanings)


def column_names(text: str) -> tuple[str, ...]:
    """Return the names in a text such as ``t_s,-,position_mm``, in their order.

    Raises RecordingError if one is empty.
    """
    names = tuple(name.strip() for name in text.split(','))
    if not all(names):
        raise RecordingError(
            f'--columns {text} has an empty name: give a name for each column, and {UNUSED} for '
            'one that is not used, such as t_s,pressure_kPa,-,position_mm'
        )
    return names


def _meaning(source: str, text: str) -> Meaning | None:
    text = text.strip()
    if text == IGNORE:
        return None
    match = _RULE.fullmatch(text)
    target = target_of(match['target']) if match else None
    if match is None or target is None:
        known = ', '.join(
            str(Target(name, next(iter(quantity.units)))) for name, quantity in QUANTITIES.items()
        )
        raise RecordingError(
            f'{source}={text} is not understood: the target is one of {known} (other units as '
            f"well) or {IGNORE}, then *SCALE and +OFFSET where needed, such as 'force_N*0.4-4.2'"
        )
    offset = (match['offset'] or '0').replace(' ', '')
    return Meaning(target, float(match['scale'] or 1.0), float(offset))


def _read_yaml(file: Path) -> dict[str, str]:
    try:
        content = read_yaml(file)
    except ParameterError as error:
        raise RecordingError(f'column mapping {error}') from error
    columns = content.get('columns') if isinstance(content, dict) else None
    if not isinstance(columns, dict):
        raise RecordingError(
            f"column mapping {file} has no mapping 'columns': give lines such as "
            "'motor_voltage_V: pressure_command_Pa' beneath 'columns:'"
        )
    for source, text in columns.items():
        if not isinstance(source, str) or not isinstance(text, str):
            raise RecordingError(
                f'column mapping {file}: {source!r}: {text!r} is not understood: give a name '
                "and a target, such as 'motor_voltage_V: pressure_command_Pa'"
            )
    return columns
