# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The runner of the benchmarks: finds them by file, runs them apart, says which failed."""

import ast
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks import identify_speed

FOLDER = Path(__file__).parents[2] / 'benchmarks'
BENCHMARKS = sorted(p for p in FOLDER.glob('*.py') if not p.stem.startswith('_'))


@pytest.fixture
def run(tmp_path):
    """Return a function that runs the runner over benchmarks given by name and body."""

    def run(sources, *wanted):
        folder = tmp_path / 'benchmarks'
        folder.mkdir()
        for name in ('__init__.py', '__main__.py'):
            shutil.copy(FOLDER / name, folder)
        for name, body in sources.items():
            (folder / f'{name}.py').write_text(body)
        return subprocess.run(
            [sys.executable, '-m', 'benchmarks', *wanted],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )

    return run


@pytest.mark.parametrize('path', BENCHMARKS, ids=lambda path: path.stem)
def test_each_benchmark_states_its_claim_and_has_a_main(path):
    tree = ast.parse(path.read_text(encoding='utf-8'))
    assert ast.get_docstring(tree)
    assert 'main' in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


@pytest.mark.slow
@pytest.mark.needs_numba
def test_the_fit_of_plain_scipy_runs_on_the_recording_of_the_packages_fit(monkeypatch, capsys):
    monkeypatch.setattr(identify_speed, 'SCIPY_SECONDS', 1.0)
    identify_speed.compare()
    times, fits = capsys.readouterr().out.splitlines()
    pattern = r': ([\d.]+) s, plain scipy (\d+) s .*: (\d+) times faster'
    ours, theirs, ratio = map(float, re.search(pattern, times).groups())
    assert ratio == pytest.approx(theirs / ours, rel=0.2)
    lags = [float(lag) for lag in re.findall(r'\d\.\d{4}', fits)[:4]]
    assert all(0.0 <= lag < 0.05 for lag in lags)


def test_the_help_of_make_names_a_benchmark():
    done = subprocess.run(
        ['make', 'help'], cwd=FOLDER.parent, capture_output=True, text=True, check=True
    )
    (named,) = re.findall(r'^make bench .*\(ARGS=(\w+) ', done.stdout, re.MULTILINE)
    assert named in {path.stem for path in BENCHMARKS}


def test_runs_all_in_order_but_helpers(run):
    said = {name: f'def main():\n    print("table of {name}")\n' for name in ('b', 'a', '_c')}
    done = run(said)
    assert done.returncode == 0
    assert done.stdout.split('\n') == ['== a', 'table of a', '', '== b', 'table of b', '', '']


def test_runs_the_wanted_one(run):
    done = run({'a': 'def main(): print(1)\n', 'b': 'def main(): print(2)\n'}, 'b')
    assert done.stdout == '== b\n2\n\n'


def test_goes_on_after_a_failure_and_tells(run):
    done = run({'a': 'def main(): raise RuntimeError\n', 'b': 'def main(): print(2)\n'})
    assert done.returncode == 1
    assert done.stdout.endswith('== b\n2\n\n')
    assert done.stderr.endswith('failed: a\n')


def test_refuses_an_unknown_name(run):
    done = run({'a': 'def main(): print(1)\n'}, 'c')
    assert done.returncode == 2
    assert done.stderr == 'c is not a benchmark: give one of a\n'
    assert done.stdout == ''


def test_options_go_to_the_one_benchmark_that_is_named(run):
    said = dict.fromkeys(('a', 'b'), 'import sys\n\ndef main():\n    print(sys.argv[1:])\n')
    done = run(said, 'b', '--draws', 'wide')
    assert done.returncode == 0
    assert done.stdout.split('\n')[:2] == ['== b', "['--draws', 'wide']"]


@pytest.mark.parametrize('wanted', [('--draws', 'wide'), ('a', 'b', '--draws', 'wide')])
def test_options_of_no_benchmark_or_of_several_are_refused(run, wanted):
    done = run({'a': 'def main():\n    pass\n', 'b': ''}, *wanted)
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == '--draws is an option of one benchmark: give its name before\n'
