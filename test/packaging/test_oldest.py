# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pure rooms on the oldest numpy and scipy that are supported, without numba and ROS."""

import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = '.venv/oldest'  # kept between runs, as tools/environment knows when it is out of date
VERSIONS = ('3.12', '3.11', '3.10')  # what the oldest numpy and scipy have wheels for
# What needs ROS, and the truth plant: it is not a part of the package, and is tested only once.
NOT_PURE = ('nodes', 'packaging', 'truth')
INSTALLATION_DEADLINE = 600.0  # s; both only bound how long something broken may hang
TESTS_DEADLINE = 1200.0

pytestmark = [
    pytest.mark.release,
    pytest.mark.skipif(
        Path(sys.prefix) != ROOT / '.venv',
        reason='downloads packages, so it is left to the environment of the Makefile',
    ),
]


def base_python():
    """Return an interpreter of a fitting version: this one's own, or another that is there."""
    version = sysconfig.get_python_version()
    if version in VERSIONS:
        return str(Path(sys.base_prefix) / 'bin' / f'python{version}')
    for other in VERSIONS:
        found = shutil.which(f'python{other}')
        if (
            found
            and subprocess.run([found, '-V'], check=False, capture_output=True).returncode == 0
        ):
            return found
    return None


def test_pure_rooms_pass_on_the_oldest_libraries(clean_environment):
    python = base_python()
    if python is None:
        pytest.skip('no Python 3.10 to 3.12 here, and numpy 1.26 has no wheels for later ones')
    made = subprocess.run(
        ['tools/environment', FOLDER, 'requirements/oldest.txt'],
        cwd=ROOT,
        env={**clean_environment, 'PYTHON': python},
        capture_output=True,
        text=True,
        timeout=INSTALLATION_DEADLINE,
        check=False,
    )
    assert made.returncode == 0, made.stdout + made.stderr
    oldest = ROOT / FOLDER / 'bin' / 'python'
    no_ros = 'import importlib.util as u, sys; sys.exit(u.find_spec("rclpy") is not None)'
    subprocess.run([oldest, '-c', no_ros], env=clean_environment, check=True)
    # Pure tests may share the machine, unlike those that keep a rate.
    pure = [f'--ignore=test/{room}' for room in NOT_PURE]
    tested = subprocess.run(
        [oldest, '-m', 'pytest', 'test', '-n', 'auto', '-p', 'no:cacheprovider', *pure],
        cwd=ROOT,
        env=clean_environment,
        capture_output=True,
        text=True,
        timeout=TESTS_DEADLINE,
        check=False,
    )
    assert tested.returncode == 0, tested.stdout + tested.stderr
    assert re.search(r'numpy 1\.26\.\d+, scipy 1\.11\.\d+, without numba', tested.stdout)
    assert re.search(r'\d+ passed', tested.stdout)
