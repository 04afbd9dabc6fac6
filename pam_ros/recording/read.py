# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read any recording: a rosbag2 directory, one of its files, or a CSV file."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pam_ros.arguments import array, as_path, instance, number, sequence
from pam_ros.errors import RecordingError, printable, shown
from pam_ros.recording.assemble import MissingSignalError, assemble
from pam_ros.recording.bag import bag_files, read_bag
from pam_ros.recording.csv_file import read_csv
from pam_ros.recording.direction import with_contraction_positive
from pam_ros.recording.likely import found_columns
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.quality import check
from pam_ros.recording.recording import Recording

BAG_SUFFIXES = ('.mcap', '.db3')


def read_recording(
    path: str | Path,
    mapping: ColumnMapping | None = None,
    kind: str | None = None,
    l0: float | None = None,
    p_max: float | Sequence[float] | None = None,
    namespace: str | None = None,
    muscles: Sequence[str] = (),
    unit: str | None = None,
    reach: tuple[float, float] | None = None,
) -> Recording:
    """Read the recording at *path* in SI, and check it.

    ``mapping`` gives the meaning of columns or topics with other names. ``kind`` is ``free`` for a
    free load or ``held`` for a prescribed length (found from the data if None). ``l0`` in m
    converts a contraction to a position; a position must be a valid contraction of this length.
    ``p_max`` in gauge Pa is the highest pressure of the muscle, one for each muscle if there are
    several; the unit of the input is checked against it. ``namespace`` selects one of several rigs
    in a bag.

    For a joint, ``muscles`` are the names of its muscles in order (if empty, the order in which
    they appear in a CSV file). ``unit`` is that of its position: ``m``, or ``rad`` for a revolute
    joint. ``reach`` is the least and the greatest position that it can have. Columns that belong
    to a muscle have its name before a dot: ``agonist.pressure_command_kPa``; in a bag, arrays have
    a number for each muscle.

    Raises RecordingError, with a sentence for the user, for a recording that cannot be used, and
    ParameterError for arguments of a wrong type.
    """
    path = as_path('path', path, 'the path of a bag or a CSV file')
    mapping = ColumnMapping() if mapping is None else mapping
    instance('mapping', mapping, ColumnMapping, 'what read_mapping returns')
    if l0 is not None:
        number('l0', l0)
    muscles = sequence('muscles', muscles, str, 'the name of a muscle')
    if p_max is not None:
        array('p_max', p_max)
    if not path.exists():
        raise RecordingError(f'recording {path} does not exist')
    if not (path.is_dir() or path.is_file()):
        # A device or a pipe may have no end, and a recording is read twice: for its data and for
        # its digest.
        raise RecordingError(f'recording {path} is neither a file nor a folder')
    header: list[str] = []
    if path.is_dir() or path.suffix in BAG_SUFFIXES:
        files = bag_files(path)
        series, notes = read_bag(path, mapping, namespace, muscles, unit)
    elif namespace is not None:
        raise RecordingError(
            f'namespace = {namespace}, but recording {path} is not a bag: a CSV file has no '
            'namespaces, leave it out'
        )
    else:
        files = [path]
        series, notes, header = read_csv(path, mapping)
    name = printable(path.name or str(path))
    try:
        recording = assemble(name, series, notes, kind, l0, muscles)
    except MissingSignalError as error:
        if not header:
            raise
        found = found_columns(header, mapping, series)
        raise RecordingError(f'{error}; {found}') from error
    if unit is not None and recording.unit != unit:
        raise RecordingError(
            f'{recording.name}: the position is in {recording.unit}, and the model moves in '
            f'{unit}: is it a recording of another joint?'
        )
    recording = with_contraction_positive(recording)
    warnings = check(recording, l0, p_max, reach)
    # The notes name columns and topics as they stand in the file.
    sentences = tuple(map(shown, (*recording.warnings, *warnings)))
    return replace(recording, warnings=sentences, digest=_digest(files))


def _digest(files: list[Path]) -> str:
    """Return the SHA-256 of the files' contents, one after the other."""
    digest = hashlib.sha256()
    for file in files:
        with file.open('rb') as stream:
            for block in iter(lambda: stream.read(1 << 20), b''):
                digest.update(block)
    return digest.hexdigest()
