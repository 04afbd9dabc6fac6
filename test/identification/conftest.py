# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A search in its middle: a rig with a lag, re-tuned."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.identification.search.final import fit_finally
from support import bench_truth, results
from support.searches import FILL, found_in, retuned_of, setting_of
from truth import effect


@pytest.fixture(scope='package')
def setting(pool):
    """Return the setting of a rig with a lag, recorded for 20 s."""
    recording = bench_truth.free(effect('pressure_lag'), seed=2, duration=20.0)
    return setting_of([recording], pool)


@pytest.fixture(scope='package')
def retuned(setting):
    """Return the re-tuned model of that rig."""
    return retuned_of(setting)


@pytest.fixture(scope='package')
def pool():
    """Return the threads in which fits run."""
    with ThreadPoolExecutor() as threads:
        yield threads


@pytest.fixture(scope='package')
def recording():
    """Return 24 s of a rig with a lag, at 250 Hz."""
    lag = effect('pressure_lag', fill_s=FILL, vent_s=FILL)
    return bench_truth.free(lag, seed=12, duration=24.0, rate=250.0)


@pytest.fixture(scope='package')
def found(recording, pool):
    """Return a search of it that has found the lag."""
    if not HAVE_NUMBA:
        pytest.skip('a search takes too long as plain Python')
    return found_in([recording], pool)


@pytest.fixture(scope='package')
def ends(found):
    """Return its models, fitted in full."""
    return fit_finally(found)


@pytest.fixture(scope='session')
def friction():
    """Return the result of a free rig with friction that was found."""
    return results.friction_result()[0]


@pytest.fixture(scope='session')
def clean():
    """Return the result of a free rig that lacks nothing."""
    return results.clean_result()[0]


@pytest.fixture(scope='session')
def held():
    """Return the result of a muscle held at three lengths, with hysteresis found."""
    return results.held_result()[0]
