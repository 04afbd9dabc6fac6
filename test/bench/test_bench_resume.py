# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A bench that is not complete: which runs are kept, and what is left for the next time."""

import json
import re
import sqlite3
from argparse import Namespace
from contextlib import closing

import pytest
import yaml

from pam_ros.bench.bench import FELL_SHORT, perform
from pam_ros.bench.read import read_results
from pam_ros.bench.scenario import read_scenario
from pam_ros.errors import PamError
from pam_ros.parallel.journal import Journal
from support import bench_runs
from support.here_pool import HerePool

SCENARIO = {
    'about': 'A step.',
    'score': 'error_at_rest',
    'duration': 5.0,
    'declared': {'muscle': 'dmsp_20_400n', 'mass': 20.0},
    'reference': {'kind': 'step', 'size': 0.01},
}


@pytest.fixture
def bench(tmp_path):
    """Return a function that performs a bench without ROS, and the folder of its scenario."""
    path = tmp_path / 'short.yaml'
    path.write_text(yaml.safe_dump(SCENARIO), encoding='utf-8')

    def performed(*controllers, out='out', resume=False, limits=None):
        given = Namespace(
            controllers=controllers,
            out=tmp_path / out,
            resume=resume,
            limits=limits,
            compare=None,
            domain=None,
        )
        return perform(given, [read_scenario(path)], 2, bench_runs.run, HerePool())

    return performed, tmp_path


def performed_runs(folder):
    path = folder / 'performed.txt'
    lines = path.read_text(encoding='ascii').split()
    path.unlink()
    return sorted(lines)


def test_runs_that_could_not_be_performed_are_named_and_repeated(bench, capsys):
    run, folder = bench
    run('pid', 'sliding_mode', out='whole')
    whole = read_results(folder / 'whole' / 'bench.json')
    performed_runs(folder)
    (folder / bench_runs.FULL).touch()
    limits = folder / 'limits.yaml'
    limits.write_text('short: {error_at_rest: 1.0}', encoding='utf-8')
    capsys.readouterr()
    assert run('pid', 'sliding_mode', limits=limits) == FELL_SHORT
    output = capsys.readouterr().out
    reason = 'could not be run with seed 1: OSError: [Errno 28] No space left on device'
    assert output.count(reason) == 2  # of each controller, in the table
    assert 'of pid must be at most 1000 mm, but it could not be run with seed 1' in output
    assert '2 of 4 runs could not be run: --resume repeats these' in output
    page = (folder / 'out' / 'bench.html').read_text(encoding='utf-8')
    assert '2 runs, with one seed. All of them were completed. 2 more could not be run.' in page
    assert 'pid could not be run (seed 1): OSError' in page
    partial = read_results(folder / 'out' / 'bench.json')
    assert [(one.controller, one.seed) for one in partial.not_run] == [
        ('pid', 1),
        ('sliding_mode', 1),
    ]
    assert partial.outcomes == tuple(one for one in whole.outcomes if one.seed == 0)
    assert performed_runs(folder) == ['pid0', 'pid1', 'sliding_mode0', 'sliding_mode1']

    (folder / bench_runs.FULL).unlink()
    assert run('pid', 'sliding_mode', resume=True) == 0
    assert performed_runs(folder) == ['pid1', 'sliding_mode1']
    assert '2 of 4 runs are taken from' in capsys.readouterr().out
    assert read_results(folder / 'out' / 'bench.json').outcomes == whole.outcomes
    assert sorted(path.name for path in (folder / 'out').iterdir()) == ['bench.html', 'bench.json']
    # The plots are those of the same trials.
    pages = [folder / out / 'bench.html' for out in ('out', 'whole')]
    plots = [re.findall(r'<svg.*?</svg>', one.read_text(encoding='utf-8'), re.S) for one in pages]
    assert plots[0] == plots[1]
    assert len(plots[0]) == 2


def test_only_runs_of_the_same_scenario_and_controller_are_taken(bench):
    run, folder = bench
    (folder / bench_runs.FULL).touch()
    run('pid', 'sliding_mode')
    performed_runs(folder)
    run('pid', resume=True)
    assert performed_runs(folder) == ['pid1']
    changed = {**SCENARIO, 'duration': 6.0}
    (folder / 'short.yaml').write_text(yaml.safe_dump(changed), encoding='utf-8')
    run('pid', 'sliding_mode', resume=True)
    assert performed_runs(folder) == ['pid0', 'pid1', 'sliding_mode0', 'sliding_mode1']


def test_nothing_is_lost_without_resume(bench):
    run, folder = bench
    (folder / bench_runs.FULL).touch()
    run('pid')
    journal = folder / 'out' / 'runs.sqlite'
    with pytest.raises(PamError, match=r'runs.sqlite has results of a command .* --resume'):
        run('pid')
    with (
        closing(Journal(journal, is_resumed=True)),
        pytest.raises(PamError, match=r'runs.sqlite is in use by another program'),
    ):
        run('pid', resume=True)
    assert performed_runs(folder) == ['pid0', 'pid1']


def test_a_bench_of_which_nothing_could_be_run_is_a_sentence(bench, monkeypatch):
    run, folder = bench
    (folder / bench_runs.FULL).touch()
    monkeypatch.setattr('pam_ros.bench.bench.jobs_of', jobs_with_seed_one)
    with pytest.raises(PamError, match='no run could be performed; the first of them: OSError'):
        run('pid')
    assert not (folder / 'out').exists()


def jobs_with_seed_one(scenarios, controllers, seeds):
    from pam_ros.bench.runs import Job

    return [Job(scenarios[0], controllers[0], 1)]


def spoil(path, statement):
    with sqlite3.connect(path) as connection:
        connection.execute(statement)
    connection.close()


@pytest.mark.parametrize(
    ('statement', 'sentence'),
    [
        (None, 'file is not a database; remove it'),
        ("UPDATE results SET content = '{}'", 'is damaged: there is no status; remove it'),
        ("UPDATE results SET content = '{'", 'is damaged: Expecting property name'),
        ("UPDATE results SET data = x'1234'", 'is damaged: '),
        ('PRAGMA user_version = 9', 'is damaged: its version 9 is not known'),
    ],
)
def test_a_damaged_file_is_a_sentence(bench, statement, sentence):
    run, folder = bench
    (folder / bench_runs.FULL).touch()
    run('pid')
    journal = folder / 'out' / 'runs.sqlite'
    before = json.loads((folder / 'out' / 'bench.json').read_text(encoding='utf-8'))
    if statement:
        spoil(journal, statement)
    else:
        journal.write_text('no database', encoding='ascii')
    with pytest.raises(PamError, match=sentence) as error:
        run('pid', resume=True)
    assert str(journal) in str(error.value)
    # Results of before are not touched.
    assert json.loads((folder / 'out' / 'bench.json').read_text(encoding='utf-8')) == before
