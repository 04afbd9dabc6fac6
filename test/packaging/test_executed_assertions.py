# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The suite fails a test that passes without having executed an assertion."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
TESTS = """
import numpy as np
import pytest
from numpy.testing import assert_array_equal
from support.one_check import check


def test_with_an_assertion():
    assert True


def test_with_one_of_numpy():
    np.testing.assert_allclose(1.0, 1.0)


def test_with_an_imported_one_of_numpy():
    assert_array_equal([1.0], [1.0])


def test_with_an_expected_error():
    with pytest.raises(ValueError):
        int('x')


def test_with_one_of_a_helper():
    check(1)


@pytest.mark.parametrize('items', [[], [1]], ids=['none', 'one'])
def test_in_a_loop(items):
    for item in items:
        assert item


@pytest.fixture
def checked():
    assert True


def test_with_that_of_a_fixture(checked):
    pass


def test_behind_a_condition():
    if not ROOT:
        assert False


ROOT = 1


def test_that_is_skipped():
    pytest.skip('for a reason')
"""
HELPER = """
def check(value):
    assert value
"""
# Settings and hooks of the suite, but its own tests.
CONFTEST = """
import pytest
pytest.register_assert_rewrite('support')
pytest_plugins = ['support.assertions']
"""


def test_a_test_that_executes_no_assertion_fails(tmp_path):
    support = tmp_path / 'test' / 'support'
    support.mkdir(parents=True)
    (support / 'one_check.py').write_text(HELPER)
    source = (ROOT / 'test' / 'support' / 'assertions.py').read_text()
    (support / 'assertions.py').write_text(source)
    (tmp_path / 'conftest.py').write_text(CONFTEST)
    (tmp_path / 'test' / 'test_some.py').write_text(TESTS)
    (tmp_path / 'pyproject.toml').write_text((ROOT / 'pyproject.toml').read_text())
    ran = subprocess.run(
        [sys.executable, '-m', 'pytest', '-rA', '-p', 'no:cacheprovider', 'test'],
        cwd=tmp_path,
        env={k: v for k, v in os.environ.items() if not k.startswith('PYTEST_')},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    lines = [line.split() for line in ran.stdout.splitlines()]
    failed = [words[1].split('::')[1] for words in lines if words[:1] == ['FAILED']]
    passed = [words for words in lines if words[:1] == ['PASSED']]
    assert failed == ['test_in_a_loop[none]', 'test_behind_a_condition'], ran.stdout
    assert len(passed) == 7, ran.stdout
    assert ran.returncode == 1
