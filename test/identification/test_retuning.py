# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The problem of re-tuning: what it may change, and what it may not."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from pam_ros.identification.data.noise import Noise
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.retuning import only_starts, problem_of
from support import bench_truth

MODEL = bench_truth.declared(off=[0.01, -0.01, 0.0, 0.01, 0.0, 0.01])
NOISE = Noise(0.01, 0.0)


def free_segments(**settings):
    recording = bench_truth.free(**{'duration': 12.0, 'seed': 3, **settings})
    return segments_of([recording], keep_back=True)


def test_samples_that_were_thinned_are_less_alike():
    segments = free_segments()
    fitted = segments[0].fit.sum()
    for stride, rho in ((1, 0.8), (3, 0.8**3)):
        problem = problem_of(MODEL, segments, Noise(1e-5, 0.8), 5e-3, stride)
        assert problem.independent == pytest.approx(fitted * (1 - rho) / (1 + rho))
    names = [unknown.name for unknown in problem.unknowns]
    assert names == ['a1', 'a2', 'a3', 'a4', 'a5', 'a6', 'zeta', 'y0[0]', 'v0[0]']
    np.testing.assert_array_equal(problem.row, MODEL.parameters().ravel())


@pytest.mark.needs_numba
def test_the_declared_model_may_choose_its_start_and_nothing_else():
    problem = problem_of(MODEL, free_segments(), NOISE, 5e-3)
    wrong = np.zeros(9)
    wrong[7:] = 3.0, -2.0
    with ThreadPoolExecutor() as pool:
        solution = only_starts(problem, wrong, pool)
    assert not solution.u[:7].any()
    assert solution.cost < problem.cost(wrong, problem.residuals(wrong))
    np.testing.assert_allclose(
        solution.jacobian, problem.jacobian(solution.u, solution.r), rtol=1e-9, atol=1e-12
    )
