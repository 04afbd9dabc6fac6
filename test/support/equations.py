# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Problems whose residuals are a plain function, so that closed forms and scipy can judge fits."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from pam_ros.effects.names import parsed
from pam_ros.identification.candidate import Fit
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.unknowns import Constant, OfEffect, RunStart, Unknown
from pam_ros.identification.problem import Problem
from pam_ros.identification.solve import Solution
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import one_muscle

LAYOUT = one_muscle().layout


def unknown(name, base=0.0, scale=1.0, *numbers, index=0, run=None, **more):
    """Return an unknown by its name; of the start of a *run*, where one is given."""
    if run is not None:
        of = RunStart(run, name.startswith('v'))
    elif parsed(name):
        of = OfEffect(parsed(name), index)
    else:
        of = Constant(name, index)
    return Unknown(of, base, scale, *numbers, **more)


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
    made = tuple(unknown(one) if isinstance(one, str) else one for one in unknowns)
    row = np.zeros(LAYOUT.rows * LAYOUT.parameters)
    return Equation((), LAYOUT, (), row, made, independent, function=function)


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

    def predict(self, u, only=None):
        return [s.target + u[0] * self.miss for s in self.segments]


def missing(miss, size, effects=()):
    """Return the Fit of a run that misses what was measured by *size* times *miss* (n,)."""
    t = np.arange(miss.size) / 100.0
    recording = Recording('r', t, t, t, 0.0 * t, None, None, None, 'free')
    segments = segments_of([recording], keep_back=True)
    row = np.zeros(LAYOUT.rows * LAYOUT.parameters)
    problem = Missing(segments, LAYOUT, (), row, (unknown('size'),), float(miss.size), miss=miss)
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
