# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of a report: whole or not at all, and never in the place of something else."""

import errno
import json
import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest

from pam_ros.errors import PamError
from pam_ros.report import write
from pam_ros.report.write import FILES, check_folder, replaced, write_report

# An id that no process has: Linux gives none as high.
ENDED = int(Path('/proc/sys/kernel/pid_max').read_text()) + 1


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.slow
def test_all_files_are_there_and_nothing_else(folder):
    assert names(folder) == sorted(FILES)
    assert names(folder.parent) == ['report']
    assert json.loads((folder / 'report.json').read_text(encoding='utf-8'))['schema_version']
    assert (folder / 'report.html').stat().st_size < 2.5e6


def test_folder_has_the_permissions_of_any_other(folder, tmp_path):
    (tmp_path / 'other').mkdir()
    modes = [stat.S_IMODE(path.stat().st_mode) for path in (folder, tmp_path / 'other')]
    assert modes[0] == modes[1]


def test_former_report_is_replaced(reports, friction, clean, tmp_path):
    shutil.copytree(reports(friction), tmp_path / 'out')
    result, source, _ = clean
    write_report(tmp_path / 'out', result, source)
    report = json.loads((tmp_path / 'out' / 'report.json').read_text(encoding='utf-8'))
    assert report['verdict'] == 'no_missing_effect'
    assert names(tmp_path) == ['out']


@pytest.mark.parametrize('swaps', [True, False])
def test_replacing_swaps_two_folders(tmp_path, monkeypatch, swaps):
    if not swaps:  # a file system or a machine that cannot
        monkeypatch.setattr(write.ctypes, 'CDLL', lambda *_, **__: object())
    target = tmp_path / 'report'
    for text in ('first', 'second'):
        with replaced(target) as new:
            (new / 'report.json').write_text(text, encoding='utf-8')
            if text == 'second':
                assert (target / 'report.json').read_text(encoding='utf-8') == 'first'
        assert (target / 'report.json').read_text(encoding='utf-8') == text
        assert names(tmp_path) == ['report']


@pytest.mark.slow
@pytest.mark.parametrize('error', [KeyboardInterrupt, RuntimeError, SystemExit])
def test_nothing_is_left_where_writing_breaks_off(friction, reports, tmp_path, monkeypatch, error):
    result, source, _ = friction
    target = tmp_path / 'deep' / 'report'
    shutil.copytree(reports(friction), target)
    before = (target / 'report.json').read_bytes()

    def fail(*_):
        raise error

    monkeypatch.setattr(write, 'write_identified', fail)
    with pytest.raises(error):
        write_report(target, result, source)
    assert names(target.parent) == ['report']
    assert names(target) == sorted(FILES)
    assert (target / 'report.json').read_bytes() == before


KILLED = """
import os, signal, sys
from pathlib import Path
from pam_ros.report.write import replaced
with replaced(Path(sys.argv[1])) as new:
    (new / 'report.json').write_text('half', encoding='utf-8')
    {end}
"""


def writing(target, end):
    """Start a program that begins a report in *target* and ends or waits as *end* says."""
    return subprocess.Popen([sys.executable, '-c', KILLED.format(end=end), str(target)])


def test_what_a_killed_program_left_is_removed_by_the_next(tmp_path):
    target = tmp_path / 'report'
    writing(target, 'os.kill(os.getpid(), signal.SIGKILL)').wait()
    (left,) = names(tmp_path)
    assert left.startswith('.report.')
    with replaced(target) as new:
        assert names(tmp_path) == [new.name]
    assert names(tmp_path) == ['report']


def test_what_another_program_is_writing_stays(tmp_path):
    target = tmp_path / 'report'
    other = writing(target, 'signal.pause()')
    try:
        end = monotonic() + 60.0
        while not list(tmp_path.glob('.report.*/report.json')):
            assert monotonic() < end
            sleep(0.01)
        with replaced(target):
            assert len(names(tmp_path)) == 2
        assert len(names(tmp_path)) == 2
        # Its process id tells another container nothing, the lock does.
        (kept,) = tmp_path.glob('.report.*')
        ended = kept.with_name(f'.report.{ENDED}.{kept.name[-8:]}')
        kept.rename(ended)
        with replaced(target) as new:
            assert names(tmp_path) == sorted([ended.name, new.name, 'report'])
    finally:
        other.kill()
        other.wait()


def test_hidden_folders_of_others_stay(tmp_path):
    others = [
        '.report.backup1',
        f'.report.{ENDED}.abcdefg',
        f'.report.{ENDED}.abcdefgh.old',  # may hold the only former report
        f'.other.{ENDED}.abcdefgh',
        f'report.{ENDED}.abcdefgh',
        f'.report.{os.getppid()}.abcdefgh',
    ]
    for name in others:
        (tmp_path / name).mkdir()
    (tmp_path / f'.report.{ENDED}.file_abc').write_text('', encoding='utf-8')
    (tmp_path / f'.report.{ENDED}.link_abc').symlink_to(tmp_path / 'report.backup1')
    before = names(tmp_path)
    (tmp_path / f'.report.{ENDED}.abcdefgh').mkdir()
    with replaced(tmp_path / 'report'):
        pass
    assert names(tmp_path) == sorted([*before, 'report'])


def test_a_full_disk_is_a_sentence(tmp_path):
    def body():
        with replaced(tmp_path / 'report'):
            raise OSError(28, 'No space left on device')

    with pytest.raises(PamError, match='cannot be written: No space left'):
        body()
    assert names(tmp_path) == []


def test_a_report_with_other_files_next_to_it_is_refused(tmp_path):
    content = '{"schema_version": "1", "verdict": "effect_found"}'
    (tmp_path / 'report.json').write_text(content, encoding='utf-8')
    check_folder(tmp_path)
    (tmp_path / 'notes.txt').write_text('mine', encoding='utf-8')
    with pytest.raises(PamError, match=r'holds notes\.txt, which is not a report'):
        check_folder(tmp_path)


def test_files_that_only_look_like_a_report_are_refused(tmp_path):
    (tmp_path / 'report.json').write_text('{"title": "accounts"}', encoding='utf-8')
    with pytest.raises(PamError, match='not a report of pam_identify'):
        check_folder(tmp_path)


def test_an_empty_or_new_folder_is_taken(tmp_path):
    (tmp_path / 'empty').mkdir()
    check_folder(tmp_path / 'empty')
    check_folder(tmp_path / 'new' / 'below')
    assert names(tmp_path) == ['empty']


@pytest.mark.parametrize('name', ['report', 'new/below'])
def test_a_folder_that_the_system_refuses_is_noticed_before(name):
    # The permissions of /proc allow root to make a folder there, and the system refuses it.
    with pytest.raises(PamError, match=r'cannot be made: .* /proc'):
        check_folder(Path('/proc') / name)


def test_a_full_disk_is_noticed_before(tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(write.tempfile, 'mkdtemp', full)
    with pytest.raises(PamError) as refused:
        check_folder(tmp_path / 'report')
    assert str(refused.value) == (
        f'{tmp_path / "report"} cannot be made: no folder can be made in {tmp_path} '
        '(No space left on device)'
    )


def test_a_mount_point_is_noticed_before(tmp_path, monkeypatch):
    monkeypatch.setattr(Path, 'is_mount', lambda path: path == tmp_path)
    with pytest.raises(PamError, match='is a mount point, which cannot be replaced'):
        check_folder(tmp_path)
    check_folder(tmp_path / 'report')


def test_a_link_stays_a_link(tmp_path, friction):
    result, source, _ = friction
    (tmp_path / 'real').mkdir()
    (tmp_path / 'link').symlink_to(tmp_path / 'real')
    write_report(tmp_path / 'link', result, source)
    assert (tmp_path / 'link').is_symlink()
    assert names(tmp_path / 'real') == sorted(FILES)
