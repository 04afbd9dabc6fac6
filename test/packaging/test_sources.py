# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What holds for every source file: its header, and which rooms may see ROS."""

import sys
from pathlib import Path

import pytest

from support.imports import imported

ROOT = Path(__file__).parents[2]
HEADER = ['# Copyright 2026 The pam_ros authors', '# SPDX-License-Identifier: Apache-2.0']
FOLDERS = ('pam_ros', 'test', 'launch', 'benchmarks', 'tools')
FILES = sorted(
    path.relative_to(ROOT)
    for path in [ROOT / 'setup.py', *(p for f in FOLDERS for p in (ROOT / f).rglob('*.py'))]
)
PURE = [path for path in FILES if path.parts[0] == 'pam_ros' and path.parts[1] != 'nodes']
# What the pure rooms may import beside themselves and Python's own library.
ALLOWED = {
    *('jinja2', 'matplotlib', 'mcap', 'numba', 'numpy', 'rosbags', 'scipy'),
    *('simple_pid', 'tqdm', 'yaml'),
    'pam_ros',
}
# Reads bags with ROS' own library where that is installed.
MAY_SEE_ROS = {Path('pam_ros/recording/bag_source.py'): {'rosbag2_py', 'rclpy'}}


@pytest.mark.parametrize('path', FILES, ids=str)
def test_file_says_whose_it_is(path):
    lines = (ROOT / path).read_text(encoding='utf-8').splitlines()
    start = 1 if lines[0].startswith('#!') else 0
    assert lines[start : start + 2] == HEADER


@pytest.mark.parametrize('path', PURE, ids=str)
def test_pure_room_sees_no_ros(path):
    assert imported(ROOT / path) - sys.stdlib_module_names <= ALLOWED | MAY_SEE_ROS.get(
        path, set()
    )


def test_license_is_apache():
    text = (ROOT / 'LICENSE').read_text(encoding='utf-8')
    assert 'Apache License' in text
    assert 'END OF TERMS AND CONDITIONS' in text
