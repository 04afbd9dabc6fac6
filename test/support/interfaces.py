# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Packages of messages that are on no package index as wheels: they are built for the tests."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from support.distribution import IS_JAZZY

PACKAGES = Path(__file__).parents[1] / 'interfaces'
TOOLS = ('cmake', 'make', 'c++')
DEADLINE = 600.0  # s; bounds how long a build that hangs may take


def built(name, folder):
    """Build the package *name* of messages into *folder*; return what programs need to use it.

    These are environment variables. Skips the test where there is no compiler.
    """
    if not IS_JAZZY:
        pytest.skip('the packages that build messages are installed for Jazzy alone')
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        pytest.skip(f'to build {name} for this test, install {", ".join(missing)}')
    prefix, build = Path(sys.prefix), folder / 'build'
    environment = {
        **os.environ,
        'AMENT_PREFIX_PATH': str(prefix),
        'PATH': f'{prefix / "bin"}:{os.environ["PATH"]}',
    }
    options = (
        f'-DCMAKE_PREFIX_PATH={prefix}',
        f'-DCMAKE_INSTALL_PREFIX={folder / "install"}',
        f'-DPython3_EXECUTABLE={sys.executable}',
        '-DBUILD_TESTING=OFF',
    )
    for step in (
        ('cmake', '-S', str(PACKAGES / name), '-B', str(build), *options),
        ('cmake', '--build', str(build), '--parallel', '2', '--target', 'install'),
    ):
        done = subprocess.run(
            step, env=environment, capture_output=True, text=True, timeout=DEADLINE, check=False
        )
        assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]
    installed = folder / 'install'
    (modules,) = installed.glob('lib/python3*/site-packages')
    return {
        'AMENT_PREFIX_PATH': _before(installed, 'AMENT_PREFIX_PATH'),
        'LD_LIBRARY_PATH': _before(installed / 'lib', 'LD_LIBRARY_PATH'),
        'PYTHONPATH': _before(modules, 'PYTHONPATH'),
    }


def _before(path, variable):
    """Return the value of a variable of paths with *path* as the first."""
    return ':'.join([str(path), *filter(None, [os.environ.get(variable)])])
