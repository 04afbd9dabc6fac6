# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The source distribution has the examples, which the wheel does not install."""

import tarfile

import pytest

pytest.importorskip('setuptools')
BUILD = 'import sys; from setuptools.build_meta import build_sdist; build_sdist(sys.argv[1])'


def test_it_has_the_package_and_the_examples(build, sources, tmp_path):
    build('-c', BUILD, str(tmp_path))
    (file,) = tmp_path.glob('*.tar.gz')
    with tarfile.open(file) as opened:
        packed = {name.partition('/')[2] for name in opened.getnames()}
    expected = {
        path.relative_to(sources).as_posix() for path in (sources / 'examples').glob('*.py')
    }
    assert expected
    assert expected | {'setup.py', 'package.xml', 'pam_ros/__init__.py'} <= packed
