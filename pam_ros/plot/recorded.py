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
from pam_ros.plot.restarts import TopicTimes, one_after_another
from pam_ros.plot.topics import TOPICS, Key, muscles_of, numbers
from pam_ros.recording.bag.clocks import Samples, received_times, stamp_of, timed
from pam_ros.recording.bag.decode import Topic
from pam_ros.recording.bag.simulated_clock import clock_times, on_simulated_clock
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

    The time of a message in a bag is that of its header if it has one, as
    :func:`pam_ros.recording.bag.read.read_bag` reads it, relative to the first one. Where time
    goes back, the parts are one after another. *namespace* selects one of several rigs in a bag;
    *mapping* gives the meaning of columns of a CSV file, and *columns* are their names if the file
    has none; *sheet* is one of a workbook, and *variable* one of a MATLAB file. Raises
    RecordingError if the recording cannot be read, or if nothing can be drawn.
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
    if not any(messages.values()):
        raise RecordingError(f'{path.name} has no message on {", ".join(found)}')
    notes = list(source.notes)
    of_topics: dict[str, tuple[list[Key], Samples]] = {}
    muscles: tuple[str, ...] = ()
    for full, own in messages.items():
        if not own:
            continue
        keys, samples, names = _samples(path, source, found[full], own)
        if keys:
            of_topics[full] = keys, samples
            muscles = names or muscles
    stored = {full: samples for full, (_, samples) in of_topics.items()}
    every = on_simulated_clock(stored, clock_times(source), notes)
    commands = {full for full in every if TOPICS[found[full]].is_set_point}
    timed_topics, _ = timed(path.name, every, commands, 'header', notes)
    times, note = one_after_another(
        {
            full: TopicTimes(stored[full].received[one.kept], one.time)
            for full, one in timed_topics.items()
        }
    )
    origin = min((int(one.min()) for one in times.values()), default=0)
    curves: dict[Key, tuple[Array, Array]] = {}
    for full, time in times.items():
        kept = timed_topics[full].kept
        t = 1e-9 * (time - origin).astype(float)
        t, columns = _sorted(full, t, [one[kept] for one in every[full].columns], notes)
        for key, value in zip(of_topics[full][0], columns, strict=True):
            curves[key] = _finite(t, value)
    end = max((float(t[-1]) for t, _ in curves.values() if t.size), default=0.0)
    notes += [note] if note else []
    return _recorded(path, Curves(curves, muscles), end, '', tuple(notes))


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


def _samples(
    path: Path, source: BagSource, name: str, messages: list[Message]
) -> tuple[list[Key], Samples, tuple[str, ...]]:
    """Return the curves of one topic, their samples (NaN where one is missing), and muscles."""
    columns: dict[Key, list[float]] = {}
    stamped = np.zeros(len(messages), dtype=np.int64)
    muscles: tuple[str, ...] = ()
    for k in range(len(messages)):
        content = _decoded(path, source, messages, k)
        stamped[k] = stamp_of(content)
        muscles = muscles or muscles_of(name, content)
        row = dict(numbers(name, content))
        for key in row:
            columns.setdefault(key, [np.nan] * k)
        for key, column in columns.items():
            column.append(row.get(key, np.nan))
    values = [np.array(column) for column in columns.values()]
    present = [np.isfinite(value) for value in values]
    received = received_times(path.name, messages)
    return list(columns), Samples(received, stamped, values, present), muscles


def _sorted(
    full: str, t: Array, columns: list[Array], notes: list[str]
) -> tuple[Array, list[Array]]:
    """Return the samples of a topic in the order of time."""
    back = t[:-1] - t[1:]
    if not np.any(back > 0.0):
        return t, columns
    notes.append(
        f'{np.count_nonzero(back > 0.0)} of {t.size} messages of {full} are out of order by at '
        f'most {back.max():.3g} s: they are sorted by their stamps'
    )
    order = np.argsort(t, kind='stable')
    return t[order], [one[order] for one in columns]


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
