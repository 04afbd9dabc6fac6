# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The example of a joint reaches both angles and draws them."""

import re

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]


def test_it_reaches_both_angles_and_writes_the_picture(run_example, tmp_path):
    done = run_example('joint_from_python.py', 'joint.png')
    assert (done.returncode, done.stderr) == (0, '')
    after = [float(angle) for angle in re.findall(r'(\S+) (?:degrees )?after', done.stdout)]
    assert after == pytest.approx([20.0, -10.0], abs=0.1)
    assert (tmp_path / 'joint.png').read_bytes().startswith(b'\x89PNG')


@pytest.mark.parametrize('picture', ['absent/joint.png', 'joint.nosuch'])
def test_a_picture_that_cannot_be_written_is_one_sentence(run_example, picture):
    done = run_example('joint_from_python.py', picture)
    assert done.returncode == 2
    assert f'{picture} cannot be written: ' in done.stderr
    assert 'Traceback' not in done.stderr
