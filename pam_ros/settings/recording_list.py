# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of one rig that differ in the load, or in how they are read: a list of their files.

In a YAML file, each recording is a mapping in the list ``recordings``::

    params: left_arm.yaml
    recordings:
      - file: light.csv
        set: {mass: 10}
        note: 21 degrees
      - file: heavy
        set: {mass: 20}
        namespace: left
        columns: {/encoder.data: position_mm-3}

``params``, which may be left out, is the nominal model of the rig: a parameter file in the folder
of the list, or a muscle of this package. ``file`` is a path from this folder. ``set`` has the
numbers of load, transmission and mounting that this recording has instead of those of the nominal
model. ``columns`` has the meaning of columns or topics, with which a recording whose position has
another zero is shifted, and ``names`` the names of columns in a file without them:
``t_s,pressure_kPa,-,position_mm``. The other keys are arguments of
:func:`pam_ros.read_recording`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pam_ros.arguments import as_path
from pam_ros.errors import ParameterError, RecordingError
from pam_ros.identification.fit.of_rig import joint_with
from pam_ros.plain_yaml import read_yaml
from pam_ros.recording.mapping import ColumnMapping, column_names, read_mapping
from pam_ros.recording.read import read_recording
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Joint

SUFFIXES = ('.yaml', '.yml')
# Arguments of read_recording that are texts.
READING = ('kind', 'namespace', 'sheet', 'variable', 'time')
TOP = ('recordings', 'params')  # keys of a list
KEYS = ('file', 'set', 'columns', 'names', 'note', *READING)


@dataclass(frozen=True)
class RecordingFile:
    """The file of a recording, and what is different for it.

    ``numbers`` are those of the rig, ``columns`` the meaning of columns or topics, and ``reading``
    the other arguments of :func:`pam_ros.read_recording`.
    """

    path: Path
    numbers: Mapping[str, float] = field(default_factory=dict)
    columns: Mapping[str, str] = field(default_factory=dict)
    reading: Mapping[str, Any] = field(default_factory=dict)
    note: str = ''

    def read(self, joint: Joint, mapping: ColumnMapping, **given: Any) -> Recording:
        """Return the recording, which has its own values instead of *mapping* and *given*.

        Raises RecordingError if it cannot be used, or if *joint* cannot have its numbers.
        """
        try:
            joint = joint_with(joint, self.numbers)
        except ParameterError as error:
            raise RecordingError(f'recording {self.path}: {error}') from error
        own = read_mapping([f'{source}={text}' for source, text in self.columns.items()])
        mapping = ColumnMapping({**mapping.meanings, **own.meanings})
        read = read_recording(self.path, joint, mapping=mapping, **{**given, **self.reading})
        return replace(read, numbers=self.numbers, note=self.note)


def read_recordings(
    path: str | Path,
    joint: Joint,
    *,
    mapping: ColumnMapping | None = None,
    muscles: Sequence[str] = (),
) -> list[Recording]:
    """Read the recordings of *joint* in the list at *path*, a YAML file, in SI, and check them.

    What the list does not say of a recording is that of *joint* and *mapping*; *muscles* are those
    of :func:`pam_ros.read_recording`. Raises RecordingError for a list or a recording that cannot
    be used, and ParameterError for arguments of a wrong type.
    """
    mapping = ColumnMapping() if mapping is None else mapping
    files, _ = recording_files(as_path('path', path, 'the path of a YAML file'))
    return [one.read(joint, mapping, muscles=muscles) for one in files]


def recording_files(
    path: Path, numbers: Mapping[str, float] | None = None
) -> tuple[list[RecordingFile], str | None]:
    """Return the files in the list at *path*, or *path* itself if it is a recording.

    *numbers* are those of the rig in all of them, unless the list has others. The second value is
    the nominal model that the list names, a file or a muscle; None if it names none.
    """
    numbers = {} if numbers is None else numbers
    if path.suffix not in SUFFIXES:
        return [RecordingFile(path, numbers)], None
    try:
        content = read_yaml(path)
    except ParameterError as error:
        raise RecordingError(f'list of recordings {error}') from error
    entries = content.get('recordings') if isinstance(content, dict) else None
    if not isinstance(entries, list) or not entries:
        raise RecordingError(
            f"{path} has no list 'recordings': give lines such as '- file: monday.csv' beneath "
            "'recordings:'"
        )
    for key in content:
        if key not in TOP:
            raise RecordingError(f'{path}: {key!r} is not known: give {", ".join(TOP)}')
    params = content.get('params')
    if not isinstance(params, str | None):
        raise RecordingError(
            f'{path}: params = {params!r} is not allowed: give the name of a file or of a muscle'
        )
    if params is not None and (path.parent / params).is_file():
        params = str(path.parent / params)
    files = [
        _file(path, f'{path}, recording {k}', entry, numbers) for k, entry in enumerate(entries, 1)
    ]
    return files, params


def _file(path: Path, where: str, entry: Any, numbers: Mapping[str, float]) -> RecordingFile:
    """Return what one *entry* of the list at *path* says."""
    if not isinstance(entry, dict) or 'file' not in entry:
        raise RecordingError(f"{where} has no 'file': give a mapping with {', '.join(KEYS)}")
    for key in entry:
        if key not in KEYS:
            raise RecordingError(f'{where}: {key!r} is not known: give {", ".join(KEYS)}')
    texts = {key: entry[key] for key in ('file', 'names', 'note', *READING) if key in entry}
    for key, value in texts.items():
        if not isinstance(value, str):
            raise RecordingError(f'{where}: {key} = {value!r} is not allowed: give a text')
    own = _table(where, entry, 'set', (int, float), 'numbers by name, such as {mass: 10}')
    columns = _table(where, entry, 'columns', (str,), 'texts, such as {pos: position_mm-3}')
    reading: dict[str, Any] = {key: texts[key] for key in READING if key in texts}
    if 'names' in texts:
        reading['columns'] = column_names(texts['names'])
    return RecordingFile(
        path.parent / texts['file'],
        {**numbers, **{name: float(value) for name, value in own.items()}},
        columns,
        reading,
        texts.get('note', ''),
    )


def _table(
    where: str, entry: dict[Any, Any], key: str, kinds: tuple[type, ...], allowed: str
) -> dict[str, Any]:
    """Return the mapping of names to values at *key* of an entry, {} if there is none."""
    found = entry.get(key, {})
    is_right = isinstance(found, dict) and all(
        isinstance(name, str) and isinstance(value, kinds) and not isinstance(value, bool)
        for name, value in found.items()
    )
    if not is_right:
        raise RecordingError(f'{where}: {key} = {found!r} is not allowed: give {allowed}')
    return dict(found)
