# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``python -m pam_ros.presets``, as a program of its own, against the files of the package."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

CONFIG = Path(__file__).parents[1] / 'config'
FILES = sorted([*(CONFIG / 'muscles').glob('*.yaml'), *(CONFIG / 'rigs').glob('*.yaml')])


def run(*words, **variables):
    command = [sys.executable, '-m', 'pam_ros.presets', *words]
    given = {**os.environ, **variables}
    return subprocess.run(command, capture_output=True, text=True, check=False, env=given)


@pytest.fixture(scope='module')
def entries():
    """Return name -> text of its entry."""
    done = run(COLUMNS='20')
    assert (done.returncode, done.stderr) == (0, '')
    assert max(map(len, done.stdout.splitlines())) < 100 + len(str(CONFIG))
    parts = [part.partition('\n') for part in done.stdout.strip().split('\n\n')]
    return {name: ' '.join(text.split()) for name, _, text in parts if ' ' not in name}


def test_each_file_has_an_entry(entries):
    assert [*entries] == [file.stem for file in FILES]
    assert all(entries[file.stem].endswith(str(file)) for file in FILES)


def test_an_entry_has_what_the_file_states(entries):
    limits = 0
    for file in FILES:
        text = file.read_text(encoding='utf-8')
        values = yaml.safe_load(text)['/**']['ros__parameters']
        entry = entries[file.stem]
        assert f'source: {values["source"].strip()}' in entry
        first = entry.partition('. ')[0]
        assert first in ' '.join(text.replace('\n#', '').split())
        assert len(first) > 30
        if values['a2'] != 0.0:
            limits += 1
            expected = f'l0 {values["l0"]} m, p_max {values["p_max"] / 1e3:.0f} kPa, force_max '
            assert f'{expected}{values["force_max"]:.0f} N' in entry
        else:
            assert 'force_max' not in entry
    assert limits >= 4


def test_it_prints_in_any_locale_and_refuses_words():
    plain = run(LC_ALL='C', PYTHONUTF8='0', PYTHONCOERCECLOCALE='0', PYTHONIOENCODING='ascii')
    assert plain.returncode == 0
    assert 'dmsp_20_400n' in plain.stdout
    refused = run('dmsp_10')
    assert refused.returncode == 2
    assert refused.stderr.splitlines()[-1].endswith('unrecognized arguments: dmsp_10')
