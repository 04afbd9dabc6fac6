# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The command on recordings of a joint of two muscles: report, parameter file, bad input."""

import json
import signal
import subprocess
import sys

import numpy as np
import pytest

from pam_ros.cli import pam_identify
from pam_ros.recording.csv_file import write_csv
from pam_ros.recording.recording import Recording
from pam_ros.rig.run import simulate
from pam_ros.settings.load import load_joint
from pam_ros.settings.nominal import nominal_joint
from support.by_name import by_name
from support.pages import ROOT

pytestmark = pytest.mark.needs_numba

NAMES = ('flexor', 'extensor')
LAG = {'flexor.effects.pressure_lag.fill': 0.06, 'flexor.effects.pressure_lag.vent': 0.09}
JOINT = """
/**:
  ros__parameters:
    joint: antagonistic
    muscles: [flexor, extensor]
    mass: 1.0
    arm: 0.25
"""


def recording(joint, seed, duration):
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, duration, 0.01)
    levels = np.repeat(rng.uniform(-120e3, 120e3, round(duration / 1.5) + 1), 150)[: t.size]
    more = levels + 50e3 * np.sin(2.5 * t)
    common = 260e3 + 60e3 * np.sin(0.3 * t)
    command = np.stack([common + more, common - more], axis=1)
    angle = simulate(joint, t, command).position + rng.normal(0.0, 2e-4, t.size)
    return Recording('elbow', t, t, command, angle, muscles=NAMES, unit='rad')


@pytest.fixture(scope='module')
def bench(tmp_path_factory):
    folder = tmp_path_factory.mktemp('elbow')
    (folder / 'elbow.yaml').write_text(JOINT, encoding='utf-8')
    truth = load_joint(folder / 'elbow.yaml', LAG)
    write_csv(recording(truth, 1, 24.0), folder / 'fit.csv')
    write_csv(recording(truth, 2, 15.0), folder / 'test.csv')
    lines = (folder / 'fit.csv').read_text(encoding='utf-8').splitlines()
    lines[0] = lines[0].replace('extensor.pressure_command_Pa', 'valve')
    (folder / 'missing.csv').write_text('\n'.join(lines) + '\n', encoding='utf-8')
    slides = [lines[0].replace('valve', 'extensor.pressure_command_Pa'), *lines[1:]]
    slides[0] = slides[0].replace('position_rad', 'position_cm')
    (folder / 'slides.csv').write_text('\n'.join(slides) + '\n', encoding='utf-8')
    idle = recording(truth, 3, 15.0)
    idle.command[:, 1] = 2.5e5
    write_csv(idle, folder / 'idle.csv')
    return folder


def run(folder, *arguments):
    done = subprocess.run(
        [sys.executable, '-m', 'pam_ros.cli.pam_identify', *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    return done.returncode, done.stdout.strip(), done.stderr


@pytest.fixture(scope='module')
def found(bench):
    arguments = ('fit.csv', '--params', 'elbow.yaml', '--test', 'test.csv', '--out', 'found')
    return run(bench, *arguments, '--uncertain', 'radius=1e-9', '--verbose'), bench / 'found'


def test_the_last_line_names_the_effect_and_its_muscle(found):
    (code, out, errors), _ = found
    assert code == 0, errors
    line = out.splitlines()[-1]
    assert 'Fits ' in out  # with --verbose
    assert 'Effects that were tried ' in out
    assert line.startswith('effect_found (pressure_lag of flexor): held-out error ')
    assert ' mrad with pressure_lag of flexor; noise 0.19' in line


def test_what_the_recordings_cannot_determine_is_told_before_the_fit(found):
    (_, _, errors), _ = found
    first, second, *_ = errors.splitlines()
    assert first.startswith('the recordings hardly determine radius: ')
    assert second == '  0 %  re-tuning the parameters'


def test_the_report_names_the_muscle_with_the_effect(found):
    _, folder = found
    content = json.loads((folder / 'report.json').read_text(encoding='utf-8'))
    (effect,) = content['effects']
    assert (effect['name'], effect['muscle']) == ('pressure_lag', 'flexor')
    assert effect['parameters']['fill']['value'] == pytest.approx(0.06, abs=1e-3)
    assert content['error']['unit'] == 'rad'
    assert content['error']['augmented']['held_out'] < 3e-4
    names = {(c['name'], c['muscle']) for c in content['candidates']}
    assert {('pressure_lag', None), ('pressure_lag', 'extensor'), ('payload', None)} < names
    (fitted, _) = content['data']['recordings']
    assert fitted['unit'] == 'rad'
    assert {f'{name}.pressure_command' for name in NAMES} < set(fitted['ranges'])
    text = (folder / 'report.html').read_text(encoding='utf-8')
    assert 'pressure lag of flexor' in text
    assert 'flexor.pressure_lag' not in text


def test_report_of_an_angle_is_valid(found):
    jsonschema = pytest.importorskip('jsonschema')
    _, folder = found
    schema = json.loads((ROOT / 'docs' / 'report.schema.json').read_text(encoding='utf-8'))
    content = json.loads((folder / 'report.json').read_text(encoding='utf-8'))
    problems = jsonschema.Draft202012Validator(schema).iter_errors(content)
    assert [f'{problem.json_path}: {problem.message}' for problem in problems] == []


def test_the_parameter_file_is_the_joint_that_was_found(found):
    _, folder = found
    again = nominal_joint(folder / 'identified.yaml')
    assert (again.muscles, again.kind.name) == (NAMES, 'antagonistic')
    first, second = again.joint.actuators
    assert by_name(first.effects)['pressure_lag'].fill == pytest.approx(0.06, abs=1e-3)
    assert not second.effects
    assert first.muscle != second.muscle
    assert again.joint.load.arm == 0.25
    assert load_joint(folder / 'identified.yaml') == again.joint


@pytest.mark.parametrize(
    ('arguments', 'words'),
    [
        (
            ('missing.csv', '--params', 'elbow.yaml'),
            'missing.csv has flexor.pressure_command_Pa but no extensor.pressure_command: a '
            'column is needed for each of flexor, extensor',
        ),
        (
            ('fit.csv', '--params', 'dmsp_20_400n'),
            'fit.csv: the position is in rad, and the model moves in m',
        ),
        (
            ('slides.csv', '--params', 'dmsp_20_400n'),
            'slides.csv is a recording of 2 muscle(s), and the joint has 1',
        ),
        (
            ('fit.csv', '--params', 'elbow.yaml', '--set', 'muscles=one'),
            'muscles: 1 names do not fit joint = antagonistic: give 2 for each joint',
        ),
        (
            ('idle.csv', '--params', 'elbow.yaml'),
            'idle.csv: extensor.pressure_command is constant at 250000 Pa: record changes of the '
            'pressures of all muscles',
        ),
        (
            ('fit.csv', '--params', 'elbow.yaml', '--uncertain', 'nosuch=5%'),
            'the uncertain parameter nosuch is not one that a recording of this joint can '
            'determine: give one of flexor.a1, a1, ',
        ),
        (
            ('fit.csv', '--params', 'elbow.yaml', '--uncertain', 'inertia'),
            '--uncertain inertia is not allowed: give NAME=DEVIATION, such as inertia=50%',
        ),
        (
            ('fit.csv', '--params', 'elbow.yaml', '--uncertain', 'inertia=-5%'),
            "uncertain inertia = '-5%' is not allowed: give a standard deviation above 0: in the "
            "parameter's unit, or as a share such as 50%",
        ),
    ],
)
def test_bad_input_is_one_sentence(bench, monkeypatch, capsys, arguments, words):
    # In this process: the imports of another one take far longer than to find the mistake.
    monkeypatch.chdir(bench)
    monkeypatch.setattr(sys, 'argv', ['pam_identify', *arguments, '--out', 'none'])
    on_sigterm = signal.getsignal(signal.SIGTERM)
    with pytest.raises(SystemExit) as end:
        pam_identify.main()
    signal.signal(signal.SIGTERM, on_sigterm)
    errors = capsys.readouterr().err
    assert end.value.code == 2
    assert errors.startswith(f'pam_identify: {words}')
    assert errors.count('\n') == 1
    assert not (bench / 'none').exists()
