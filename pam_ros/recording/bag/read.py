# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a rig in a rosbag2: their names, the meaning of their fields, and their clock."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.bag.clocks import Samples, received_times, stamp_of, timed
from pam_ros.recording.bag.decode import Topic
from pam_ros.recording.bag.simulated_clock import clock_times, on_simulated_clock
from pam_ros.recording.bag.source import BagSource, Message, bag_files, open_bag
from pam_ros.recording.bag.topics import OwnTopics, own_topics
from pam_ros.recording.bag.values import FieldReader
from pam_ros.recording.mapping import ColumnMapping, Meaning
from pam_ros.recording.quantities import Target
from pam_ros.recording.series import GAP_SECONDS, Series

__all__ = ['bag_files', 'read_bag']

_JOINT = re.compile(r'\[[^\]]+\]$')
SWAPPED = 0.01  # share of the messages of a topic that may be out of order
_OUTPUTS = ('position', 'angle', 'contraction', 'force')
_UNFILLED = ('velocity', 'angular_velocity', 'force')  # 0 in messages that do not fill them


class _Field(NamedTuple):
    """A number in the messages of a topic."""

    topic: str
    path: str
    meaning: Meaning
    is_required: bool  # by the user; then it must have values


def read_bag(
    path: Path,
    mapping: ColumnMapping,
    namespace: str | None = None,
    muscles: Sequence[str] = (),
    unit: str | None = None,
    time: str = 'header',
) -> tuple[dict[str, Series], list[str]]:
    """Return (signal -> series in SI, warnings) of the rosbag2 at *path*.

    The topics ``pressure_command``, ``joint_states``, ``force`` and ``pressure`` are read, in any
    namespace if there is one rig in the bag, else in *namespace*. Those of a joint are
    ``pressure_commands``, ``joint_states`` in *unit* (m or rad) and ``pressures``; the arrays have
    a number for each of its *muscles*. The sources of *mapping* are read in addition. They are
    topics with the field: ``/valve/state.pressure`` (``.data`` if no field is given), with an
    index or the name of a joint for arrays: ``/joint_states.position[elbow]``. Messages without
    this joint are not used, and the velocity and effort of that topic are those of this joint.

    The stamp of a message is that of its header if it has one, else the time of its receipt, in
    simulated time if the headers are, see
    :func:`pam_ros.recording.bag.simulated_clock.on_simulated_clock`. If the two clocks differ, or
    if *time* is ``received``, all messages get the time of their receipt, see
    :func:`pam_ros.recording.bag.clocks.timed`. Pressures in FluidPressure are
    absolute; 101325 Pa are subtracted to make them gauge pressures.

    Raises RecordingError for topics that are missing, ambiguous, or of an unknown type.
    """
    source = open_bag(path)
    ours = own_topics(muscles, unit)
    fields = _fields(path, source, mapping, namespace, ours)
    samples = _read(path, source, fields)
    notes = list(source.notes)
    if time == 'header':
        samples = on_simulated_clock(samples, clock_times(source), notes)
    commands = {f.topic for f in fields if f.meaning.target.quantity == 'pressure_command'}
    times, origin = timed(path.name, samples, commands, time, notes)
    series: dict[str, Series] = {}
    for topic, one in samples.items():
        stamps, kept, is_received = times[topic]
        t = 1e-9 * (stamps - origin).astype(float)
        own = [field for field in fields if field.topic == topic]
        for field, column, present in zip(own, one.columns, one.present, strict=True):
            value, is_of = column[kept], present[kept]
            _add(series, path, field, t[is_of], value[is_of], is_received, notes)
    return series, notes


def _fields(
    path: Path,
    source: BagSource,
    mapping: ColumnMapping,
    namespace: str | None,
    ours: OwnTopics,
) -> list[_Field]:
    """Return the fields to read, those of the user first: they replace those of the package."""
    fields = []
    for name in mapping:
        topic, _, field = name.partition('.')
        if topic not in source.topics:
            raise RecordingError(
                f'{path.name} has no topic {topic!r}, which a column mapping names: it has '
                + _named(source)
            )
        meaning = mapping.meaning(name)
        if meaning is not None and meaning.target.quantity == 'time':
            raise RecordingError(f'{name}: the time in a bag is that of its messages')
        if meaning is not None:
            fields.append(_Field(topic, field or 'data', meaning, is_required=True))
    # The joint that the user has chosen in a topic is that of the other fields, too.
    joints = {field.topic: match[0] for field in fields if (match := _JOINT.search(field.path))}
    given = {field.meaning.target.key for field in fields}
    given |= {'position'} if 'contraction' in given else set()
    found = {
        name: topic
        for name in ours
        for topic in (_find(path, source, name, mapping, namespace),)
        if topic is not None
    }
    for name, topic in found.items():
        known = ours[name].get(source.topics[topic].type)
        if known is None:
            if {m.target.key for types in ours[name].values() for m in types.values()} <= given:
                continue
            raise RecordingError(
                f'{path.name}: {topic} is a {source.topics[topic].type}, not a '
                f'{" or ".join(ours[name])}: say which field it is with --column '
                f"'{topic}.FIELD={_example(ours[name])}', or --column '{topic}=ignore'"
            )
        for field, meaning in known.items():
            if field == 'effort' and 'force' in found:
                continue
            if meaning.target.key not in given and f'{topic}.{field}' not in mapping:
                chosen = f'{field}{joints.get(topic, "")}'
                fields.append(_Field(topic, chosen, meaning, is_required=False))
    if not any(f.meaning.target.quantity in _OUTPUTS for f in fields):
        states, force = (_full_name(name, namespace) for name in ('joint_states', 'force'))
        lacks = f'neither {states} nor {force}' if 'force' in ours else f'no {states}'
        raise RecordingError(f'{path.name} has {lacks}: it has {_named(source)}')
    return fields


def _full_name(name: str, namespace: str | None) -> str:
    """Return the name of a topic of the package, with the namespace if one was asked for."""
    return name if namespace is None else f'/{namespace.strip("/")}/{name}'.replace('//', '/')


def _find(
    path: Path, source: BagSource, name: str, mapping: ColumnMapping, namespace: str | None
) -> str | None:
    """Return the full name of the package's topic *name* in the bag, or None if it is missing."""
    found = [
        topic
        for topic in source.topics
        if topic.rsplit('/', 1)[-1] == name and topic not in mapping
    ]
    if namespace is not None:
        full = _full_name(name, namespace)
        return full if full in found else None
    if len(found) > 1:
        spaces = ', '.join(topic.rsplit('/', 1)[0] or '/' for topic in sorted(found))
        raise RecordingError(
            f'{path.name} has {name} of several rigs, in the namespaces {spaces}: choose one '
            'with --namespace'
        )
    return found[0] if found else None


def _read(path: Path, source: BagSource, fields: list[_Field]) -> dict[str, Samples]:
    """Return the samples of each topic that has messages."""
    messages: dict[str, list[Message]] = {field.topic: [] for field in fields}
    for message in source.messages(list(messages)):
        messages[message.topic].append(message)
    return {
        topic: _samples(path, source, [f for f in fields if f.topic == topic], found)
        for topic, found in messages.items()
        if found
    }


def _samples(
    path: Path, source: BagSource, fields: list[_Field], messages: list[Message]
) -> Samples:
    """Return the *fields* of the *messages* of one topic."""
    received = received_times(path.name, messages)
    topic: Topic = source.topics[fields[0].topic]
    readers = [FieldReader(path.name, field.topic, field.path) for field in fields]
    stamped = np.zeros_like(received)
    columns = [np.empty(received.size) for _ in fields]
    present = [np.ones(received.size, dtype=bool) for _ in fields]
    for k, message in enumerate(messages):
        try:
            content = source.decode(topic, message.data)
        except RecordingError as error:
            where = f'{path.name}: {fields[0].topic}, message {k + 1} of {len(messages)}'
            raise RecordingError(f'{where}: {error}') from error
        stamped[k] = stamp_of(content)
        for column, is_of, reader in zip(columns, present, readers, strict=True):
            found = reader.read(content)
            is_of[k] = found is not None
            column[k] = np.nan if found is None else found
    for reader in readers:
        reader.check()
    used = np.any(present, axis=0)
    columns, present = [one[used] for one in columns], [one[used] for one in present]
    return Samples(received[used], stamped[used], columns, present)


def _add(
    series: dict[str, Series],
    path: Path,
    field: _Field,
    t: NDArray[np.float64],
    value: NDArray[np.float64],
    is_received: bool,
    notes: list[str],
) -> None:
    """Add one field's series, unless the field was never filled."""
    source = field.topic if field.path == 'data' else f'{field.topic}.{field.path}'
    key, quantity = field.meaning.target.key, field.meaning.target.quantity
    filled = value[~np.isnan(value)]
    if filled.size == 0 or (quantity in _UNFILLED and not filled.any()):
        if field.is_required:
            raise RecordingError(f'{path.name}: {source} has no values')
        return
    if key in series:
        notes.append(f'{source} is not used: {series[key].source} gives the {key}')
        return
    factor, offset = field.meaning.to_si
    value = value * factor + offset
    t, value = _in_order(source, t, value, notes)
    series[key] = Series.taken(path.name, source, t, value, is_received)


def _in_order(
    source: str, t: NDArray[np.float64], value: NDArray[np.float64], notes: list[str]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return samples sorted by their stamps, if few are out of order, and by little.

    Two threads of a driver can exchange two messages. A clock that was set, or a simulation that
    was reset, goes back farther: those are left as they are, and refused later.
    """
    back = np.flatnonzero(np.diff(t) < 0.0)
    most = max(SWAPPED * t.size, 2)
    if not 0 < back.size <= most or (t[back] - t[back + 1]).max() > GAP_SECONDS:
        return t, value
    notes.append(
        f'{back.size} of {t.size} messages of {source} are out of order by at most '
        f'{(t[back] - t[back + 1]).max():.3g} s: they are sorted by their stamps'
    )
    order = np.argsort(t, kind='stable')
    return t[order], value[order]


def _example(topic: dict[str, dict[str, Meaning]]) -> Target:
    return next(iter(next(iter(topic.values())).values())).target


def _named(source: BagSource) -> str:
    return ', '.join(f'{name} ({topic.type})' for name, topic in sorted(source.topics.items()))
