# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The command that measures which mutants the tests notice, on a package of one function."""

import shutil
import subprocess
import sys

import pytest

pytest.importorskip('cosmic_ray')
FILES = {
    'pam_ros/__init__.py': '',
    # The marker of keyword arguments, the annotation and the decorator give no mutants.
    'pam_ros/small/heavy.py': """from functools import lru_cache


@lru_cache(maxsize=8)
def is_heavy(mass: float | None, *, limit: float = 10.0) -> bool | None:
    return mass > limit
""",
    # Of three mutants it notices one: the opposite comparison, not >= or another limit.
    'test/small/test_heavy.py': """from pam_ros.small.heavy import is_heavy


def test_heavy_and_light():
    assert is_heavy(12.0)
    assert not is_heavy(8.0)
""",
    'conftest.py': "def pytest_itemcollected(item):\n    item.add_marker('pure')\n",
    'pytest.ini': '[pytest]\nmarkers = pure\n',
    '.gitignore': '/build/\n__pycache__/\n',
}


@pytest.fixture
def run(tmp_path, root):
    """Return a function that runs the command on a small package, for its exit code and text."""
    if shutil.which('git') is None:
        pytest.skip('no git')
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    subprocess.run(['git', 'init', '-q'], cwd=tmp_path, check=True)

    def run(*arguments):
        command = [sys.executable, root / 'tools' / 'mutation.py', *arguments]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    return run


@pytest.mark.slow
def test_survivors_are_shown_and_results_kept(run, tmp_path):
    code, text = run('pam_ros/small', '--jobs', '2')
    assert code == 0, text
    assert 'pam_ros/small                        1 of 3 = 33 %' in text
    assert '0 of 3 mutants are not yet tested.' in text
    assert 'pam_ros/small/heavy.py:6\n-    return mass > limit\n+    return mass >= limit' in text
    assert text.count('heavy.py:5\n') == 1
    assert '0 of these by the time limit or a crash.' in text
    survivors = text[text.index('\npam_ros/small/heavy.py') :]
    assert run('pam_ros/small', '--jobs', '2') == (0, survivors)
    assert run('--report') == (0, survivors)
    for name, source in FILES.items():
        assert (tmp_path / name).read_text() == source


@pytest.mark.slow
def test_tests_that_fail_without_a_mutant_are_an_error(run, tmp_path):
    (tmp_path / 'test' / 'small' / 'test_heavy.py').write_text(
        'def test_it():\n    assert False\n'
    )
    code, text = run('pam_ros/small')
    assert code == 2
    assert text.startswith('mutation: the tests of pam_ros/small fail without a mutant.')


@pytest.mark.parametrize(
    ('arguments', 'sentence'),
    [
        (['test/small'], 'test/small is not a file or folder of pam_ros.'),
        (['pam_ros/large'], 'pam_ros/large is not a file or folder of pam_ros.'),
        (['pam_ros', '--sample', '0'], '--sample and --jobs must be at least 1.'),
        (['pam_ros', '--jobs', '0'], '--sample and --jobs must be at least 1.'),
    ],
)
def test_invalid_input_is_one_sentence(run, arguments, sentence):
    assert run(*arguments) == (2, f'mutation: {sentence}\n')


def test_a_report_without_results_is_an_error(run):
    code, text = run('--report')
    assert code == 2
    assert text.startswith('mutation: there are no results in ')
