# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The demonstration of position control, as a user runs it."""

import subprocess
import sys

import pytest
from matplotlib.image import imread


@pytest.mark.at_any_pace
@pytest.mark.release
@pytest.mark.usefixtures('domain')
def test_a_load_is_led_over_topics(tmp_path):
    done = subprocess.run(
        [sys.executable, '-m', 'pam_ros.cli.pam_demo', 'position', '--out', 'shown'],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    folder = tmp_path / 'shown'
    assert {path.name for path in folder.iterdir()} == {
        'position_control.png',
        'position_control.txt',
    }
    assert imread(folder / 'position_control.png').std() > 0.05
    text = (folder / 'position_control.txt').read_text(encoding='utf-8')
    assert text.strip() in done.stdout
    _, *steps, sine = text.splitlines()
    assert [row.split()[0] for row in steps] == ['70.0', '50.0', '60.0']
    for row in steps:
        _, _, settled, _, error, *_ = row.split()
        assert float(settled) < 2.4
        assert float(error) < 100.0  # um, with a quarter more load than was configured
    assert float(sine.split()[-3]) < 100.0
