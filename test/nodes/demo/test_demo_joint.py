# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The demonstration of the antagonistic joint, as a user runs it."""

import subprocess
import sys

import pytest
from matplotlib.image import imread


@pytest.mark.at_any_pace
@pytest.mark.release
@pytest.mark.usefixtures('domain')
def test_a_joint_is_led_by_angle_and_stiffness_over_topics(tmp_path):
    done = subprocess.run(
        [sys.executable, '-m', 'pam_ros.cli.pam_demo', 'joint', '--out', 'shown'],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    folder = tmp_path / 'shown'
    assert {path.name for path in folder.iterdir()} == {'joint.png', 'joint.txt'}
    assert imread(folder / 'joint.png').std() > 0.05
    text = (folder / 'joint.txt').read_text(encoding='utf-8')
    assert text.strip() in done.stdout
    _, *sines, rest = text.splitlines()
    for row, wanted_stiffness in zip(sines, (20.0, 35.0), strict=True):
        *_, rms, _, _, _, stiffness, wanted = row.split()
        assert float(rms) < 0.2  # degrees, with a third more load than was configured
        assert float(wanted) == wanted_stiffness
        assert abs(float(stiffness) - wanted_stiffness) < 0.05
    *_, largest, _, stiffness, wanted = rest.split()
    assert float(largest) < 0.2  # four or five times the noise of the sensor, and what it lacks
    assert float(wanted) == 20.0
    assert abs(float(stiffness) - 20.0) < 0.05
