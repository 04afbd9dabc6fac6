# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Packages of messages that are on no package index as wheels: they are built for the tests."""

import fcntl
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


def built(name, factory):
    """Build the package *name* of messages; return what programs need to use it.

    These are environment variables. *factory* is ``tmp_path_factory``: a run of pytest builds the
    package once for all its workers. Skips the test where there is no compiler.
    """
    if not IS_JAZZY:
        pytest.skip('the packages that build messages are installed for Jazzy alone')
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        pytest.skip(f'to build {name} for this test, install {", ".join(missing)}')
    base = factory.getbasetemp()
    folder = (base.parent if 'PYTEST_XDIST_WORKER' in os.environ else base) / name
    folder.mkdir(exist_ok=True)
    installed = folder / 'install'
    with (folder / 'lock').open('w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / 'complete').exists():
            _build(PACKAGES / name, folder / 'build', installed)
            (folder / 'complete').touch()
    (modules,) = installed.glob('lib/python3*/site-packages')
    return {
        'AMENT_PREFIX_PATH': _before(installed, 'AMENT_PREFIX_PATH'),
        'LD_LIBRARY_PATH': _before(installed / 'lib', 'LD_LIBRARY_PATH'),
        'PYTHONPATH': _before(modules, 'PYTHONPATH'),
    }


def _build(source, build, installed):
    """Build and install the package in the folder *source*."""
    prefix = Path(sys.prefix)
    environment = {
        **os.environ,
        'AMENT_PREFIX_PATH': str(prefix),
        'PATH': f'{prefix / "bin"}:{os.environ["PATH"]}',
    }
    options = (
        f'-DCMAKE_PREFIX_PATH={prefix}',
        f'-DCMAKE_INSTALL_PREFIX={installed}',
        f'-DPython3_EXECUTABLE={sys.executable}',
        '-DBUILD_TESTING=OFF',
    )
    for step in (
        ('cmake', '-S', str(source), '-B', str(build), *options),
        ('cmake', '--build', str(build), '--parallel', '2', '--target', 'install'),
    ):
        done = subprocess.run(
            step, env=environment, capture_output=True, text=True, timeout=DEADLINE, check=False
        )
        assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]


def _before(path, variable):
    """Return the value of a variable of paths with *path* as the first."""
    return ':'.join([str(path), *filter(None, [os.environ.get(variable)])])
