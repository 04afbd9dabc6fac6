# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The Python that the pages show, each page in its order: it runs and prints what it says.

``print(...)  # text`` says that this text is printed. Run elsewhere are the controller of the
README (``test/nodes/test_readme.py``), the two files of docs/effects.md
(``test/effects/test_guide.py``), and what reads a report (``test/report/test_numbers.py``).
"""

import re

import pytest

from support import bags
from support.pages import PAGES, blocks

ELSEWHERE = ('effects.md', 'report.md')
SAYS = re.compile(r'^ *print\(.*\)  # (.*)$', re.MULTILINE)


def examples(page):
    """Return the blocks of Python of a page that are run here."""
    if page.name in ELSEWHERE:
        return []
    return [block for block in blocks(page, 'python') if 'import rclpy' not in block]


SHOWING = [page for page in PAGES if examples(page)]


@pytest.fixture
def monday(tmp_path, monkeypatch):
    """Work where there is the recording that docs/recordings.md reads."""
    topics, _ = bags.rig_topics(duration=12.0)
    topics['/cell'] = topics.pop('/force')
    bags.write_bag(tmp_path / 'monday', topics)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_pages_with_examples_are_known():
    names = [page.name for page in SHOWING]
    assert names == ['README.md', 'joints.md', 'model.md', 'python.md', 'recordings.md']


@pytest.mark.slow
@pytest.mark.needs_numba
@pytest.mark.parametrize('page', SHOWING, ids=lambda page: page.name)
def test_examples_run_and_print_what_they_say(page, monday, capsys):
    names = {'__name__': 'page'}
    for example in examples(page):
        exec(compile(example, str(page), 'exec'), names)
        printed = iter(capsys.readouterr().out.splitlines())
        for text in SAYS.findall(example):
            assert text in printed, text  # and what comes before it is passed over
    if page.name == 'recordings.md':
        assert names['recording'].force is not None
        assert (monday / 'monday.csv').stat().st_size > 0


@pytest.mark.parametrize('page', SHOWING, ids=lambda page: page.name)
def test_examples_import_from_the_public_face_alone(page):
    for example in examples(page):
        for module in re.findall(r'^from (pam_ros\S*) import', example, re.MULTILINE):
            assert module == 'pam_ros'
