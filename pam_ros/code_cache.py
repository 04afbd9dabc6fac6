# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""numba's cache of machine code on disk, whose failures are not errors of the program.

Without this module, a folder without write permission, a full disk or a damaged file would end a
program that can also compile into memory.
"""

import hashlib
import logging
import pickle
from collections.abc import Callable
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from typing import Any


class CodeCache:
    """The cache of one function, with the methods that numba calls.

    It is opened when the function is first compiled, not when it is imported. A damaged file is
    removed and written again. If the machine code cannot be stored, :func:`warn` logs this.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        """Store the machine code of *function*, a plain Python function, when it is compiled."""
        self._function = function
        self._is_open = False
        self._cache: Any = None

    @property
    def cache_path(self) -> str | None:
        """The folder of the files; None if there is no cache."""
        cache = self._opened()
        return None if cache is None else str(cache.cache_path)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled function for the signature *sig*; None if it is not cached."""
        cache = self._opened()
        if cache is None:
            return None
        try:
            return cache.load_overload(sig, target_context)
        except Exception:  # for a damaged file pickle can raise any exception
            self._remove_index()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Store the compiled function *data* for the signature *sig*, if the disk allows it."""
        cache = self._opened()
        if cache is None:
            return
        try:
            cache.save_overload(sig, data)
        except OSError as error:
            # The index is written first, so it may name a file that was not written or is old.
            self._remove_index()
            self._give_up(error)

    def flush(self) -> None:
        """Discard the stored machine code."""
        self._remove_index()

    def _opened(self) -> Any:
        if not self._is_open:
            self._is_open = True
            try:
                self._cache = _checked_cache()(self._function)
            except (OSError, RuntimeError) as error:
                self._give_up(error)
        return self._cache

    def _remove_index(self) -> None:
        """Remove the index: without it numba ignores the other files."""
        if self._cache is None:
            return
        try:
            Path(self._cache._cache_file._index_path).unlink(missing_ok=True)
        except OSError as error:
            self._give_up(error)

    def _give_up(self, error: Exception) -> None:
        folder = '' if self._cache is None else str(self._cache.cache_path)
        self._cache = None
        warn(_reason(error, folder))


class _Warned:
    """The reason of the warning, which is logged once per process."""

    reason = ''


def warn(reason: str) -> None:
    """Log, once in this process, that machine code is not stored on disk, and the reason.

    If no handler is set, Python's ``logging`` prints the message on stderr.
    """
    if reason and not _Warned.reason:
        _Warned.reason = reason
        logging.getLogger('pam_ros').warning(
            'pam_ros: compiled code cannot be kept on disk and is compiled again at each start: '
            '%s; the environment variable NUMBA_CACHE_DIR can name a folder with write '
            'permission and free space',
            reason,
        )


def warned() -> str:
    """Return the reason that was logged in this process; '' if there was none."""
    return _Warned.reason


def _reason(error: Exception, folder: str) -> str:
    if isinstance(error, OSError):
        return f'{error.filename or folder}: {error.strerror}'
    if 'no locator available' in str(error):
        return "neither the folder of the package nor the user's cache folder can be written"
    return str(error)


@lru_cache(maxsize=1)
def _checked_cache() -> Any:
    """Return numba's cache class with a checksum: numba runs the bytes of a file unchecked."""
    caching: Any = import_module('numba.core.caching')
    dumps = import_module('numba.core.serialize').dumps

    class Checked(caching.CompileResultCacheImpl):  # type: ignore[misc]
        def get_filename_base(self, fullname: str, abiflags: str) -> str:
            # Separate files: numba's class would treat files with a checksum as plain code.
            return f'{super().get_filename_base(fullname, abiflags)}-checked'

        def reduce(self, cres: Any) -> tuple[bytes, bytes]:
            data = dumps(super().reduce(cres))
            return hashlib.sha256(data).digest(), data

        def rebuild(self, target_context: Any, payload: tuple[bytes, bytes]) -> Any:
            digest, data = payload
            if hashlib.sha256(data).digest() != digest:
                raise ValueError('machine code with a wrong checksum')
            return super().rebuild(target_context, pickle.loads(data))

    class Cache(caching.FunctionCache):  # type: ignore[misc]
        _impl_class = Checked

    return Cache
