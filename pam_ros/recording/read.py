# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read any recording: a rosbag2 directory, one of its files, a table file, or a DataFrame."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pam_ros.arguments import as_path, instance, refuse, sequence
from pam_ros.errors import RecordingError, printable, shown
from pam_ros.recording.assemble import MissingSignalError, assemble
from pam_ros.recording.bag.clocks import TIMES
from pam_ros.recording.bag.read import bag_files, read_bag
from pam_ros.recording.bounds import Bounded, Bounds, bounds_of
from pam_ros.recording.dataframe import series_of_frame
from pam_ros.recording.digest import digest_of_files
from pam_ros.recording.direction import with_contraction_positive, with_tension_positive
from pam_ros.recording.likely import found_columns, may_have_output
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.quality import check
from pam_ros.recording.recording import Recording
from pam_ros.recording.series import Series
from pam_ros.recording.table_file import read_table_file

BAG_SUFFIXES = ('.mcap', '.db3')


def read_recording(
    path: str | Path,
    joint: Bounded | None = None,
    *,
    mapping: ColumnMapping | None = None,
    kind: str | None = None,
    namespace: str | None = None,
    muscles: Sequence[str] = (),
    columns: Sequence[str] = (),
    sheet: str | None = None,
    variable: str | None = None,
    time: str = 'header',
) -> Recording:
    """Read the recording at *path* in SI, and check it.

    *path* is a rosbag2 directory, one of its files, a CSV file, an Excel workbook (.xlsx), or a
    MATLAB file (.mat) of version 7 or before. *joint* is the Joint that was recorded: its lengths
    and pressures are needed to read a contraction, and show a signal in another unit. *mapping*
    gives the meaning of columns or topics with other names (:func:`pam_ros.read_mapping`). *kind*
    is ``free`` for a free load, ``held`` for a prescribed length, or ``pressure`` for commands and
    pressures alone (found from the data if None). *namespace* selects one of several rigs in a
    bag.

    *muscles* are the names of the muscles of a joint that has several, in their order (if empty,
    the order in which they appear in a CSV file). Columns that belong to a muscle have its name
    before a dot: ``agonist.pressure_command_kPa``; in a bag, arrays have a number for each muscle.

    *columns* are the names of the columns of a CSV file, in their order, if the file has none, or
    if its own are to be replaced; ``-`` is a column that is not used. *sheet* is the name of the
    sheet of a workbook that has several, *variable* that of the struct or matrix of a MATLAB file.

    *time* is ``header`` for the stamps in the headers of the messages of a bag, where they have
    some and all are of one clock, or ``received`` for the times of receipt of all messages.

    Raises RecordingError, with a sentence for the user, for a recording that cannot be used or is
    of another joint, and ParameterError for arguments of a wrong type.
    """
    path = as_path('path', path, 'the path of a bag or a CSV file')
    bounds, mapping, muscles = _arguments(joint, mapping, muscles)
    columns = sequence('columns', columns, str, "the name of a column, such as 't_s'")
    if time not in TIMES:
        refuse('time', time, f'one of {", ".join(TIMES)}')
    if not path.exists():
        raise RecordingError(f'recording {path} does not exist')
    if not (path.is_dir() or path.is_file()):
        # A device or a pipe may have no end, and a recording is read twice: for its data and for
        # its digest.
        raise RecordingError(f'recording {path} is neither a file nor a folder')
    header: list[str] = []
    if path.is_dir() or path.suffix in BAG_SUFFIXES:
        of_tables = {'columns': ','.join(columns), 'sheet': sheet, 'variable': variable}
        _refuse_given(of_tables, f'recording {path} is a bag')
        files = bag_files(path)
        series, notes = read_bag(path, mapping, namespace, muscles, bounds.unit, time)
    else:
        of_bags = {'namespace': namespace, 'time': '' if time == TIMES[0] else time}
        _refuse_given(of_bags, f'recording {path} is not a bag')
        files = [path]
        series, notes, header = read_table_file(path, mapping, columns, sheet, variable)
    name = printable(path.name or str(path))
    recording = _assembled(name, series, notes, header, mapping, bounds, kind, muscles)
    return replace(recording, digest=digest_of_files(files))


def _refuse_given(options: Mapping[str, str | None], reason: str) -> None:
    """Raise RecordingError for one of the *options*, by name, that is given."""
    for name, given in options.items():
        if given:
            raise RecordingError(f'{name} = {shown(given)}, but {reason}: leave it out')


def read_dataframe(
    frame: Any,
    joint: Bounded | None = None,
    *,
    name: str = 'dataframe',
    mapping: ColumnMapping | None = None,
    kind: str | None = None,
    muscles: Sequence[str] = (),
) -> Recording:
    """Return the recording in a DataFrame: see :meth:`pam_ros.Recording.from_dataframe`."""
    instance('name', name, str, 'a text')
    bounds, mapping, muscles = _arguments(joint, mapping, muscles)
    series, notes, header = series_of_frame(name, frame, mapping)
    return _assembled(name, series, notes, header, mapping, bounds, kind, muscles)


def _arguments(
    joint: Bounded | None, mapping: ColumnMapping | None, muscles: Sequence[str]
) -> tuple[Bounds, ColumnMapping, tuple[str, ...]]:
    """Return the bounds of the joint, the mapping and the names of the muscles, checked."""
    mapping = ColumnMapping() if mapping is None else mapping
    instance('mapping', mapping, ColumnMapping, 'what read_mapping returns')
    return bounds_of(joint), mapping, sequence('muscles', muscles, str, 'the name of a muscle')


def _assembled(
    name: str,
    series: dict[str, Series],
    notes: list[str],
    header: list[str],
    mapping: ColumnMapping,
    bounds: Bounds,
    kind: str | None,
    muscles: tuple[str, ...],
) -> Recording:
    """Return the recording that *series* give, checked; *header* has the columns of a table."""
    try:
        recording = assemble(name, series, notes, kind, bounds.l0, muscles)
    except MissingSignalError as error:
        if not header:
            raise
        found = found_columns(header, mapping, series)
        raise RecordingError(f'{error}; {found}') from error
    if kind is None and recording.kind == 'pressure' and may_have_output(header, mapping):
        raise RecordingError(
            f'{name} has no position or force under a name that is known; '
            f'{found_columns(header, mapping, series)}; or give --kind pressure (in Python '
            "kind='pressure') to use only the commands and pressures"
        )
    bounds.require(recording.name, len(recording.muscles) or 1, recording.unit)
    recording = with_contraction_positive(with_tension_positive(recording))
    warnings = check(recording, bounds)
    # The notes name columns and topics as they stand in the file.
    sentences = tuple(map(shown, (*recording.warnings, *warnings)))
    return replace(recording, warnings=sentences)
