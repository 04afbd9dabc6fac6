# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The demonstration, chapter by chapter, as a user runs it."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.image import imread

from support.marks import at_release

pytestmark = pytest.mark.usefixtures('domain')

DEMO = [sys.executable, '-m', 'pam_ros.cli.pam_demo']


def run_in(folder, *arguments):
    return subprocess.run(
        [*DEMO, *arguments], cwd=folder, capture_output=True, text=True, check=False
    )


def children_of(program):
    """Return the process folders of a process's children (Linux)."""

    def parent(folder):
        try:
            return int((folder / 'stat').read_text().rsplit(')', 1)[1].split()[1])
        except OSError:  # it has ended meanwhile
            return None

    folders = Path('/proc').glob('[0-9]*')
    return [folder for folder in folders if parent(folder) == program.pid]


@pytest.mark.at_any_pace
def test_the_papers_experiment_over_topics(tmp_path):
    result = run_in(tmp_path, 'paper', '--out', 'shown')
    assert result.returncode == 0, result.stderr
    folder = tmp_path / 'shown'
    figures = {'figure_5.png', 'figure_6.png', 'pressure_steps.png'}
    assert {path.name for path in folder.iterdir()} == figures | {'paper.txt'}
    for name in figures:
        picture = imread(folder / name)
        assert picture.std() > 0.05  # something is drawn
    table = (folder / 'paper.txt').read_text()
    assert table.strip() in result.stdout
    (force,) = (line for line in table.splitlines() if 'section 3' in line)
    assert ' '.join(force.split()) == 'F_spring at rest [N] 198.0 section 3 196.1 -1.9 -0.94 %'
    assert 'released at 600 kPa' in result.stderr  # its progress


@pytest.mark.at_any_pace
def test_an_unknown_chapter_is_refused_with_the_list_of_chapters(tmp_path):
    result = run_in(tmp_path, 'encore')
    assert result.returncode == 2
    assert 'the chapter encore does not exist' in result.stderr
    assert 'paper' in result.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    'kind', [signal.SIGINT, *map(at_release, (signal.SIGTERM, signal.SIGHUP))]
)
def test_a_signal_leaves_no_simulator_behind(tmp_path, kind):
    with subprocess.Popen(
        [*DEMO, 'paper'],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as demo:
        for line in demo.stderr:
            if 'released' in line:
                break
        children = children_of(demo)
        assert children
        os.killpg(demo.pid, kind)
        demo.stderr.read()
        assert demo.wait() == 130
    assert not [folder for folder in children if folder.exists()]
