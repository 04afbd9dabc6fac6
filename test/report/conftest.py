# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Results and a browser for all tests of the report."""

import pytest

from pam_ros.report.runs import runs_of
from pam_ros.report.write import write_report
from support import results


@pytest.fixture(scope='session')
def friction():
    """Return (result, provenance, runs): friction found in one recording, a part held out."""
    result, source = results.friction_result()
    return result, source, runs_of(result)


@pytest.fixture(scope='session')
def tested():
    """Return (result, provenance, runs): the same with a gap, judged on a test recording."""
    result, source = results.friction_result(test=True, gap=True)
    return result, source, runs_of(result)


@pytest.fixture(scope='session')
def clean():
    """Return (result, provenance, runs): nothing is missing."""
    result, source = results.clean_result()
    return result, source, runs_of(result)


@pytest.fixture(scope='session')
def held():
    """Return (result, provenance, runs): hysteresis found in a muscle held at three lengths."""
    result, source = results.held_result()
    return result, source, runs_of(result)


@pytest.fixture(scope='session', params=['friction', 'tested', 'clean', 'held'])
def any_result(request):
    """Return (result, provenance, runs) of each kind."""
    return request.getfixturevalue(request.param)


@pytest.fixture(scope='session')
def reports(tmp_path_factory):
    """Return a function that gives the folder of a report, written once for each result."""
    folders = {}

    def written(parts):
        result, source, _ = parts
        if id(result) not in folders:
            folders[id(result)] = tmp_path_factory.mktemp('reports') / 'report'
            write_report(folders[id(result)], result, source)
        return folders[id(result)]

    return written


@pytest.fixture(scope='session')
def folder(any_result, reports):
    """Return the folder of a written report, one for each kind of result."""
    return reports(any_result)


@pytest.fixture(scope='session')
def html(folder):
    """Return the page of a written report, one for each kind of result."""
    return (folder / 'report.html').read_text(encoding='utf-8')
