# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What every test run has: checked messages, plots without a screen; and for nodes a domain."""

import os
import signal
from pathlib import Path

import numpy as np
import pytest
import scipy
from hypothesis import settings

from pam_ros.compiled import HAVE_NUMBA
from support.distribution import PROFILE
from support.domain import DISCOVERY, NOT_CLAIMED, claimed
from support.identified import check_identified

# Fixtures of tests that start nodes, and of those that need still more: a browser, a shell without
# our environment to set up another one, a copy of the sources to build from.
DOMAINS = {'domain', 'module_domain'}
NOT_PURE = {*DOMAINS, 'browser', 'clean_environment', 'sources'}
pytest_plugins = ('support.browsing',)


def pytest_addoption(parser):
    parser.addoption(
        '--full',
        action='store_true',
        help='1500 examples of generated input, and more command lines: see CONTRIBUTING.md',
    )


def pytest_configure(config):
    # Shells start programs in the background with these signals ignored, which programs inherit.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for kind in (signal.SIGHUP, signal.SIGQUIT):
        signal.signal(kind, signal.SIG_DFL)
    os.environ['ROS_DOMAIN_ID'] = NOT_CLAIMED
    # What is LOCALHOST here is given in the profile: the ROS layer would choose shared memory.
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'SUBNET'
    os.environ.pop('ROS_STATIC_PEERS', None)
    os.environ[PROFILE] = str(DISCOVERY)
    os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'
    os.environ['MPLBACKEND'] = 'Agg'
    # For workers and programs: threads of linear algebra that wait for each other on cores that
    # others use as well cost forty times what they bring.
    os.environ['OPENBLAS_NUM_THREADS'] = '1'
    # A slow machine is no failure; and what passes once in CI passes each time.
    settings.register_profile('pam_ros', deadline=None, derandomize='CI' in os.environ)
    settings.register_profile('full', deadline=None, max_examples=1500)
    settings.load_profile('full' if config.getoption('full') else 'pam_ros')


def pytest_report_header():
    return (
        f'numpy {np.__version__}, scipy {scipy.__version__}, '
        f'{"with" if HAVE_NUMBA else "without"} numba'
    )


@pytest.hookimpl(tryfirst=True)  # before markers select
def pytest_collection_modifyitems(items):
    for item in items:
        # A launch test has no fixtures, and is run in its own way.
        fixtures = getattr(item, 'fixturenames', NOT_PURE)
        if NOT_PURE.isdisjoint(fixtures):
            item.add_marker(pytest.mark.pure)
        starts_nodes = not DOMAINS.isdisjoint(fixtures)
        if starts_nodes and not item.get_closest_marker('at_any_pace'):
            item.add_marker(pytest.mark.keeps_rate)
    if not HAVE_NUMBA:
        skip = pytest.mark.skip(reason='needs numba: takes too long as plain Python')
        for item in items:
            if item.get_closest_marker('needs_numba'):
                item.add_marker(skip)


@pytest.fixture(autouse=True)
def identified_files_are_compared(request):
    """After a test, compare each parameter file that it has left beside a report."""
    has_folder = 'tmp_path' in request.fixturenames
    folder = request.getfixturevalue('tmp_path') if has_folder else None
    yield
    for file in folder.rglob('identified.yaml') if folder else ():
        if (file.parent / 'report.json').is_file():
            check_identified(file)


@pytest.fixture(scope='module')
def module_domain():
    """Hold a ROS domain for nodes that all tests of a module share."""
    with claimed() as number:
        yield number


@pytest.fixture
def domain(request):
    """Hold a ROS domain for the nodes that a test starts, but for those that a module shares."""
    if 'module_domain' in request.fixturenames:
        yield request.getfixturevalue('module_domain')
        return
    with claimed() as number:
        yield number


@pytest.fixture(scope='session')
def shared_data():
    """Return the folder of measured data; tests that read it are skipped where it is absent."""
    folder = Path(os.environ.get('PAM_SHARED_DATA', Path(__file__).parents[2] / 'shared' / 'data'))
    if not folder.is_dir():
        pytest.skip(f'no measured data: {folder} is absent (PAM_SHARED_DATA names the folder)')
    return folder
