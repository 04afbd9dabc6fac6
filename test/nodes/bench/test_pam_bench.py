# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_bench`` as a program: its table, its file, its exit codes, side by side, interrupted."""

import hashlib
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest
import yaml

from pam_ros.bench.scores import SCORES
from support import odd_controller
from support.distribution import PROFILE

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

SCENARIO = {
    'about': 'A step.',
    'score': 'error_at_rest',
    'duration': 5.0,
    'declared': {'muscle': 'dmsp_20_400n', 'mass': 20.0},
    'undeclared': {'initial.pressure': 300e3, 'sensor.position_noise': 20e-6},
    'reference': {'kind': 'step', 'size': 0.01, 'time': 0.5},
}


def odd(kind):
    words = (sys.executable, Path(odd_controller.__file__), kind)
    return f'{kind}=' + ' '.join(map(str, words)) + ' --ros-args -p use_sim_time:=true'


def written(folder, name, content):
    path = folder / name
    path.write_text(yaml.safe_dump(content), encoding='utf-8')
    return str(path)


def bench(*arguments, **more):
    command = [sys.executable, '-m', 'pam_ros.cli.pam_bench', *arguments]
    # As for a user: the domains that it finds free are those of the default ports.
    environment = {name: value for name, value in os.environ.items() if name != PROFILE}
    return subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=environment,
        start_new_session=True,
        **more,
    )


def of_machine(outcome):
    """Return the scores of an outcome without those that depend on the machine."""
    own = [score.name for score in SCORES if score.is_of_machine]
    return {name: value for name, value in outcome['scores'].items() if name not in own}


def test_a_bench_with_limits_is_the_same_side_by_side(tmp_path):
    scenario = written(tmp_path, 'short.yaml', SCENARIO)
    limits = written(tmp_path, 'limits.yaml', {'short': {'error_at_rest': 1e-4}})
    found = []
    first = tmp_path / '1' / 'bench.json'
    for jobs, more in (('1', ()), ('2', ('--compare', str(first)))):
        out = tmp_path / jobs
        given = ['sliding_mode', odd('good'), odd('dies'), '--scenario', scenario, '--seeds', '1']
        program = bench(*given, *more, '--jobs', jobs, '--limits', limits, '--out', str(out))
        output, _ = program.communicate(timeout=300)
        assert program.returncode == 1, output
        # Two controllers fall short, the third does not.
        assert 'short: error at rest of good must be at most 0.100 mm, but is 1' in output
        assert 'short: error at rest of dies must be at most 0.100 mm, but it died' in output
        assert 'of sliding_mode must' not in output
        assert sorted(path.name for path in out.iterdir()) == ['bench.html', 'bench.json']
        found.append(json.loads((out / 'bench.json').read_text(encoding='utf-8')))
    one, two = (
        [(o['controller'], o['seed'], of_machine(o)) for o in f['outcomes']] for f in found
    )
    assert one == two
    assert 'nothing has changed by more than the spread over the seeds' in output
    assert [name for name, *_ in one] == ['sliding_mode', 'good', 'dies']


def test_drawn_scenarios_are_files_and_are_run(tmp_path):
    out = tmp_path / 'found'
    given = ['sliding_mode', '--draw', '1', '--seed', '3', '--quick', '--out', str(out)]
    program = bench(*given)
    output, _ = program.communicate(timeout=300)
    assert program.returncode == 0, output
    found = json.loads((out / 'bench.json').read_text(encoding='utf-8'))
    (outcome,) = found['outcomes']
    assert (outcome['scenario'], outcome['status']) == ('draw_3_001', 'completed')
    data = (out / 'scenarios' / 'draw_3_001.yaml').read_bytes()
    assert found['provenance']['files'] == {'draw_3_001': hashlib.sha256(data).hexdigest()}
    again = bench('--draw', '1', '--seed', '3', '--list', cwd=tmp_path)
    output, _ = again.communicate(timeout=60)
    assert again.returncode == 0
    assert 'draw_3_001' in output
    assert [path.name for path in tmp_path.iterdir()] == ['found']


def test_an_interrupted_bench_ends_its_controller_and_writes_nothing(tmp_path):
    scenario = written(tmp_path, 'long.yaml', {**SCENARIO, 'duration': 600.0})
    given = [odd('good') + f' -r __node:=n{os.getpid()}', '--scenario', scenario]
    program = bench(*given, '--out', str(tmp_path / 'found'))

    def controllers():
        names = [
            path.read_bytes() for path in Path('/proc').glob('[0-9]*/cmdline') if exists(path)
        ]
        return [name for name in names if f'__node:=n{os.getpid()}\0'.encode() in name]

    def exists(path):
        try:
            return b'odd_controller' in path.read_bytes() and b'pam_bench' not in path.read_bytes()
        except OSError:  # it has ended meanwhile
            return False

    end = monotonic() + 60.0
    while not controllers() and monotonic() < end:
        sleep(0.1)
    assert controllers()
    os.killpg(program.pid, signal.SIGINT)
    output, _ = program.communicate(timeout=60)
    assert program.returncode == 130, output
    assert output.strip() == 'pam_bench: interrupted, nothing was written'
    assert not controllers()
    assert not (tmp_path / 'found').exists()


def test_an_interrupted_bench_goes_on_anywhere(tmp_path):
    pytest.importorskip('distributed', reason='without Dask it goes on here only')
    out = tmp_path / 'out'
    scenario = written(tmp_path, 'short.yaml', SCENARIO)
    given = [odd('good'), odd('dies'), '--scenario', scenario, '--seeds', '2', '--out', str(out)]
    program = bench(*given)
    first = program.stdout.readline()
    os.killpg(program.pid, signal.SIGINT)
    output, _ = program.communicate(timeout=60)
    assert program.returncode == 130, output
    kept = f'interrupted, 1 of 4 results are kept in {out / "runs.sqlite"}: --resume goes on'
    assert output.strip() == f'pam_bench: {kept}'

    program = bench(*given, '--resume', '--dask', 'local')
    output, _ = program.communicate(timeout=300)
    assert program.returncode == 0, output
    assert output.startswith(f'1 of 4 runs are taken from {out / "runs.sqlite"}\n')
    assert first not in output
    data = json.loads((out / 'bench.json').read_text(encoding='utf-8'))
    runs = [(run['controller'], run['seed'], run['status']) for run in data['outcomes']]
    assert runs == [('good', 0, 'completed'), ('good', 1, 'completed')] + [
        ('dies', seed, 'died') for seed in range(2)
    ]
    assert sorted(path.name for path in out.iterdir()) == ['bench.html', 'bench.json']


@pytest.mark.parametrize(
    ('arguments', 'sentence'),
    [
        (['--out', 'x'], 'no controller is given, such as sliding_mode or pid'),
        (['pid'], '--out is missing: give the folder for the results'),
        (['pid', '--out', 'x', '--seeds', '0'], "'0' is not allowed: give 1 to 1000"),
        (['pid', '--out', 'x', '--domain', '7', '--jobs', '2'], '--domain 7 is not allowed'),
        (['pid', '--out', 'x', '--jobs', '2', '--dask', 'local'], '--jobs is of this machine'),
        (['pid', '--out', 'x', '--draw', '2', '--resume'], '--resume needs --seed S with --draw'),
        (['pid', '--out', 'x', '--scenario', 'sinn'], 'scenario sinn does not exist'),
        (['pdi', '--out', 'x'], "'pdi' is not a controller"),
        (
            ['pid', '--out', '/proc/x'],
            '/proc/x/bench.json cannot be made: no folder can be made in /proc',
        ),
        (['pid', '--out', 'x', '--limits', 'no.yaml'], 'no.yaml cannot be read'),
        (['pid', '--out', 'x', '--draw', '0'], "--draw: '0' is not allowed: give 1 to 1000"),
        (['pid', '--out', 'x', '--draw', '1', '--seed', '-1'], "--seed: '-1' is not allowed"),
        (['pid', '--out', 'x', '--seed', '4'], '--seed 4 is the seed of --draw: give --draw N'),
        (
            ['pid', '--out', 'x', '--draw', '1', '--scenario', 'sine'],
            '--draw and --scenario exclude each other',
        ),
        (['pdi', '--out', 'x', '--draw', '1', '--seed', '3'], "'pdi' is not a controller"),
    ],
)
def test_invalid_input_is_a_sentence(tmp_path, arguments, sentence):
    program = bench(*arguments, cwd=tmp_path)
    output, _ = program.communicate(timeout=60)
    assert program.returncode == 2
    assert sentence in output
    assert len(output.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_the_list_needs_nothing(tmp_path):
    program = bench('--list', '--suite', 'joint', cwd=tmp_path)
    output, _ = program.communicate(timeout=60)
    assert program.returncode == 0
    assert 'joint_sine_all' in output
    assert '  step_friction' not in output
    assert all(score.name in output for score in SCORES)
