# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A search in its middle: a rig with a lag, re-tuned."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from pam_ros.identification.data.parts import parts_of
from pam_ros.identification.fit.solve import solved
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.setting import Setting
from support import bench_truth
from truth import effect


@pytest.fixture(scope='package')
def setting():
    """Return the setting of a rig with a lag, recorded for 20 s."""
    recording = bench_truth.free(effect('pressure_lag'), seed=2, duration=20.0)
    parts = parts_of([recording], CRITERIA.fit, CRITERIA.choose)
    with ThreadPoolExecutor() as pool:
        yield Setting(bench_truth.declared(), parts, CRITERIA, BUDGET, pool)


@pytest.fixture(scope='package')
def retuned(setting):
    """Return the re-tuned model of that rig."""
    problem = setting.problem
    return setting.model((), solved(problem, np.zeros(len(problem.unknowns))))
