# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the demonstration says before it begins, and which commands it leaves its user with."""

import shlex
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from pam_ros.demo import outline
from pam_ros.demo.outline import CHAPTERS, duration, next_steps, plan

ROOT = Path(__file__).resolve().parents[2]


def test_every_chapter_can_be_played():
    for name in CHAPTERS:
        spec = find_spec(f'pam_ros.nodes.demo.{name}')
        assert 'def play(stage: DemoStage)' in Path(spec.origin).read_text(encoding='utf-8')


def test_the_plan_names_the_chapters_that_are_played_their_time_and_the_folder():
    whole = plan([*CHAPTERS], Path('demo'))
    assert all(name in whole and chapter.about in whole for name, chapter in CHAPTERS.items())
    assert 'demo/' in whole.splitlines()[0]
    assert duration(sum(chapter.seconds for chapter in CHAPTERS.values())) in whole
    one = plan(['joint'], Path('shown'))
    assert len(one.splitlines()) == 2
    assert 'shown/' in one
    assert CHAPTERS['paper'].about not in one


@pytest.mark.parametrize(
    ('seconds', 'words'), [(13, '15 s'), (85, '85 s'), (110, '2 minutes'), (150, '2.5 minutes')]
)
def test_durations_are_rounded(seconds, words):
    assert duration(seconds) == words


def test_without_the_report_it_names_no_file_of_it(tmp_path):
    assert 'identified.yaml' not in next_steps(tmp_path)
    assert len(commands(next_steps(tmp_path))) == 1


def test_the_commands_that_it_names_can_be_run(tmp_path, monkeypatch):
    report = tmp_path / 'a folder' / 'loop' / 'report'
    report.mkdir(parents=True)
    (report / 'identified.yaml').touch()
    monkeypatch.setattr(outline.sys, 'argv', [str(tmp_path / 'nowhere' / 'pam_demo')])
    text = next_steps(tmp_path / 'a folder')
    found = commands(text)
    assert len(found) == 3
    for words in found:
        assert words[:2] == ['python3', '-m']
        done = subprocess.run(
            [sys.executable, *words[1:3], '--version'], capture_output=True, text=True, check=True
        )
        assert done.stdout.startswith('pam_ros ')
    assert str(report / 'identified.yaml') in found[1]
    assert str(tmp_path / 'a folder' / 'loop' / 'recording') in found[2]
    (page,) = (line.split()[-1] for line in text.splitlines() if line.startswith('and read'))
    assert (ROOT / page).is_file()
    # Where its programs stand next to it, they are named there.
    (tmp_path / 'pam_sim').touch()
    monkeypatch.setattr(outline.sys, 'argv', [str(tmp_path / 'pam_demo')])
    assert commands(next_steps(tmp_path))[0][0] == str(tmp_path / 'pam_sim')


def commands(text):
    lines = text.splitlines()
    return [shlex.split(lines[k + 1]) for k, line in enumerate(lines) if line.startswith('  #')]
