# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Results of many tasks on disk, each stored as it ends: work that was interrupted can go on.

It is one file of SQLite, which holds each result completely or not at all.
"""

import json
import sqlite3
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from pam_ros.errors import PamError

VERSION = 1  # of the table in the file
NAME = 'results'
COLUMNS = 'key TEXT PRIMARY KEY, content TEXT NOT NULL, data BLOB'


class Row(NamedTuple):
    """A result: JSON, and bytes that belong to it."""

    content: Any
    data: bytes | None = None


class Journal:
    """Results by their keys, in a file that is made with the first of them.

    ``count`` is the number of results that are of use.
    """

    def __init__(self, path: Path, *, is_resumed: bool) -> None:
        """Take over the results in *path* if the work is resumed.

        Raises PamError if the file is damaged or in use, or exists but the work is not resumed.
        """
        self.path = path
        self._connection: sqlite3.Connection | None = None
        self.count = 0
        if path.exists():
            with self._refusing():
                self._open()
            if not is_resumed:
                self.close()
                raise PamError(
                    f'{path} has results of a command that was interrupted: give --resume to go '
                    'on with it, or remove the file'
                )

    def close(self) -> None:
        """Close the file."""
        if self._connection is not None:
            self._connection.close()
        self._connection = None

    def remove(self) -> None:
        """Remove the file: the work is complete."""
        self.close()
        self.path.unlink(missing_ok=True)
        self.count = 0

    def rows(self, keys: Collection[str]) -> dict[str, Row]:
        """Return the results with one of these *keys*; raises PamError if the file is damaged."""
        if self._connection is None:
            return {}
        with self.refusing_damage():
            rows = self._connection.execute(f'SELECT key, content, data FROM {NAME}').fetchall()
            found = {key: Row(json.loads(text), data) for key, text, data in rows if key in keys}
        self.count = len(found)
        return found

    def add(self, key: str, row: Row) -> None:
        """Store a result; raises PamError if it cannot be written."""
        with self._refusing():
            self._open()
            with self._connected() as connection:
                connection.execute(
                    f'INSERT OR REPLACE INTO {NAME} VALUES (?, ?, ?)',
                    (key, json.dumps(row.content), row.data),
                )
        self.count += 1

    @contextmanager
    def telling_what_is_kept(self, count: int) -> Iterator[None]:
        """Add to an error or an interrupt how many results, of so many, are kept."""
        try:
            yield
        except (PamError, KeyboardInterrupt) as error:
            if not self.count:
                raise
            text = f'{self.count} of {count} results are kept in {self.path}: --resume goes on'
            raise type(error)('; '.join(filter(None, [str(error), text]))) from None

    @contextmanager
    def refusing_damage(self) -> Iterator[None]:
        """Turn a ValueError about a result into a PamError that says what to do."""
        try:
            with self._refusing():
                yield
        except ValueError as error:
            self.close()
            self.count = 0
            raise PamError(f'{self.path} is damaged: {error}; remove it to begin again') from error

    def _open(self) -> None:
        """Open the file, if it is not open; another program cannot open it then."""
        if self._connection is not None:
            return
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._connection = sqlite3.connect(self.path, timeout=0.0)
        self._connection.execute('PRAGMA locking_mode = EXCLUSIVE')
        (version,) = self._connection.execute('PRAGMA user_version').fetchone()
        if version not in (0, VERSION):
            raise sqlite3.DatabaseError(f'its version {version} is not known')
        with self._connection:
            self._connection.execute('BEGIN EXCLUSIVE')
            self._connection.execute(f'CREATE TABLE IF NOT EXISTS {NAME} ({COLUMNS})')
            self._connection.execute(f'PRAGMA user_version = {VERSION}')

    def _connected(self) -> sqlite3.Connection:
        assert self._connection is not None
        return self._connection

    @contextmanager
    def _refusing(self) -> Iterator[None]:
        """Turn errors of the file into sentences."""
        try:
            yield
        except sqlite3.OperationalError as error:
            self.close()
            if 'locked' in str(error):
                raise PamError(f'{self.path} is in use by another program') from error
            raise PamError(f'{self.path} cannot be used: {error}') from error
        except sqlite3.DatabaseError as error:
            self.close()
            self.count = 0
            raise PamError(f'{self.path} is damaged: {error}; remove it to begin again') from error
        except OSError as error:
            raise PamError(f'{self.path} cannot be written: {error.strerror}') from error
