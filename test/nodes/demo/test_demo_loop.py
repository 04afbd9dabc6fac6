# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The loop closed over DDS: excited, recorded, identified, simulated better."""

import json
import subprocess
import sys

import pytest

from pam_ros.demo.loop import HIDDEN, NOISE
from pam_ros.nodes.demo.loop import EXCITATION
from pam_ros.recording.read import read_recording
from pam_ros.report.write import FILES


@pytest.mark.needs_numba
@pytest.mark.at_any_pace
@pytest.mark.slow
@pytest.mark.usefixtures('domain')
def test_the_loop_closes_over_topics(tmp_path):
    done = subprocess.run(
        [sys.executable, '-m', 'pam_ros.cli.pam_demo', 'loop', '--out', 'shown'],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    folder = tmp_path / 'shown' / 'loop'
    assert {path.name for path in folder.iterdir()} == {
        'recording',
        'report',
        'replay',
        'before_and_after.png',
        'before_and_after.txt',
    }
    assert {path.name for path in (folder / 'report').iterdir()} == set(FILES)

    recording = read_recording(folder / 'recording')
    assert recording.kind == 'free'
    assert recording.period == pytest.approx(1 / EXCITATION['rate'], rel=1e-6)
    assert recording.command.size > 0.9 * EXCITATION['duration'] * EXCITATION['rate']

    report = json.loads((folder / 'report' / 'report.json').read_text(encoding='utf-8'))
    table = (folder / 'before_and_after.txt').read_text(encoding='utf-8')
    assert table.strip() in done.stdout

    assert report['verdict'] == 'effect_found'
    hidden = {name.split('.')[1] for name in HIDDEN if name.startswith('effects.')}
    found = [{effect['name'], *effect['alternatives']} for effect in report['effects']]
    assert len(found) == len(hidden)
    assert all(len(names & hidden) == 1 for names in found)
    assert hidden <= set().union(*found)
    assert report['error']['noise_floor'] == pytest.approx(NOISE, rel=0.3)
    parameters = report['parameters']['augmented']
    for name, true in HIDDEN.items():
        if name.startswith('effects.'):
            assert parameters[name]['value'] == pytest.approx(true, rel=0.02)

    rows = {line.split('  ')[0]: line.split() for line in table.splitlines()}
    before, after = float(rows['nominal'][1]), float(rows['identified'][1])
    assert before > 1.0
    # In lockstep no command is late: what remains is the noise of the sensor.
    assert 1e-3 * after < 1.1 * NOISE
