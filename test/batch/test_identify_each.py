# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Many rigs: their names, the table, and what is repeated; the identification is stood in for."""

import csv
import json
import sqlite3
from pathlib import Path

import pytest

from pam_ros.batch import batch, task
from pam_ros.batch.batch import NOT_ALL, identify_each
from pam_ros.batch.rigs import Rig, rigs_of
from pam_ros.batch.row import RigRow
from pam_ros.batch.task import RigTask
from pam_ros.cli.pam_identify import parser
from pam_ros.errors import PamError, RecordingError
from support.here_pool import HerePool


def identified(one):
    """Stand in for the identification: the first word of a recording says what becomes of it."""
    path = Path(one.rig.path)
    done = path.parent / 'done.txt'
    with done.open('a', encoding='utf-8') as file:
        file.write(f'{one.rig.name}\n')
    word = path.read_text(encoding='utf-8')
    if word == 'bad':
        raise RecordingError(f'{path.name} has no time axis')
    if word == 'interrupt':
        raise KeyboardInterrupt
    one.folder.mkdir(parents=True, exist_ok=True)
    report = json.dumps({'schema_version': '2.11', 'verdict': 'effect_found'})
    (one.folder / 'report.json').write_text(report, encoding='utf-8')
    verdict, effects = ('effect_found', 'hysteresis') if word else ('no_missing_effect', '')
    errors = 5e-3, 6e-4, 5.02e-5, 5e-5
    return RigRow(one.rig.name, one.rig.path, verdict, effects, 'm', *errors, f'Found {word}.')


@pytest.fixture
def each(tmp_path, monkeypatch):
    """Return a function that identifies files with given words, and the folder of these."""
    monkeypatch.setattr(batch, 'identify_rig', identified)
    monkeypatch.chdir(tmp_path)

    def run(words, *more):
        for name, word in words.items():
            Path(name).write_text(word, encoding='utf-8')
        given = parser().parse_args([*words, '--params', 'dmsp_20_400n', '--out', 'out', *more])
        given.values = [{} for _ in words], []
        return identify_each(given, 'pam_identify --each', HerePool())

    return run, tmp_path


def done(folder):
    path = folder / 'done.txt'
    names = path.read_text(encoding='utf-8').split()
    path.unlink()
    return names


def test_each_rig_has_a_row_and_what_fails_is_repeated(each, capsys):
    run, folder = each
    words = {'b.csv': 'hysteresis', 'a.csv': '', 'wrong.csv': 'bad', 'c.csv': 'hysteresis'}
    assert run(words) == NOT_ALL
    assert done(folder) == ['b', 'a', 'wrong', 'c']
    lines = capsys.readouterr().out.splitlines()
    words_of = [' '.join(line.split()) for line in lines]
    errors = 'held-out error 5.00 -> 0.0502 mm, noise 0.0500 mm'
    assert words_of[0] == f'b effect_found {errors} hysteresis'
    assert words_of[2] == 'wrong not_identified wrong.csv has no time axis'
    assert lines[5:] == [
        'Effect found: 2 (hysteresis 2)',
        'Nothing missing: 1',
        'Not identified: 1',
        f'see {Path("out", "index.html")}',
        '1 of 4 could not be identified: --resume repeats these',
    ]
    with (folder / 'out' / 'rigs.csv').open(encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    assert [row['rig'] for row in rows] == ['b', 'a', 'wrong', 'c']
    assert [row['error_augmented'] for row in rows] == ['5.02e-05', '5.02e-05', '', '5.02e-05']
    assert rows[2]['sentence'] == 'wrong.csv has no time axis'
    html = (folder / 'out' / 'index.html').read_text(encoding='utf-8')
    assert html.count('/report.html"') == 3
    assert 'href="b/report.html"' in html

    with pytest.raises(PamError, match=r'rigs.sqlite has results of a command'):
        run(words)
    # A recording that has changed, and one that failed, are identified again.
    words = {**words, 'wrong.csv': '', 'c.csv': 'creep'}
    assert run(words, '--resume') == 0
    assert done(folder) == ['wrong', 'c']
    assert '2 of 4 rigs are taken from' in capsys.readouterr().out
    names = ['a', 'b', 'c', 'index.html', 'rigs.csv', 'wrong']
    assert sorted(path.name for path in (folder / 'out').iterdir()) == names


def test_after_an_interrupt_with_other_options_all_are_identified_again(each):
    run, folder = each
    words = {'a.csv': '', 'b.csv': 'interrupt'}
    with pytest.raises(KeyboardInterrupt, match=r'1 of 2 results are kept in .*rigs.sqlite'):
        run(words)
    assert done(folder) == ['a', 'b']
    words['b.csv'] = 'interrupt'
    # What is stored with other options is not kept for these.
    with pytest.raises(KeyboardInterrupt, match='1 of 2 results are kept'):
        run(words, '--resume', '--set', 'mass=10')
    assert done(folder) == ['a', 'b']
    words['b.csv'] = ''
    assert run(words, '--resume', '--set', 'mass=20') == 0
    assert done(folder) == ['a', 'b']


def test_what_is_set_before_one_of_the_files_is_of_its_rig_alone(tmp_path, monkeypatch):
    given = parser().parse_args(['a', 'b', '--set', 'zeta=0.2', '--out', 'out'])
    read = []

    def stop(options, paths, own):
        read.append((options.set, paths, own))
        raise RecordingError('is absent')

    monkeypatch.setattr(task, 'read_inputs', stop)
    for mass in ('10', '20'):
        one = RigTask(Rig('a', 'a', {'mass': mass}), given, tmp_path, '')
        with pytest.raises(RecordingError):
            task.identify_rig(one)
    assert [sets for sets, *_ in read] == [['zeta=0.2', 'mass=10'], ['zeta=0.2', 'mass=20']]
    assert read[0][1:] == ((['a'], []), ([{}], []))


def test_a_report_that_cannot_be_written_is_found_before_any_work(each):
    run, folder = each
    (folder / 'out' / 'b').mkdir(parents=True)
    (folder / 'out' / 'b' / 'thesis.tex').touch()
    with pytest.raises(PamError, match=r'b holds thesis.tex, which is not a report'):
        run({'a.csv': '', 'b.csv': ''})
    assert not (folder / 'done.txt').exists()


def test_names_are_those_of_the_files_as_far_as_they_differ(tmp_path):
    def names(*paths):
        return [rig.name for rig in rigs_of([str(tmp_path / p) for p in paths], [{}] * len(paths))]

    assert names('x/a.csv', 'y/b') == ['a', 'b']
    assert names('x/a.csv', 'y/a.csv') == ['x_a.csv', 'y_a.csv']
    assert names('a.csv', 'a.mat') == ['a.csv', 'a.mat']
    with pytest.raises(PamError, match=r'a\.csv is given twice'):
        names('a.csv', 'x/../a.csv')


def test_a_journal_of_something_else_is_refused(each):
    run, folder = each
    words = {'a.csv': '', 'b.csv': 'bad'}
    run(words)
    with sqlite3.connect(folder / 'out' / 'rigs.sqlite') as connection:
        connection.execute('UPDATE results SET content = ?', (json.dumps({'rig': 'a'}),))
    connection.close()
    with pytest.raises(PamError, match='is damaged: a row does not have'):
        run(words, '--resume')
