# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A search in its middle: a rig with a lag, re-tuned."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.identification.data.parts import parts_of
from pam_ros.identification.fit.solve import solve
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.final import fit_finally
from pam_ros.identification.search.setting import Setting
from support import bench_truth
from support.searches import FILL, found_in
from truth import effect


@pytest.fixture(scope='package')
def setting():
    """Return the setting of a rig with a lag, recorded for 20 s."""
    recording = bench_truth.free(effect('pressure_lag'), seed=2, duration=20.0)
    parts = parts_of([recording], CRITERIA.fit, CRITERIA.choose)
    with ThreadPoolExecutor() as pool:
        yield Setting(bench_truth.nominal(), parts, CRITERIA, BUDGET, pool)


@pytest.fixture(scope='package')
def retuned(setting):
    """Return the re-tuned model of that rig."""
    problem = setting.problem
    return setting.model((), solve(problem, np.zeros(len(problem.unknowns))))


@pytest.fixture(scope='package')
def pool():
    """Return one thread, in which fits run."""
    with ThreadPoolExecutor(1) as one:
        yield one


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
