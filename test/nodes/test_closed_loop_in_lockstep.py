# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A controller's test as a CI runs it: 20 s of a closed loop in lockstep, the same to the bit.

``docs/ros2_control.md`` explains it; the controller is ``test/support/example_controller.py``.
"""

import os
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest

from support.harness import Program

CONTROLLER = Path(__file__).parents[1] / 'support' / 'example_controller.py'
SECONDS = 20.0
BUSY = [sys.executable, '-c', 'while True: pass']
RIG = {'time_mode': 'lockstep', 'sensor.position_noise': 5e-6}


def run(file, busy=0):
    """Run the scenario with *busy* other programs on the machine, and return what was seen."""
    with ExitStack() as stack:
        for _ in range(busy):
            other = stack.enter_context(subprocess.Popen(BUSY))
            stack.callback(other.kill)
        stack.enter_context(Program('pam_sim', parameters=RIG))
        subprocess.run([sys.executable, CONTROLLER, str(SECONDS), file], check=True, timeout=300)
    return np.load(file)


@pytest.fixture(scope='module')
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp('runs')
    busy = (0, 0, 2 * (os.cpu_count() or 1))
    return [run(folder / f'{i}.npz', n) for i, n in enumerate(busy)]


def test_the_reference_is_tracked(runs):
    t, error = runs[0]['t'], runs[0]['position'] - runs[0]['reference']
    assert len(t) == SECONDS * 500 + 1
    np.testing.assert_allclose(np.diff(t), 2e-3, atol=1e-9)
    settled = error[t > 4.0]
    assert np.sqrt(np.mean(settled**2)) < 0.6e-3  # m, of a sine of 20 mm
    assert np.max(np.abs(settled)) < 2e-3
    assert np.ptp(runs[0]['position'][t > 4.0]) > 0.038


def test_three_runs_are_the_same_to_the_bit_one_of_them_on_a_busy_machine(runs):
    for other in runs[1:]:
        for name in ('t', 'reference', 'position', 'pressure'):
            assert runs[0][name].tobytes() == other[name].tobytes(), name
