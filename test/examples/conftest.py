# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Run an example as a user does; where there is no ROS, the one over topics is left out."""

import importlib.util
import os
import subprocess
import sys

import pytest

from support.pages import ROOT

DEADLINE = 300.0  # s; bounds how long an example that hangs may take
collect_ignore = [] if importlib.util.find_spec('rclpy') else ['test_own_controller.py']


@pytest.fixture
def run_example(tmp_path):
    """Return a function that runs an example in an empty folder, warnings being errors."""

    def run(name, *arguments):
        paths = [str(ROOT), *filter(None, [os.environ.get('PYTHONPATH')])]
        return subprocess.run(
            [sys.executable, '-W', 'error', ROOT / 'examples' / name, *arguments],
            cwd=tmp_path,
            env={**os.environ, 'PYTHONPATH': os.pathsep.join(paths)},
            capture_output=True,
            text=True,
            timeout=DEADLINE,
            check=False,
        )

    return run
