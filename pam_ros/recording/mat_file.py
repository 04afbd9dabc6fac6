# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The vectors of a MATLAB file (.mat, up to version 7) as the columns of a table."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import UNUSED

_SAVE = (
    "save the vectors, or a struct of vectors, with save('log.mat', ..., '-v7'), or a table with "
    "writetable(T, 'log.csv')"
)


@dataclass(frozen=True, eq=False)
class MatFrame:
    """The columns of a MATLAB file, as those of a DataFrame, and notes."""

    arrays: Mapping[str, NDArray[Any]]
    notes: list[str]

    @property
    def columns(self) -> list[str]:
        """Return the names of the columns."""
        return [*self.arrays]

    def __getitem__(self, column: str) -> NDArray[Any]:
        """Return a column (n,)."""
        return self.arrays[column]


def read_mat(path: Path, columns: Sequence[str] = (), variable: str | None = None) -> MatFrame:
    """Return the columns in the MATLAB file at *path*.

    They are the vectors of the file, or the fields of a struct or of an array of structs, or with
    *columns* as their names the columns of a matrix. *variable* names the struct or the matrix,
    and is needed only if there are several. Raises RecordingError if the file cannot be read, or
    if it is not clear what is meant.
    """
    values = _load(path)
    named = ', '.join(values) or 'no variable that can be read'
    if variable is not None:
        if variable not in values:
            raise RecordingError(f'{path.name} has no variable {variable!r}: it has {named}')
        values = {variable: values[variable]}
    if columns:
        return _of_matrix(path.name, values, columns)
    structs = {name: fields for name, one in values.items() if (fields := _fields(one))}
    vectors = {name: one for name, one in values.items() if _is_vector(one)}
    if len(structs) + (len(vectors) > 1) > 1:
        raise RecordingError(
            f'{path.name} has {", ".join([*structs, *vectors])}: choose one struct with --variable'
        )
    if structs:
        return _of_vectors(*structs.values())
    if len(vectors) > 1:
        return _of_vectors(vectors)
    matrices = [f'{name} ({one.shape[0]} by {one.shape[1]})' for name, one in _matrices(values)]
    if matrices:
        raise RecordingError(
            f'{path.name} has no names of columns, but {", ".join(matrices)}: give the names of '
            'the columns of the matrix with --columns t_s,pressure_command_kPa,position_mm'
        )
    raise RecordingError(f'{path.name} has no vectors: it has {named}; {_SAVE}')


def _load(path: Path) -> dict[str, Any]:
    """Return variable -> value: arrays without dimensions of length 1, and structs as dicts."""
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabOpaque

    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')  # of variables that cannot be read
            found = loadmat(path, simplify_cells=True)
    except NotImplementedError:
        raise RecordingError(
            f'{path.name} is a MATLAB file of version 7.3, which is not read: {_SAVE}'
        ) from None
    except Exception as error:
        # The reader has no error of its own for a file that is damaged, or is something else.
        raise RecordingError(f'{path.name} is not a valid MATLAB file: {error}') from error
    opaque = [name for name, one in found.items() if isinstance(one, MatlabOpaque)]
    values = {name: one for name, one in found.items() if not name.startswith('__')}
    if opaque and not any(_is_vector(one) or _fields(one) for one in values.values()):
        raise RecordingError(
            f'{path.name} has an object of MATLAB, such as a table, a timetable or a timeseries, '
            f'which only MATLAB reads: {_SAVE}'
        )
    return {name: one for name, one in values.items() if name not in opaque}


def _is_vector(value: object) -> bool:
    is_array = isinstance(value, np.ndarray) and value.ndim == 1 and value.size > 1
    return is_array and np.asarray(value).dtype.kind in 'biuf'


def _fields(value: object) -> dict[str, NDArray[Any]]:
    """Return the fields of a struct, or of an array of structs, that are vectors."""
    if isinstance(value, list | np.ndarray) and len(np.shape(value)) == 1 and len(value) > 1:
        rows = [*value]
        if all(isinstance(one, dict) and one.keys() == rows[0].keys() for one in rows):
            value = {name: np.array([one[name] for one in rows]) for name in rows[0]}
    if not isinstance(value, dict):
        return {}
    return {name: one for name, one in value.items() if _is_vector(one)}


def _of_vectors(vectors: Mapping[str, NDArray[Any]]) -> MatFrame:
    """Return the vectors that are the longest; the others are no samples."""
    count = max(one.size for one in vectors.values())
    short = [f'{name} ({one.size})' for name, one in vectors.items() if one.size < count]
    notes = [f'vectors with fewer than {count} values are not used: {", ".join(short)}']
    kept = {name: one for name, one in vectors.items() if one.size == count}
    return MatFrame(kept, notes if short else [])


def _matrices(values: Mapping[str, Any]) -> list[tuple[str, NDArray[Any]]]:
    return [
        (name, one)
        for name, one in values.items()
        if isinstance(one, np.ndarray) and one.ndim == 2 and one.dtype.kind in 'biuf'
    ]


def _of_matrix(name: str, values: Mapping[str, Any], columns: Sequence[str]) -> MatFrame:
    """Return the columns, or the rows, of the only matrix that has one for each name."""
    matrices = _matrices(values)
    count = len(columns)
    fitting = [(one, value) for one, value in matrices if count in value.shape]
    if len(fitting) != 1:
        shown = ', '.join(f'{one} ({a.shape[0]} by {a.shape[1]})' for one, a in matrices)
        what = (
            'choose one with --variable'
            if fitting
            else f'give a name for each, {UNUSED} if unused'
        )
        raise RecordingError(
            f'{name} has {shown or "no matrix"}, and {count} names of columns are given: {what}'
        )
    value = fitting[0][1]
    value = value if value.shape[1] == count else value.T
    named = [one for one in columns if one != UNUSED]
    if len(set(named)) < len(named):
        raise RecordingError(f'{name}: a name is given to several columns')
    used = {one: value[:, i] for i, one in enumerate(columns) if one != UNUSED}
    return MatFrame(used, [])
