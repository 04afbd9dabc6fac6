# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Problems whose residuals are a plain function, so that closed forms and scipy can judge fits."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from pam_ros.identification.candidate import Fit
from pam_ros.identification.problem import Problem
from pam_ros.identification.segment import segments_of
from pam_ros.identification.solve import Solution
from pam_ros.identification.unknowns import Constant, Unknown
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import one_muscle


@dataclass(frozen=True, eq=False)
class Equation(Problem):
    """A problem without a rig: ``function`` maps u (k,) to the residuals (n,)."""

    function: Callable = None

    def residuals(self, u):
        return self.function(np.asarray(u, dtype=float))

    def errors(self, u):
        rms = float(np.sqrt(np.mean(self.residuals(u) ** 2)))
        return rms, rms


def equation(function, unknowns, independent):
    """Return the problem of *unknowns*: Unknowns, or names of ones that nothing is known of."""
    made = tuple(
        Unknown(Constant(one, 0), 0.0, 1.0) if isinstance(one, str) else one for one in unknowns
    )
    layout = one_muscle().layout
    row = np.zeros(layout.rows * layout.parameters)
    return Equation((), layout, (), row, made, independent, function=function)


def linear(columns, values, unknowns, independent):
    """Return the problem of explaining *values* (n,) by *columns* (n, k)."""
    return equation(lambda u: columns @ u - values, unknowns, independent)


def least_squares_fit(columns, values, names, independent, effects=()):
    """Return the Fit of *values* (n,) by *columns* (n, k), solved by numpy."""
    problem = linear(columns, values, names, independent)
    u = np.linalg.lstsq(columns, values, rcond=None)[0]
    r = columns @ u - values
    error = float(np.sqrt(np.mean(r**2)))
    return Fit(tuple(effects), Solution(problem, u, r, columns, 0), error, error)


@dataclass(frozen=True, eq=False)
class Missing(Problem):
    """A problem of one run that misses the measurement by u[0] times ``miss`` (n,)."""

    miss: np.ndarray = None

    def predict(self, u, only=-1):
        return [s.target + u[0] * self.miss for s in self.segments]


def missing(miss, size, effects=()):
    """Return the Fit of a run that misses what was measured by *size* times *miss* (n,)."""
    t = np.arange(miss.size) / 100.0
    recording = Recording('r', t, t, t, 0.0 * t, None, None, None, 'free')
    segments = segments_of([recording], keep_back=True)
    layout = one_muscle().layout
    row = np.zeros(layout.rows * layout.parameters)
    unknown = Unknown(Constant('size', 0), 0.0, 1.0)
    problem = Missing(segments, layout, (), row, (unknown,), float(miss.size), miss=miss)
    u = np.array([size])
    r = problem.residuals(u)
    solution = Solution(problem, u, r, r[:, None] / size, 1)
    return Fit(tuple(effects), solution, *problem.errors(u))


def coloured(rng, n, rho, sigma=1.0):
    """Return n samples of stationary AR(1) noise of standard deviation *sigma*."""
    white = rng.standard_normal(n)
    first = np.array([rho * rng.standard_normal()])
    drive = np.sqrt(1.0 - rho**2) * white
    return sigma * lfilter([1.0], [1.0, -rho], drive, zi=first)[0]
