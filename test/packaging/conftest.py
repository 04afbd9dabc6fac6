# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A copy of the checkout to build from, and the environment variables to do it with."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DEADLINE = 300.0  # s, only bounds how long something broken may hang
# What the commands of the Makefile, and the tools behind them, leave in a checkout: in its top
# folder, and in any.
ON_TOP = {'.git', '.hypothesis', '.venv', 'build', 'demo', 'install', 'log'}
ANYWHERE = shutil.ignore_patterns('*.egg-info', '.*_cache', '__pycache__')
OF_A_SOURCED_ROS = (
    '_ROS_WHEELS_BOOTSTRAP_COMPLETE',
    'AMENT_PREFIX_PATH',
    'CMAKE_PREFIX_PATH',
    'COLCON_PREFIX_PATH',
    'LD_LIBRARY_PATH',
    'PYTHONPATH',
)


@pytest.fixture(scope='session')
def root():
    """Return the folder of the checkout."""
    return ROOT


@pytest.fixture(scope='session')
def sources(tmp_path_factory):
    """Return a copy of the checkout: its sources alone."""
    folder = tmp_path_factory.mktemp('sources') / 'pam_ros'
    shutil.copytree(ROOT, folder, ignore=left_behind)
    return folder


@pytest.fixture(scope='session')
def build(sources):
    """Return a function that runs Python with some arguments in the sources; it must succeed."""

    def run(*arguments):
        done = subprocess.run(
            [sys.executable, *arguments],
            cwd=sources,
            capture_output=True,
            text=True,
            timeout=DEADLINE,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr

    return run


def left_behind(folder, names):
    """Return the names in a folder that are none of the sources, as copytree asks for them."""
    return ANYWHERE(folder, names) | (ON_TOP if Path(folder) == ROOT else set())


@pytest.fixture(scope='session')
def clean_environment():
    """Return the environment variables, on a machine without ROS also without the wheels' own.

    The wheels set up a process and its children for one environment; another environment, or a
    workspace, starts from the shell. Where ROS is installed its variables are needed.
    """
    if '_ROS_WHEELS_BOOTSTRAP_COMPLETE' not in os.environ:
        return dict(os.environ)
    return {name: value for name, value in os.environ.items() if name not in OF_A_SOURCED_ROS}
