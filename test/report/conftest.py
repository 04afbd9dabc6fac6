# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Traces and a browser for all tests of the report."""

import pytest

from pam_ros.report.runs import runs_of
from pam_ros.report.write import write_report
from support import traces


@pytest.fixture(scope='session')
def friction():
    """Return (trace, provenance, runs): friction found in one recording, a part held out."""
    trace, source = traces.friction_trace()
    return trace, source, runs_of(trace)


@pytest.fixture(scope='session')
def tested():
    """Return (trace, provenance, runs): the same with a gap, judged on a test recording."""
    trace, source = traces.friction_trace(test=True, gap=True)
    return trace, source, runs_of(trace)


@pytest.fixture(scope='session')
def clean():
    """Return (trace, provenance, runs): nothing is missing."""
    trace, source = traces.clean_trace()
    return trace, source, runs_of(trace)


@pytest.fixture(scope='session')
def held():
    """Return (trace, provenance, runs): hysteresis found in a muscle held at three lengths."""
    trace, source = traces.held_trace()
    return trace, source, runs_of(trace)


@pytest.fixture(scope='session', params=['friction', 'tested', 'clean', 'held'])
def any_trace(request):
    """Return (trace, provenance, runs) of each kind."""
    return request.getfixturevalue(request.param)


@pytest.fixture(scope='session')
def reports(tmp_path_factory):
    """Return a function that gives the folder of a report, written once for each trace."""
    folders = {}

    def written(parts):
        trace, source, _ = parts
        if id(trace) not in folders:
            folders[id(trace)] = tmp_path_factory.mktemp('reports') / 'report'
            write_report(folders[id(trace)], trace, source)
        return folders[id(trace)]

    return written


@pytest.fixture(scope='session')
def folder(any_trace, reports):
    """Return the folder of a written report, one for each kind of trace."""
    return reports(any_trace)


@pytest.fixture(scope='session')
def html(folder):
    """Return the page of a written report, one for each kind of trace."""
    return (folder / 'report.html').read_text(encoding='utf-8')
