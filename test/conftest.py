# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What every test run has: its own ROS domain, checked messages, plots without a screen."""

import os
from pathlib import Path

import numpy as np
import pytest
import scipy
from hypothesis import settings

from pam_ros.compiled import HAVE_NUMBA
from support.domain import claim_domain

DOMAIN = pytest.StashKey()
NODES = Path(__file__).parent / 'nodes'
DISCOVERY = Path(__file__).parent / 'support' / 'discovery.xml'


def pytest_configure(config):
    domain, lock = claim_domain()
    config.stash[DOMAIN] = lock  # held until the run ends
    os.environ['ROS_DOMAIN_ID'] = str(domain)
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    os.environ.pop('ROS_STATIC_PEERS', None)
    os.environ['FASTRTPS_DEFAULT_PROFILES_FILE'] = str(DISCOVERY)
    os.environ['ROS_PYTHON_CHECK_FIELDS'] = '1'
    os.environ['MPLBACKEND'] = 'Agg'
    # A slow machine is no failure; and what passes once in CI passes each time.
    settings.register_profile('pam_ros', deadline=None, derandomize='CI' in os.environ)
    settings.load_profile('pam_ros')


def pytest_unconfigure(config):
    config.stash[DOMAIN].close()


def pytest_report_header():
    return (
        f'numpy {np.__version__}, scipy {scipy.__version__}, '
        f'{"with" if HAVE_NUMBA else "without"} numba, ROS_DOMAIN_ID {os.environ["ROS_DOMAIN_ID"]}'
    )


@pytest.hookimpl(tryfirst=True)  # before markers select
def pytest_collection_modifyitems(items):
    for item in items:
        if item.path.is_relative_to(NODES) and not item.get_closest_marker('at_any_pace'):
            item.add_marker(pytest.mark.keeps_rate)
    if not HAVE_NUMBA:
        skip = pytest.mark.skip(reason='needs numba: takes too long as plain Python')
        for item in items:
            if item.get_closest_marker('needs_numba'):
                item.add_marker(skip)


@pytest.fixture(scope='session')
def shared_data():
    """Return the folder of measured data; tests that read it are skipped where it is absent."""
    folder = Path(os.environ.get('PAM_SHARED_DATA', Path(__file__).parents[2] / 'shared' / 'data'))
    if not folder.is_dir():
        pytest.skip(f'no measured data: {folder} is absent (PAM_SHARED_DATA names the folder)')
    return folder
