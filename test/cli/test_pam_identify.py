# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_identify`` as a user runs it: recordings in, a report out, one sentence for a mistake."""

import csv
import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pam_ros.cli import pam_identify
from pam_ros.recording.csv_file import write_csv
from pam_ros.recording.read import read_recording
from pam_ros.report.write import FILES
from pam_ros.rig.run import simulate
from pam_ros.settings.nominal import nominal_joint
from support import results

pytestmark = pytest.mark.needs_numba

ROOT = Path(__file__).parents[2]
PROGRAM = (sys.executable, '-m', 'pam_ros.cli.pam_identify')
DECLARED = ('--params', 'dmsp_20_400n', '--set', 'mass=20')
FRICTION = 14.0  # N


@pytest.fixture(scope='module')
def bench(tmp_path_factory):
    """Return a folder with recordings of a rig with friction, and of others that are no use."""
    folder = tmp_path_factory.mktemp('bench')
    truth = results.rig(**{'effects.coulomb_friction.level': FRICTION, 'a5': 303.5, 'zeta': 0.2})
    good = results.free_recording(truth, 30.0, 200.0)
    write_csv(good, folder / 'friction.csv')
    write_csv(results.free_recording(truth, 30.0, 200.0, 5), folder / 'other.csv')
    write_csv(replace(good, position=good.position * 1e3), folder / 'millimetres.csv')
    (folder / 'no_time.csv').write_text('position_mm\n1\n2\n', encoding='utf-8')
    text = (folder / 'friction.csv').read_text(encoding='utf-8')
    renamed = text.replace('pressure_command_Pa', 'valve').replace('position_m', 'encoder')
    (folder / 'renamed.csv').write_text(renamed, encoding='utf-8')
    return folder


def start(folder, *arguments, **options):
    return subprocess.Popen(
        [*PROGRAM, *map(str, arguments)],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        **options,
    )


def run(folder, *arguments):
    """Return (exit code, stdout, stderr)."""
    process = start(folder, *arguments)
    out, errors = process.communicate(timeout=600)
    return process.returncode, out.strip(), errors


def left(folder):
    """Return what is in a folder, hidden files too, but for the recordings."""
    return sorted(p.name for p in folder.iterdir() if p.suffix != '.csv')


@pytest.fixture(scope='module')
def found(bench):
    """Return the result of identifying the friction with a test recording, and the folder."""
    result = run(bench, 'friction.csv', *DECLARED, '--test', 'other.csv', '--out', 'found')
    return result, bench / 'found'


@pytest.mark.slow
def test_friction_is_found_and_the_model_corrected(found):
    (code, out, _), folder = found
    assert code == 0
    report = json.loads((folder / 'report.json').read_text(encoding='utf-8'))
    assert report['verdict'] == 'effect_found'
    assert report['complete'] is True
    assert [effect['name'] for effect in report['effects']] == ['coulomb_friction']
    level = report['effects'][0]['parameters']['level']
    assert level['value'] == pytest.approx(FRICTION, rel=0.05)
    error = report['error']
    assert error['noise_floor'] == pytest.approx(results.NOISE, rel=0.1)
    assert error['augmented']['held_out'] < 1.2 * results.NOISE
    assert error['retuned']['held_out'] > 5.0 * results.NOISE
    assert sorted(p.name for p in folder.iterdir()) == sorted(FILES)
    *summary, end = out.splitlines()
    assert end.startswith('effect_found (coulomb_friction): held-out error ')
    assert end.endswith('see found/report.html')
    (row,) = (line for line in summary if 'effects.coulomb_friction.level' in line)
    assert float(row.split()[2]) == pytest.approx(level['value'], rel=5e-3)
    assert not any('converged' in line for line in summary)


@pytest.mark.slow
@pytest.mark.parametrize(('given', 'is_noted'), [((), True), (('--set', 'mass=20'), False)])
def test_the_mass_of_an_example_is_mentioned(bench, given, is_noted):
    """The note is there before the first line of progress."""
    process = start(bench, 'friction.csv', '--params', 'dmsp_20_400n', *given, '--out', 'noted')
    lines = []
    for line in process.stderr:
        lines.append(line)
        if ' %  ' in line:
            break
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    notes = [line for line in lines if line.startswith('note: ')]
    text = 'note: the load is 20 kg, the example in the file of the muscle dmsp_20_400n: '
    assert notes == ([f'{text}give that of your rig with --set mass=...\n'] if is_noted else [])


def test_report_is_valid(found):
    jsonschema = pytest.importorskip('jsonschema')
    schema = json.loads((ROOT / 'docs' / 'report.schema.json').read_text(encoding='utf-8'))
    report = json.loads((found[1] / 'report.json').read_text(encoding='utf-8'))
    assert [*jsonschema.Draft202012Validator(schema).iter_errors(report)] == []


def test_configured_parameters_are_not_estimates(found):
    report = json.loads((found[1] / 'report.json').read_text(encoding='utf-8'))
    for name, one in report['parameters']['declared'].items():
        assert one['low'] == one['value'] == one['high'], name


def test_progress_is_printed_in_plain_lines_without_a_terminal(found):
    (_, _, errors), _ = found
    lines = [line for line in errors.splitlines() if ' %  ' in line]
    assert len(lines) >= 5
    assert '\r' not in errors
    fractions = [int(line.split('%')[0]) for line in lines]
    assert fractions == sorted(fractions)


def test_identified_file_starts_the_better_simulator(found, bench):
    model = nominal_joint(found[1] / 'identified.yaml').joint
    nominal = nominal_joint('dmsp_20_400n', ['mass=20']).joint
    other = read_recording(bench / 'other.csv')
    rmse = {}
    for name, rig in (('declared', nominal), ('identified', model)):
        y = simulate(rig, other.t, other.command, other.command_t).position
        rmse[name] = np.sqrt(np.mean((y - other.position)[200:] ** 2))
    assert rmse['identified'] < 2.0 * results.NOISE
    assert rmse['declared'] > 20.0 * rmse['identified']


def test_residual_file_gives_the_errors_of_the_report(found):
    report = json.loads((found[1] / 'report.json').read_text(encoding='utf-8'))
    with (found[1] / 'residual.csv').open(encoding='utf-8', newline='') as stream:
        rows = list(csv.DictReader(stream))
    for name in ('declared', 'retuned', 'augmented'):
        e = np.array([float(r[f'residual_{name}_m']) for r in rows if r['set'] == 'held_out'])
        assert np.sqrt(np.mean(e**2)) == pytest.approx(report['error'][name]['held_out'], rel=1e-6)


@pytest.mark.parametrize(
    ('arguments', 'sentence'),
    [
        (('absent.csv', *DECLARED), 'recording absent.csv does not exist'),
        (('no_time.csv', *DECLARED), 'no_time.csv has no time axis'),
        (('millimetres.csv', *DECLARED), 'cannot be right'),
        (('friction.csv', '--params', 'dmsp_9'), 'dmsp_9 is neither a parameter file'),
        (('friction.csv', *DECLARED, '--set', 'mas=3'), 'mas is not a parameter'),
        (('friction.csv', *DECLARED, '--set', 'mass=-3'), 'mass = -3.0 is not allowed'),
        (('friction.csv', *DECLARED, '--column', 'position_m=weight_kg'), 'is not understood'),
        (('friction.csv', *DECLARED, '--mapping', 'absent.yaml'), 'absent.yaml cannot be read'),
        (
            ('friction.csv', *DECLARED, '--columns', 't_s,force_N'),
            'and 2 names of columns are given',
        ),
        (('friction.csv', *DECLARED, '--columns', 't_s,,force_N'), 'has an empty name'),
        (('friction.csv', *DECLARED, '--variable', 'a'), 'friction.csv is not a MATLAB file'),
        (('friction.csv', *DECLARED, '--sheet', 'a'), 'friction.csv is not an Excel workbook'),
        (('friction.csv', *DECLARED, '--kind', 'held'), 'has no force'),
        (('friction.csv', *DECLARED, '--kind', 'loose'), 'invalid choice'),
        (('friction.csv', *DECLARED, '--test', 'friction.csv'), 'give each recording once'),
        (('friction.csv', *DECLARED, '--jobs', '2'), '--jobs is for --each'),
        (('friction.csv', *DECLARED, '--each', '--verbose'), '--verbose is not for --each'),
        (('friction.csv',), '--params is missing: give the nominal model'),
    ],
)
def test_a_mistake_is_one_sentence_and_nothing_is_written(
    bench, monkeypatch, capsys, arguments, sentence
):
    before = left(bench)
    # In this process: the imports of another one take far longer than to find the mistake.
    monkeypatch.chdir(bench)
    monkeypatch.setattr(sys, 'argv', ['pam_identify', *arguments, '--out', 'bad'])
    on_sigterm = signal.getsignal(signal.SIGTERM)
    with pytest.raises(SystemExit) as end:
        pam_identify.main()
    signal.signal(signal.SIGTERM, on_sigterm)
    code, (out, errors) = end.value.code, capsys.readouterr()
    assert code == 2
    assert out == ''
    assert len(errors.splitlines()) == 1
    assert errors.startswith('pam_identify: ')
    assert sentence in errors
    assert left(bench) == before


@pytest.mark.slow
def test_each_of_several_rigs_has_a_report(bench, tmp_path):
    listed = tmp_path / 'listed.yaml'
    listed.write_text(
        f'params: dmsp_20_400n\nrecordings: [{{file: {bench}/friction.csv}}]', encoding='utf-8'
    )
    given = ['--each', listed, 'no_time.csv', '--params', 'absent', '--set', 'mass=20']
    code, out, errors = run(bench, *given, '--jobs', 2, '--out', tmp_path / 'each')
    assert (code, errors) == (1, '')
    assert 'no_time           not_identified         absent is neither a parameter file' in out
    report = json.loads((tmp_path / 'each' / 'listed' / 'report.json').read_text(encoding='utf-8'))
    assert [effect['name'] for effect in report['effects']] == ['coulomb_friction']
    level = report['effects'][0]['parameters']['level']
    assert level['value'] == pytest.approx(FRICTION, rel=0.05)
    assert 'listed            effect_found           held-out error' in out


@pytest.mark.slow
def test_a_mistake_is_the_exit_code_of_the_program(bench):
    code, out, errors = run(bench, 'absent.csv', *DECLARED, '--out', 'bad')
    assert (code, out) == (2, '')
    assert errors == 'pam_identify: recording absent.csv does not exist\n'


@pytest.mark.slow
def test_a_folder_with_other_files_is_refused_before_any_work(bench, tmp_path):
    (tmp_path / 'thesis.tex').write_text('mine', encoding='utf-8')
    code, _, errors = run(bench, 'friction.csv', *DECLARED, '--out', tmp_path)
    assert code == 2
    assert errors == (
        f'pam_identify: {tmp_path} holds thesis.tex, which is not a report of pam_identify: give '
        'a new folder\n'
    )


def test_a_folder_that_cannot_be_made_is_refused_before_the_recordings_are_read(
    bench, monkeypatch, capsys
):
    monkeypatch.chdir(bench)
    # This recording does not exist, which is not noticed: nothing was read.
    arguments = ['absent.csv', *DECLARED, '--out', '/proc/report']
    monkeypatch.setattr(sys, 'argv', ['pam_identify', *arguments])
    on_sigterm = signal.getsignal(signal.SIGTERM)
    with pytest.raises(SystemExit) as end:
        pam_identify.main()
    signal.signal(signal.SIGTERM, on_sigterm)
    assert end.value.code == 2
    assert capsys.readouterr().err.startswith('pam_identify: /proc/report cannot be made: ')


ENDS = pytest.mark.parametrize(
    ('kind', 'code'), [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=['Ctrl-C', 'SIGTERM']
)


def interrupted(folder, kind, steps, *arguments):
    """Send a signal at each of these *steps*, and return (exit code, stdout, stderr lines)."""
    process = start(folder, 'friction.csv', *DECLARED, *arguments)
    lines = []
    for line in process.stderr:
        lines.append(line.rstrip())
        if steps and steps[0] in line:
            os.killpg(process.pid, kind)
            steps = steps[1:]
    out, _ = process.communicate(timeout=60)
    assert steps == []
    return process.returncode, out, lines


@pytest.mark.slow
@ENDS
@pytest.mark.parametrize(
    'steps',
    [['re-tuning'], ['trying effects', 'interrupted: ']],
    ids=['before there is a model', 'twice'],
)
def test_interrupted_it_leaves_nothing(bench, kind, code, steps):
    before = left(bench)
    given, _, lines = interrupted(bench, kind, steps, '--out', 'deep/half')
    assert given == code
    assert not any('Traceback' in line for line in lines)
    assert left(bench) == before


@pytest.mark.slow
@ENDS
def test_interrupted_once_it_writes_the_best_model_so_far(bench, tmp_path, kind, code):
    out = tmp_path / 'half'
    given, printed, lines = interrupted(bench, kind, ['trying effects'], '--out', out)
    assert given == code
    page = out / 'report.html'
    assert lines[-1] == f'pam_identify: interrupted, an incomplete report was written to {page}'
    assert printed.splitlines()[0].startswith('Incomplete: the search was stopped')
    assert printed.splitlines()[-1].startswith('incomplete, the search was stopped: ')
    assert sorted(p.name for p in out.iterdir()) == sorted(FILES)
    report = json.loads((out / 'report.json').read_text(encoding='utf-8'))
    assert report['complete'] is False
    assert report['effects'] == []
    assert 'id="incomplete"' in page.read_text(encoding='utf-8')
    model = (out / 'identified.yaml').read_text(encoding='utf-8')
    assert '# incomplete, the search was stopped: ' in model
    nominal_joint(out / 'identified.yaml')


@pytest.mark.slow
def test_report_is_written_for_any_name_in_locale_c_with_stdout_full(bench, tmp_path):
    """Of the file, and of its columns, which the command line and a mapping say."""
    name = os.fsdecode(b'm\xfcller.csv')
    (tmp_path / name).write_bytes((bench / 'renamed.csv').read_bytes())
    (tmp_path / 'map.yaml').write_text('columns:\n  encoder: position_m\n', encoding='utf-8')
    columns = ('--mapping', 'map.yaml', '--column', 'valve=pressure_command_Pa')
    out = 'größe'
    plain = {'LC_ALL': 'C', 'PYTHONUTF8': '0', 'PYTHONCOERCECLOCALE': '0'}
    with Path('/dev/full').open('w', encoding='utf-8') as full:
        done = subprocess.run(
            [*PROGRAM, name, *DECLARED, *columns, '--out', out],
            cwd=tmp_path,
            env={**os.environ, **plain},
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 0, done.stderr
    last = 'pam_identify: standard output cannot be written: No space left on device'
    assert done.stderr.splitlines()[-1] == last
    folder = tmp_path / out
    assert sorted(p.name for p in folder.iterdir()) == sorted(FILES)
    report = json.loads((folder / 'report.json').read_text(encoding='utf-8'))
    assert [effect['name'] for effect in report['effects']] == ['coulomb_friction']
    (recording,) = report['data']['recordings']
    assert recording['name'] == r'm\udcfcller.csv'
    assert 'größe' in report['provenance']['command']
    for file in ('report.html', 'identified.yaml', 'residual.csv'):
        assert r'm\udcfcller.csv' in (folder / file).read_text(encoding='utf-8')
    nominal_joint(folder / 'identified.yaml')


@pytest.mark.slow
def test_it_needs_no_ros(bench):
    program = (
        'import sys\n'
        'class Refuse:\n'
        '    def find_spec(self, name, *_):\n'
        '        if name.split(".")[0] in ("rclpy", "std_msgs", "sensor_msgs"):\n'
        '            raise ImportError(name)\n'
        'sys.meta_path.insert(0, Refuse())\n'
        'import pam_ros.cli.pam_identify as program\n'
        'import pam_ros.identification.identify, pam_ros.report.page\n'
        'program.parser().print_help()\n'
    )
    done = subprocess.run(
        [sys.executable, '-c', program], capture_output=True, text=True, check=True, cwd=bench
    )
    assert '--params' in done.stdout
