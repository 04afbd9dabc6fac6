# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags and CSV files, drawn by the program without ROS."""

import http.client
import json
import signal
import subprocess
import sys

import matplotlib.image
import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.plot.recorded import read
from pam_ros.plot.topics import Key
from pam_ros.recording.mapping import ColumnMapping, read_mapping
from support import bags

NONE = ColumnMapping()
# Whatever imports ROS would fail where there is none.
WITHOUT_ROS = """
import runpy, sys
sys.modules['rclpy'] = None
runpy.run_module('pam_ros.cli.pam_plot', run_name='__main__', alter_sys=True)
"""


def command(*arguments):
    return [sys.executable, '-c', WITHOUT_ROS, *map(str, arguments)]


def run(*arguments):
    return subprocess.run(command(*arguments), capture_output=True, text=True, check=False)


def write_pair(path):
    stamps = [bags.ns(0.01 * k) for k in range(50)]
    arrays = {
        'pressures': [101325.0 + 1e5, 101325.0 + 2e5],
        'pressure_commands': [1.1e5, 2.1e5],
        'forces': [100.0, 200.0],
    }
    topics = {
        f'/arm/{name}': (bags.ARRAY, [(s, bags.numbers(values)) for s in stamps])
        for name, values in arrays.items()
    }
    states = [(s, bags.joint(s, [0.1, 0.2], names=('elbow', 'wrist'))) for s in stamps]
    topics['/arm/joint_states'] = (bags.JOINT, states)
    terms = [(s, bags.joint(s, [0.0, 0.15], names=('error', 'reference'))) for s in stamps]
    topics['/arm/pam_control/state'] = (bags.JOINT, terms)
    return bags.write_bag(path, topics)


def test_a_bag_of_one_muscle(tmp_path):
    topics, truth = bags.rig_topics()
    found = read(bags.write_bag(tmp_path / 'bag', topics), None, NONE)
    samples = found.curves.samples
    for key, name in (
        (Key('position', 'joint_states', 'pam'), 'position'),
        (Key('force', 'force'), 'force'),
        (Key('pressure', 'pressure'), 'pressure'),
        (Key('pressure', 'pressure_command'), 'command'),
    ):
        t, value = truth[name]
        # With the stamps of the headers, although those were received 0.2 ms later.
        assert samples[key][0] == pytest.approx(t, abs=1e-6)
        assert samples[key][1] == pytest.approx(value)
    assert found.start == 0.0
    assert found.end == pytest.approx(3.996, abs=1e-3)
    assert found.unit == ''


def test_a_bag_of_a_joint_in_a_namespace(tmp_path):
    found = read(write_pair(tmp_path / 'bag'), None, NONE)
    assert found.curves.muscles == ('flexor', 'extensor')
    last = {key: value[-1] for key, (_, value) in found.curves.samples.items()}
    assert last == pytest.approx(
        {
            Key('position', 'joint_states', 'elbow'): 0.1,
            Key('position', 'joint_states', 'wrist'): 0.2,
            Key('position', 'pam_control/state'): 0.15,
            Key('pressure', 'pressures', '0'): 1e5,
            Key('pressure', 'pressures', '1'): 2e5,
            Key('pressure', 'pressure_commands', '0'): 1.1e5,
            Key('pressure', 'pressure_commands', '1'): 2.1e5,
            Key('force', 'forces', '0'): 100.0,
            Key('force', 'forces', '1'): 200.0,
        }
    )


def test_one_of_several_rigs_is_chosen(tmp_path):
    left, _ = bags.rig_topics('/left', duration=1.0)
    right, _ = bags.rig_topics('/right', duration=1.0)
    bag = bags.write_bag(tmp_path / 'bag', {**left, '/right/force': right['/right/force']})
    with pytest.raises(RecordingError, match='namespaces /left, /right: choose one'):
        read(bag, None, NONE)
    assert list(read(bag, '/right', NONE).curves.samples) == [Key('force', 'force')]
    assert len(read(bag, 'left', NONE).curves.samples) > 3
    with pytest.raises(RecordingError, match='none of the topics that are drawn in the namespace'):
        read(bag, 'middle', NONE)


@pytest.mark.parametrize('is_headless', [False, True])
def test_a_csv_file(tmp_path, is_headless):
    file = tmp_path / 'rig.csv'
    rows = [f'{0.01 * k:.2f},{k},{k}.5,2.5,3.5' for k in range(100)]
    head = 't_s,position_mm,adc,flexor.pressure_kPa,extensor.pressure_kPa'
    file.write_text('\n'.join([*([] if is_headless else [head]), *rows, '']))
    names = head.split(',') if is_headless else ()
    found = read(file, None, read_mapping(['adc=force_N*2']), names)
    last = {key: value[-1] for key, (_, value) in found.curves.samples.items()}
    assert last == pytest.approx(
        {
            Key('position', 'joint_states', 'position'): 0.099,
            Key('force', 'force'): 199.0,
            Key('pressure', 'pressures', '0'): 2.5e3,
            Key('pressure', 'pressures', '1'): 3.5e3,
        }
    )
    assert found.unit == 'm'
    assert found.curves.muscles == ('flexor', 'extensor')
    assert found.end == pytest.approx(0.99)
    assert np.all(np.diff(next(iter(found.curves.samples.values()))[0]) > 0.0)


def test_a_bag_becomes_a_png_file(tmp_path):
    bag, png = write_pair(tmp_path / 'bag'), tmp_path / 'rig.png'
    done = run('--bag', bag, '--png', png, '--unit', 'rad')
    assert (done.returncode, done.stdout, done.stderr) == (0, f'wrote {png}\n', '')
    assert matplotlib.image.imread(png).shape[1] == 2160


def test_a_bag_becomes_a_page_until_ctrl_c(tmp_path):
    bag = write_pair(tmp_path / 'bag')
    with subprocess.Popen(command('--bag', bag), stdout=subprocess.PIPE, text=True) as program:
        try:
            address = program.stdout.readline().split()[1]
            connection = http.client.HTTPConnection(address.split('/')[2], timeout=60.0)
            connection.request('GET', '/data')
            found = json.loads(connection.getresponse().read())
            connection.close()
            program.send_signal(signal.SIGINT)
            assert program.wait(60.0) == 0
        finally:
            program.kill()
    assert found['live'] is False
    assert [panel['title'] for panel in found['panels']] == [
        'position, m or rad',
        'pressure (gauge), Pa',
        'force, N',
    ]
    names = [line['name'] for line in found['panels'][1]['lines']]
    assert names == ['flexor, commanded', 'extensor, commanded', 'flexor', 'extensor']


def test_help_needs_no_ros():
    done = run('--help')
    assert done.returncode == 0
    assert '--png FILE' in done.stdout


def test_bad_input_ends_it_with_a_sentence(tmp_path):
    bag = write_pair(tmp_path / 'bag')
    other = bags.write_bag(
        tmp_path / 'other', {'/notes': (bags.FLOAT, [(bags.EPOCH, bags.number(1.0))])}
    )
    table = tmp_path / 'table.csv'
    table.write_text('t_s,adc\n0,1\n1,2\n')
    broken = tmp_path / 'broken.mcap'
    broken.write_text('no bag')
    out = tmp_path / 'rig.png'
    for arguments, words in (
        (['--bag', tmp_path / 'nowhere', '--png', out], 'nowhere does not exist'),
        (['--bag', other, '--png', out], 'it has /notes (std_msgs/msg/Float64)'),
        (['--bag', broken, '--png', out], 'broken.mcap'),
        (['--bag', table, '--png', out], 'it has t_s, adc'),
        (['--bag', table, '--namespace', 'left'], '--namespace is for bags'),
        (['--bag', bag, '--column', 'adc=force_N'], '--column is for CSV files'),
        (['--bag', bag, '--columns', 't_s,force_N'], '--columns is for CSV files'),
        (['--bag', table, '--variable', 'a'], 'table.csv is not a MATLAB file'),
        (['--bag', table, '--sheet', 'a'], 'table.csv is not an Excel workbook'),
        (['--bag', bag, '--png', tmp_path / 'rig.pdf'], 'give a name that ends in .png'),
        (['--bag', bag, '--png', tmp_path / 'no' / 'rig.png'], 'does not exist'),
        (['--bag', bag, '--seconds', '3'], '--seconds is not allowed with --bag'),
        (['--bag', bag, '--wait', '3'], '--wait is not allowed with --bag'),
        (['--bag', bag, '--png', out, '--port', '80'], '--port is not allowed with --png'),
        (['--bag', bag, '--port', '70000'], 'give 1 to 65535'),
    ):
        done = run(*arguments)
        assert done.returncode == 2, arguments
        assert done.stderr.startswith('pam_plot: '), done.stderr
        assert done.stderr.count('\n') == 1, done.stderr
        assert words in done.stderr, done.stderr
    assert not out.exists()
