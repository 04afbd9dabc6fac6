# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The examples of the pages are tests: Sybil runs the Python that a page shows, in its order.

What is no example to be run as it stands has a test of its own: the controller of a
tutorial, which needs a simulator (``test/nodes/test_page_tables.py``), and the two files that
docs/tutorials/add_an_effect.md has a user write (``test/effects/test_guide.py``).
"""

import importlib.util
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parent
LONGEST_ID = 100  # characters
PAGE_ROOTS = ('README.md', 'ARCHITECTURE.md', 'CONTRIBUTING.md', 'docs')
PAGES = ('README.md', 'ARCHITECTURE.md', 'CONTRIBUTING.md', 'docs/*.md', 'docs/*/*.md')
FILES_OF_A_USER = ('docs/tutorials/add_an_effect.md',)
NEEDS_A_SIMULATOR = 'import rclpy'
# Not everywhere where ROS is: rosdep has no key for it.
HAVE_SYBIL = importlib.util.find_spec('sybil') is not None
# Nor for these, with which test/notebooks/ runs the notebooks.
OF_NOTEBOOKS = ('ipykernel', 'nbclient', 'nbformat')

# Assertions of helpers explain themselves and are counted as those of a test are.
SUPPORT = ROOT / 'test' / 'support'
pytest.register_assert_rewrite(*(f'support.{path.stem}' for path in SUPPORT.glob('*.py')))
pytest.register_assert_rewrite('truth')
pytest_plugins = ['support.assertions']


def pytest_report_header():
    """Say where the examples and the notebooks are not run."""
    lines = [] if HAVE_SYBIL else ['without Sybil: the examples of the pages are not run']
    absent = [name for name in OF_NOTEBOOKS if importlib.util.find_spec(name) is None]
    if absent:
        lines.append(f'without {", ".join(absent)}: the notebooks are not run')
    return lines


@pytest.fixture(scope='session')
def page_files(tmp_path_factory):
    """Return a folder with what the pages read: a bag, and the report of an identification."""
    from pam_ros.report.write import write_report
    from support import bags, results

    folder = tmp_path_factory.mktemp('page_files')
    topics, _ = bags.rig_topics(duration=12.0)
    topics['/cell'] = topics.pop('/force')
    bags.write_bag(folder / 'monday', topics)
    write_report(folder / 'report', *results.friction_result())
    return folder


@pytest.fixture(scope='module')
def working_folder(page_files, tmp_path_factory):
    """Work in a copy of that folder, which a page may write to."""
    folder = tmp_path_factory.mktemp('page') / 'work'
    shutil.copytree(page_files, folder)
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.chdir(folder)
        yield folder


def pytest_make_parametrize_id(val, argname):
    """Return a short id for a long value: ids are names in reports, and may be typed."""
    is_long = isinstance(val, str | bytes) and len(repr(val)) > LONGEST_ID
    return f'{argname} of {len(val)} characters' if is_long else None


if HAVE_SYBIL:
    from sybil import Sybil
    from sybil.integration.pytest import SybilItem
    from sybil.parsers.markdown import CodeBlockParser

    from support.examples import evaluate

    def examples(document):
        """Yield the examples of a page that are run as they stand."""
        for region in CodeBlockParser('python', evaluate)(document):
            if NEEDS_A_SIMULATOR not in region.parsed:
                yield region

    pytest_collect_file = Sybil(
        [examples],
        patterns=PAGES,
        excludes=FILES_OF_A_USER,
        setup=lambda names: names.update(__name__='page'),
        fixtures=['working_folder'],
    ).pytest()

    def pytest_configure(config):
        """Collect the pages, too, unless files are given."""
        if config.args_source is config.ArgsSource.TESTPATHS:
            config.args += [str(ROOT / name) for name in PAGE_ROOTS]

    def pytest_itemcollected(item):
        """Give examples the marks of tests that simulate for seconds."""
        if isinstance(item, SybilItem):
            item.add_marker(pytest.mark.slow)
            item.add_marker(pytest.mark.needs_numba)
