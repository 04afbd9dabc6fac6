# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Machine code on disk: kept where that is possible, and no failure of it ends a program."""

import logging
import resource
import runpy
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest

from pam_ros import code_cache

numba = pytest.importorskip('numba')

SOURCE = """
from pam_ros.compiled import cached

@cached
def scaled(x):
    return {factor} * x

@cached
def shifted(x):
    return x + {factor}
"""
START = """
import runpy, sys
print(runpy.run_path(sys.argv[1])['scaled'](4.0))
"""
TOO_SMALL = 3000  # bytes: the index of a function fits, its machine code does not


@pytest.fixture
def file(tmp_path, monkeypatch):
    """Return a file with two cached functions; no sentence has been logged yet."""
    monkeypatch.setattr(code_cache._Warned, 'reason', '')
    monkeypatch.setattr(numba.config, 'CACHE_DIR', str(tmp_path / 'cache'))
    path = tmp_path / 'source' / 'scales.py'
    path.parent.mkdir()
    path.write_text(SOURCE.format(factor=2.0), encoding='utf-8')
    return path


@pytest.fixture
def no_cache(file, monkeypatch):
    """Leave no folder in which numba could cache, for whatever user runs the tests."""
    (file.parent / '__pycache__').write_text('', encoding='utf-8')
    monkeypatch.setattr(numba.config, 'CACHE_DIR', '/dev/null/numba')
    monkeypatch.setenv('NUMBA_CACHE_DIR', '/dev/null/numba')
    monkeypatch.setenv('XDG_CACHE_HOME', '/dev/null')


@pytest.fixture
def logged(monkeypatch):
    """Return what the package logs from now on, also where its logger passes nothing on.

    Loggers do not propagate, which pytest's own fixture needs, where launch has set their class.
    """
    sentences = []
    handler = logging.Handler()
    handler.emit = lambda record: sentences.append(record.getMessage())
    logger = logging.getLogger('pam_ros')
    monkeypatch.setattr(logger, 'propagate', False)
    logger.addHandler(handler)
    yield sentences
    logger.removeHandler(handler)


@contextmanager
def nearly_full_disk():
    """Let no file grow beyond a few kilobytes: more raises OSError, as a full disk does."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (TOO_SMALL, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def start(file):
    """Return the first function of *file* as a new process would have it."""
    return runpy.run_path(str(file))['scaled']


def hits(function):
    return sum(function.stats.cache_hits.values())


def cached_files(tmp_path, pattern):
    return sorted((tmp_path / 'cache').rglob(pattern))


def test_code_is_kept_and_found_again(file, tmp_path, logged):
    assert start(file)(4.0) == 8.0
    again = start(file)
    assert again(4.0) == 8.0
    assert hits(again) == 1
    assert Path(again.stats.cache_path).parent == tmp_path / 'cache'
    assert logged == []


def test_without_a_writable_folder_it_is_compiled_into_memory_and_logged_once(
    file, no_cache, logged
):
    functions = runpy.run_path(str(file))
    assert logged == []  # an import alone caches nothing
    assert functions['scaled'](4.0) == 8.0
    assert functions['shifted'](4.0) == 6.0
    assert functions['scaled'].stats.cache_path is None
    (sentence,) = logged
    assert sentence.startswith('pam_ros: compiled code cannot be kept on disk')
    assert 'neither the folder of the package nor' in sentence
    assert 'NUMBA_CACHE_DIR' in sentence


def test_a_program_prints_the_sentence_on_stderr_alone(file, no_cache):
    done = subprocess.run(
        [sys.executable, '-c', START, str(file)], capture_output=True, text=True, check=True
    )
    assert done.stdout == '8.0\n'
    assert done.stderr.count('pam_ros: compiled code cannot be kept on disk') == 1
    assert len(done.stderr.splitlines()) == 1


def truncated(data):
    return data[: len(data) // 3]


def garbage(data):
    return bytes(range(255, 0, -1)) * 8


def with_a_page_of_zeros(data):
    middle = len(data) // 2
    return data[:middle] + bytes(300) + data[middle + 300 :]


@pytest.mark.parametrize('damage', [truncated, garbage, with_a_page_of_zeros, lambda _: b''])
@pytest.mark.parametrize('kind', ['*.nbi', '*.nbc'])
def test_a_damaged_file_is_replaced(file, tmp_path, logged, kind, damage):
    start(file)(4.0)
    (path,) = cached_files(tmp_path, kind)
    path.write_bytes(damage(path.read_bytes()))
    first, second = start(file), start(file)
    assert first(4.0) == 8.0
    assert hits(first) == 0
    assert second(4.0) == 8.0
    assert hits(second) == 1
    assert logged == []


def test_a_full_disk_is_one_sentence_and_leaves_nothing_half_written(file, tmp_path, logged):
    functions = runpy.run_path(str(file))
    with nearly_full_disk():
        found = functions['scaled'](4.0), functions['shifted'](4.0)
    assert found == (8.0, 6.0)
    (sentence,) = logged
    assert 'File too large' in sentence
    assert str(tmp_path / 'cache') in sentence
    assert cached_files(tmp_path, '*.*') == []


def test_code_of_an_older_source_is_not_run_after_a_full_disk(file, logged):
    start(file)(4.0)
    file.write_text(SOURCE.format(factor=3.0), encoding='utf-8')
    changed = start(file)
    with nearly_full_disk():
        assert changed(4.0) == 12.0
    assert len(logged) == 1
    assert start(file)(4.0) == 12.0


def test_an_index_that_can_be_neither_read_nor_removed_is_passed_over(file, tmp_path, logged):
    start(file)(4.0)
    (index,) = cached_files(tmp_path, '*.nbi')
    index.unlink()
    index.mkdir()
    assert start(file)(4.0) == 8.0
    assert len(logged) == 1


def test_functions_of_others_keep_the_cache_of_numba(file, no_cache):
    def plain(x):
        return x

    plain.__code__ = plain.__code__.replace(co_filename=str(file))
    with pytest.raises(RuntimeError, match='no locator available'):
        numba.njit(cache=True)(plain)
