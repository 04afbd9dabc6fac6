# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Write a report as a folder that exists completely or not at all."""

import ctypes
import fcntl
import json
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pam_ros.errors import PamError, ParameterError
from pam_ros.identification.identification import Identification
from pam_ros.report.numbers import numbers, to_json
from pam_ros.report.parameters import refuse_indescribable, write_identified
from pam_ros.report.provenance import Provenance
from pam_ros.report.runs import runs_of
from pam_ros.report.tables import residual_csv

FILES = ('report.json', 'report.html', 'identified.yaml', 'residual.csv')
_EXCHANGE = 2  # RENAME_EXCHANGE of Linux' renameat2()
_HERE = -100  # AT_FDCWD


def check_folder(folder: Path) -> None:
    """Raise PamError if *folder* cannot become a report: it contains something else."""
    try:
        found = sorted(path.name for path in folder.iterdir())
    except FileNotFoundError:
        check_parent(folder)
        return
    except NotADirectoryError:
        raise PamError(f'{folder} is not a folder: give one for the report') from None
    except OSError as error:
        raise PamError(f'{folder} cannot be read: {error.strerror}') from error
    strange = [name for name in found if name not in FILES]
    if found and not strange and not _is_report(folder):
        strange = found
    if strange:
        others = f' and {len(strange) - 1} more' if len(strange) > 1 else ''
        raise PamError(
            f'{folder} holds {strange[0]}{others}, which is not a report of pam_identify: '
            'give a new folder'
        )
    if folder.is_mount():
        raise PamError(f'{folder} is a mount point, which cannot be replaced: give a folder in it')
    check_parent(folder)


def check_parent(path: Path) -> None:
    """Raise PamError if *path*, of a folder or a file, is not below a writable folder.

    A hidden folder is made and removed there. Permissions alone are not sufficient: below /proc,
    or on a disk without space, nothing can be made although they allow it.
    """
    target = path.resolve()
    parent = target.parent
    while not parent.exists():
        parent = parent.parent
    if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
        raise PamError(f'{path} cannot be made: {parent} is not a folder that can be written to')
    try:
        _new_sibling(target, parent).rmdir()
    except OSError as error:
        raise PamError(
            f'{path} cannot be made: no folder can be made in {parent} ({error.strerror})'
        ) from error


def _new_sibling(target: Path, parent: Path) -> Path:
    """Make and return an empty hidden folder in *parent*, with a name for *target*."""
    return Path(tempfile.mkdtemp(dir=parent, prefix=f'.{target.name}.{os.getpid()}.'))


def _is_report(folder: Path) -> bool:
    try:
        content = json.loads((folder / 'report.json').read_text(encoding='utf-8'))
    except (OSError, ValueError):
        return False
    return isinstance(content, dict) and 'schema_version' in content and 'verdict' in content


def write_report(folder: Path, result: Identification, source: Provenance) -> None:
    """Write all files of the report into *folder*, in place of a former report.

    A joint that no parameter file can describe has no ``identified.yaml``; the page gives the
    reason. Until the end only a hidden sibling exists, which is removed if anything fails. Raises
    PamError if *folder* contains something else or cannot be written.
    """
    from pam_ros.report.page import page  # imports matplotlib, which nothing else needs

    check_folder(folder)
    no_file = ''
    try:
        refuse_indescribable(result, source)
    except ParameterError as error:
        no_file = str(error)
    runs = runs_of(result)
    content = numbers(result, runs, source)
    parts: dict[str, Callable[[], str]] = {
        'report.json': lambda: to_json(content),
        'report.html': lambda: page(
            result, runs, source, content, folder / 'identified.yaml', no_file
        ),
        'residual.csv': lambda: residual_csv(runs, result.quantity, result.unit),
    }
    with replaced(folder) as new:
        for name, text in parts.items():
            (new / name).write_text(text(), encoding='utf-8')
        if not no_file:
            write_identified(new / 'identified.yaml', result, source)


@contextmanager
def replaced(folder: Path) -> Iterator[Path]:
    """Give an empty folder that replaces *folder* at the end.

    If the body raises, *folder* is unchanged. Raises PamError if writing to the disk fails.
    """
    target = folder.resolve()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with suppress(OSError):  # if a folder cannot be listed, or was removed meanwhile
            _clear_abandoned(target)
        new = _new_sibling(target, target.parent)
    except OSError as error:
        raise PamError(f'{folder} cannot be made: {error.strerror}') from error
    lock = _locked(new)
    try:
        new.chmod(0o777 & ~_umask())
        yield new
        if target.exists():
            _exchange(new, target)
        else:
            new.rename(target)
    except OSError as error:
        raise PamError(f'{folder} cannot be written: {error.strerror}') from error
    finally:
        # This is the former report now, or an incomplete new one.
        shutil.rmtree(new, ignore_errors=True)
        if lock is not None:
            os.close(lock)


def _clear_abandoned(target: Path) -> None:
    """Remove the hidden siblings of *target* that killed programs have left.

    A program has ended if no process has its id, and no process holds the lock. The id alone is
    not sufficient: in containers, several programs can have the same id.
    """
    hidden = re.compile(rf'\.{re.escape(target.name)}\.(\d+)\.[a-z0-9_]{{8}}')
    for path in target.parent.iterdir():
        match = hidden.fullmatch(path.name)
        if match is None or path.is_symlink() or not path.is_dir() or _runs(int(match[1])):
            continue
        lock = _locked(path)
        if lock is not None:
            shutil.rmtree(path, ignore_errors=True)
            os.close(lock)


def _runs(process: int) -> bool:
    """Return whether another process has this id."""
    if process == os.getpid():
        return False
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:  # it is another user's
        return True
    return True


def _locked(folder: Path) -> int | None:
    """Lock *folder* and return the descriptor that holds the lock; None if it is locked already.

    None, too, if it cannot be opened or the file system has no locks.
    """
    try:
        number = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        return None
    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(number)
        return None
    return number


def _exchange(new: Path, old: Path) -> None:
    """Swap two folders: in one step if the file system can, else by renaming."""
    libc = ctypes.CDLL(None, use_errno=True)
    swap = getattr(libc, 'renameat2', None)
    if swap is not None and not swap(_HERE, os.fsencode(new), _HERE, os.fsencode(old), _EXCHANGE):
        return
    aside = new.with_name(f'{new.name}.old')
    old.rename(aside)
    try:
        new.rename(old)
    except OSError:
        aside.rename(old)
        raise
    aside.rename(new)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
