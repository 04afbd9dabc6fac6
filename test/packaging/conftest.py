# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A copy of the checkout to build from, and an environment that no other ROS has touched."""

import os
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
# What the commands of the Makefile, and the tools behind them, leave in a checkout.
LEFT_BEHIND = shutil.ignore_patterns(
    '.*_cache', '.git', '.hypothesis', '.venv', '*.egg-info', '__pycache__',
    'build', 'demo', 'install', 'log',
)  # fmt: skip
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
    """Return a copy of the checkout as it is in git, more or less: sources alone."""
    folder = tmp_path_factory.mktemp('sources') / 'pam_ros'
    shutil.copytree(ROOT, folder, ignore=LEFT_BEHIND)
    return folder


@pytest.fixture(scope='session')
def clean_environment():
    """Return the environment variables without those of a ROS that is already set up."""
    return {name: value for name, value in os.environ.items() if name not in OF_A_SOURCED_ROS}
