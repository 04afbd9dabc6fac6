# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The example of an identification finds the friction of its recording, and saves the report."""

import json
import re

import pytest

from pam_ros.report.write import FILES

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]


def test_it_finds_the_friction_and_saves_the_report(run_example, tmp_path):
    done = run_example('identify_from_python.py', 'report')
    assert (done.returncode, done.stderr) == (0, '')
    level = re.search(r'^coulomb_friction\.level = (\S+) N$', done.stdout, re.MULTILINE)[1]
    assert float(level) == pytest.approx(8.0, rel=0.05)
    assert sorted(path.name for path in (tmp_path / 'report').iterdir()) == sorted(FILES)
    report = json.loads((tmp_path / 'report' / 'report.json').read_text(encoding='utf-8'))
    assert report['verdict'] == 'effect_found'
    assert 'identify_from_python.py report' in report['provenance']['command']


def test_a_folder_with_other_files_is_one_sentence(run_example, tmp_path):
    (tmp_path / 'notes.txt').write_text('mine', encoding='utf-8')
    done = run_example('identify_from_python.py', '.')
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert 'holds notes.txt, which is not a report' in done.stderr
