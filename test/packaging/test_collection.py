# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""All tests are found where ROS is installed: its launch_testing brings pytest a plugin.

It imports each file as a module of its bare name, so that no two files may share one.
"""

import ast
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
STAND_IN = 'support.launch_testing_stand_in'
LONGEST = 200  # characters of the id of a test


def collected(*options):
    """Return the tests that a pytest of its own finds, as it names them; and what it printed."""
    paths = [ROOT, ROOT / 'test', *filter(None, [os.environ.get('PYTHONPATH')])]
    ran = subprocess.run(
        [sys.executable, '-m', 'pytest', '--collect-only', '-q', *options],
        cwd=ROOT,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(map(str, paths))},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    return [line for line in ran.stdout.splitlines() if '::' in line], ran


def test_no_two_test_files_have_the_same_name():
    names = Counter(path.name for path in (ROOT / 'test').rglob('test_*.py'))
    assert [name for name, count in names.items() if count > 1] == []


def test_no_helper_has_a_name_that_pytest_calls_by_itself():
    """Before version 8 it takes setup() and teardown() for those of nose."""
    defined = [
        (path.name, node.name)
        for path in (ROOT / 'test').rglob('test_*.py')
        for node in ast.parse(path.read_text(encoding='utf-8')).body
        if isinstance(node, ast.FunctionDef)
    ]
    assert len(defined) > 3000
    assert [one for one in defined if one[1] in ('setup', 'teardown')] == []


@pytest.mark.slow
def test_the_plugin_of_launch_testing_finds_every_test():
    plain, ran = collected()
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert len(plain) > 3000
    assert max(map(len, plain)) <= LONGEST
    with_plugin, ran = collected('-p', STAND_IN)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert with_plugin == plain
    # Where ROS is installed there is no Sybil: the tests are collected without the pages.
    without_sybil, ran = collected('-p', 'support.no_sybil')
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert without_sybil == [name for name in plain if '.md::' not in name]
