# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fits of curves whose optimum is known, with errors whose covariance is."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.slopes import Slopes
from support.equations import LAYOUT, unknown

T = np.linspace(0.0, 5.0, 400)
NOISE = 0.05


@dataclass(frozen=True, eq=False)
class Equation(Problem):
    """A problem without a rig: ``function`` maps u (k,) to the residuals (n,) at T."""

    function: Callable = None

    def residuals(self, u):
        return self.function(np.asarray(u, dtype=float))

    def stamps(self):
        return [T]

    def by_run(self, values):
        return [values]

    def slopes(self, jacobian):
        return Slopes.of([jacobian], [np.arange(jacobian.shape[1])])


def equation(function, unknowns):
    row = np.zeros(LAYOUT.rows * LAYOUT.parameters)
    return Equation((), LAYOUT, (), row, tuple(unknowns), function=function)


LINE = np.stack([np.ones_like(T), T], axis=1)


def line(values, prior=100.0):
    """Return the problem of a straight line through *values* over T."""
    unknowns = [unknown('level', prior=prior), unknown('slope', prior=100.0)]
    return equation(lambda u: LINE @ u - values, unknowns)


def covariance(process):
    """Return that of the noise and the process at T, over the variance of the noise."""
    distance = np.abs(T[:, None] - T[None, :])
    return np.eye(T.size) + process.size**2 * np.exp(-distance / process.time)


def slow_error(rng, process):
    """Return a sample of noise and of the process at T."""
    root = np.linalg.cholesky(covariance(process))
    return NOISE * root @ rng.standard_normal(T.size)
