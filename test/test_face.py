# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The public names, and the page that shows them."""

import inspect
import pydoc
import subprocess
import sys
from pathlib import Path

import pytest

import pam_ros

ROOT = Path(__file__).parents[1]
PAGE = ROOT / 'docs' / 'python.md'


def test_public_names_are_there():
    for name in pam_ros.__all__:
        assert getattr(pam_ros, name) is not None
        assert name in dir(pam_ros)


def test_an_unknown_name_is_refused():
    with pytest.raises(AttributeError, match='has no attribute nosuch'):
        _ = pam_ros.nosuch


def test_each_effect_is_public():
    assert {effect.__name__ for effect in pam_ros.EFFECTS} <= set(pam_ros.__all__)


def test_a_star_import_gives_all_names():
    names = {}
    exec('from pam_ros import *', names)
    assert set(pam_ros.__all__) <= set(names)


def test_the_package_alone_imports_nothing_heavy():
    code = (
        'import sys, pam_ros; print([n for n in ("numpy", "scipy", "numba") if n in sys.modules])'
    )
    done = subprocess.run(
        [sys.executable, '-c', code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == '[]'


def test_it_is_imported_from_a_folder_that_contains_the_checkout(tmp_path):
    (tmp_path / 'pam_ros').symlink_to(ROOT)  # as in the src of a workspace
    code = 'from pam_ros import Muscle; print(Muscle().l0)'
    done = subprocess.run(
        [sys.executable, '-c', code], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.returncode) == ('0.4\n', 0), done.stderr


def test_the_page_names_all_that_is_public():
    page = PAGE.read_text(encoding='utf-8')
    missing = [name for name in pam_ros.__all__ if f'`{name}`' not in page]
    assert missing == ['__version__']


def test_help_of_public_names_can_be_read():
    for name in set(pam_ros.__all__) - {'__version__'}:
        public = getattr(pam_ros, name)
        assert len(pydoc.render_doc(public)) < 12_000, name
        if callable(public) and public is not pam_ros.PamError:  # Python's own
            assert len(str(inspect.signature(public))) < 2_000, name
