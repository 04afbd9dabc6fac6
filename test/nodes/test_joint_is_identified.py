# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A joint is excited, recorded and identified, each by the program that users start for it."""

import json
import subprocess
import sys

import pytest

from pam_ros.settings.files import write
from support.bags import contents
from support.harness import DEADLINE, Peer, Program

pytestmark = pytest.mark.usefixtures('module_domain')

RIG = {'joint': 'antagonistic', 'muscles': ['flexor', 'extensor'], 'radius': 0.05}
LACKS = {'extensor.effects.pressure_lag.fill': 0.06, 'sensor.position_noise': 2e-4}
LOCKSTEP = {'time_mode': 'lockstep', 'publish_rate': 100.0, 'clock_rate': 100.0}
PLAN = {'duration': 40.0, 'rate': 100.0, 'countdown': 0.0, 'silence': 10.0}
# The rig and the recorder.
PLAN |= {'use_sim_time': True, 'subscribers': 2, 'patience': DEADLINE}


@pytest.fixture(scope='module')
def bag(module_domain, tmp_path_factory):
    """Return the recording of a joint, one muscle of which has a lag that the file lacks."""
    bag = tmp_path_factory.mktemp('joint') / 'bag'
    recorder = ('-p', 'use_sim_time:=true', '--', '-o', str(bag))
    with (
        Peer() as peer,
        Program('pam_sim', parameters={**RIG, **LACKS, **LOCKSTEP}),
        Program('pam_record', *recorder) as record,
    ):
        peer.until(lambda: peer.node.count_subscribers('joint_states'), 'the recorder')
        with Program('pam_excite', parameters={**RIG, **PLAN}) as excite:
            assert excite.process.wait(2.0 * DEADLINE) == 0, excite.output
        record.stop()
    return bag


def test_the_commands_of_both_muscles_are_recorded_from_the_first_on(bag):
    messages = [message for _, message in contents(bag)['/pressure_commands']]
    assert len(messages) > 0.99 * PLAN['duration'] * PLAN['rate']
    assert {message.layout.dim[0].label for message in messages} == {'flexor,extensor'}
    assert not any(messages[0].data)
    assert not any(messages[-1].data)


@pytest.mark.needs_numba
def test_the_recording_shows_what_the_joint_lacks_and_in_which_muscle(bag, tmp_path):
    write(tmp_path / 'arm.yaml', {**RIG, 'muscles': tuple(RIG['muscles'])})
    options = ('--params', 'arm.yaml', '--out', 'report')
    done = subprocess.run(
        [sys.executable, '-m', 'pam_ros.cli.pam_identify', str(bag), *options],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / 'report' / 'report.json').read_text(encoding='utf-8'))
    assert report['verdict'] == 'effect_found'
    (found,) = report['effects']
    assert (found['name'], found['muscle']) == ('pressure_lag', 'extensor')
    fill = report['parameters']['augmented']['extensor.effects.pressure_lag.fill']
    assert fill['value'] == pytest.approx(0.06, rel=0.02)
    command = 'pam_excite --ros-args --params-file FILE -p segments:='
    assert report['next_command'].startswith(command)
