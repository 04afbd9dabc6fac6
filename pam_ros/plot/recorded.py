# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The curves of a bag or of a CSV file."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.plot.panels import Curves
from pam_ros.plot.topics import TOPICS, Key, muscles_of, numbers
from pam_ros.recording.bag.decode import Topic
from pam_ros.recording.bag.source import BagSource, Message, open_bag
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.read import BAG_SUFFIXES
from pam_ros.recording.series import Series
from pam_ros.recording.table_file import read_table_file

Array = NDArray[np.float64]
# Columns of a CSV file by the topic that has the same quantity.
_COLUMNS = {
    'position': ('position', 'joint_states'),
    'angle': ('position', 'joint_states'),
    'contraction': ('contraction', 'joint_states'),
    'pressure_command': ('pressure', 'pressure_command'),
    'pressure': ('pressure', 'pressure'),
    'force': ('force', 'force'),
}


@dataclass(frozen=True, eq=False)
class RecordedCurves:
    """The curves of a recording, ``start`` and ``end`` in s, the unit of positions, and notes.

    The ``unit`` is m or rad, or '' if the recording does not contain it.
    """

    curves: Curves
    start: float
    end: float
    unit: str
    notes: tuple[str, ...]


def read(
    path: Path,
    namespace: str | None,
    mapping: ColumnMapping,
    columns: Sequence[str] = (),
    sheet: str | None = None,
    variable: str | None = None,
) -> RecordedCurves:
    """Return the curves of the recording at *path*: a rosbag2, one of its files, or a CSV file.

    Stamps of a bag are the times at which its recorder received the messages, relative to the
    first one. *namespace* selects one of several rigs in a bag; *mapping* gives the meaning of
    columns of a CSV file, and *columns* are their names if the file has none; *sheet* is one
    of a workbook, and *variable* one of a MATLAB file. Raises RecordingError if the recording
    cannot be read, or if nothing can be drawn.
    """
    if not path.exists():
        raise RecordingError(f'recording {path} does not exist')
    if path.is_dir() or path.suffix in BAG_SUFFIXES:
        for option, is_given in (
            ('--column', any(mapping)),
            ('--columns', bool(columns)),
            ('--sheet', sheet is not None),
            ('--variable', variable is not None),
        ):
            if is_given:
                raise RecordingError(
                    f'{option} is for CSV files, and {path} is a bag: leave it out'
                )
        return _read_bag(path, namespace)
    if not path.is_file():
        raise RecordingError(f'recording {path} is neither a file nor a folder')
    if namespace is not None:
        raise RecordingError(f'--namespace is for bags, and {path} is a CSV file: leave it out')
    return _read_table(path, read_table_file(path, mapping, columns, sheet, variable))


# Bags --------------------------------------------------------------------------------------


def _read_bag(path: Path, namespace: str | None) -> RecordedCurves:
    source = open_bag(path)
    found = _topics(path, source, namespace)
    messages: dict[str, list[Message]] = {full: [] for full in found}
    for message in source.messages(list(found)):
        messages[message.topic].append(message)
    origin = min((own[0].stamp for own in messages.values() if own), default=None)
    if origin is None:
        raise RecordingError(f'{path.name} has no message on {", ".join(found)}')
    samples: dict[Key, tuple[Array, Array]] = {}
    muscles: tuple[str, ...] = ()
    for full, own in messages.items():
        if own:
            samples |= _of_topic(path, source, found[full], own, origin)
            muscles = muscles_of(found[full], _decoded(path, source, own, 0)) or muscles
    end = max(float(t[-1]) for t, _ in samples.values()) if samples else 0.0
    return _recorded(path, Curves(samples, muscles), end, '', tuple(source.notes))


def _topics(path: Path, source: BagSource, namespace: str | None) -> dict[str, str]:
    """Return full name -> the package's own name of the topics to be drawn."""
    of_spaces: dict[str, dict[str, str]] = {}
    for full, topic in source.topics.items():
        for name, use in TOPICS.items():
            if full.endswith(f'/{name}') and topic.type == use.kind:
                of_spaces.setdefault(full.removesuffix(name).strip('/'), {})[full] = name
    if namespace is not None:
        of_spaces = {k: v for k, v in of_spaces.items() if k == namespace.strip('/')}
    if len(of_spaces) > 1:
        spaces = ', '.join(f'/{space}' for space in sorted(of_spaces))
        raise RecordingError(
            f'{path.name} has topics of several rigs, in the namespaces {spaces}: choose one with '
            '--namespace'
        )
    if not of_spaces:
        where = '' if namespace is None else f' in the namespace {namespace}'
        named = ', '.join(f'{name} ({one.type})' for name, one in sorted(source.topics.items()))
        raise RecordingError(
            f'{path.name} has none of the topics that are drawn{where}, such as joint_states '
            f'(sensor_msgs/msg/JointState): it has {named or "no topics"}'
        )
    return next(iter(of_spaces.values()))


def _decoded(path: Path, source: BagSource, messages: list[Message], number: int) -> object:
    message = messages[number]
    topic: Topic = source.topics[message.topic]
    try:
        return source.decode(topic, message.data)
    except RecordingError as error:
        where = f'{path.name}: {message.topic}, message {number + 1} of {len(messages)}'
        raise RecordingError(f'{where}: {error}') from error


def _of_topic(
    path: Path, source: BagSource, name: str, messages: list[Message], origin: int
) -> dict[Key, tuple[Array, Array]]:
    """Return the curves of one topic."""
    stamps = np.array([message.stamp - origin for message in messages], dtype=float) * 1e-9
    rows: dict[Key, list[tuple[float, float]]] = {}
    for i, t in enumerate(stamps):
        for key, value in numbers(name, _decoded(path, source, messages, i)):
            rows.setdefault(key, []).append((t, value))
    return {key: _finite(*np.array(own).T) for key, own in rows.items()}


def _finite(t: Array, value: Array) -> tuple[Array, Array]:
    kept = np.isfinite(value)
    return t[kept], value[kept]


# CSV files ---------------------------------------------------------------------------------


def _read_table(
    path: Path, table: tuple[dict[str, Series], list[str], list[str]]
) -> RecordedCurves:
    series, notes, header = table
    muscles = tuple(dict.fromkeys(name.partition('.')[0] for name in series if '.' in name))
    drawn = {key: one for name, one in series.items() if (key := _key(name, muscles))}
    if not drawn:
        raise RecordingError(
            f'{path.name} has no column that is drawn, such as position_mm or pressure_kPa: it '
            'has ' + ', '.join(header)
        )
    origin = min(float(one.t[0]) for one in drawn.values())
    samples = {key: _finite(one.t - origin, one.value) for key, one in drawn.items()}
    end = max(float(t[-1]) for t, _ in samples.values())
    unit = 'rad' if 'angle' in series else 'm'
    return _recorded(path, Curves(samples, muscles), end, unit, tuple(notes))


def _key(name: str, muscles: tuple[str, ...]) -> Key | None:
    muscle, _, quantity = name.rpartition('.')
    if quantity not in _COLUMNS:
        return None
    panel, topic = _COLUMNS[quantity]
    if topic == 'joint_states':
        return Key(panel, topic, quantity)
    return Key(
        panel, topic if not muscle else f'{topic}s', str(muscles.index(muscle)) if muscle else ''
    )


def _recorded(
    path: Path, curves: Curves, end: float, unit: str, notes: tuple[str, ...]
) -> RecordedCurves:
    kept = {key: one for key, one in curves.samples.items() if one[0].size}
    if not kept:
        raise RecordingError(f'{path.name} has no finite number that could be drawn')
    return RecordedCurves(Curves(kept, curves.muscles), 0.0, end or 1e-3, unit, notes)
