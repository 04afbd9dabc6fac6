# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When does an effect count? Tests that noise, however coloured, does not pass by itself."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import f as f_distribution

from pam_ros.identification.candidate import Fit
from pam_ros.identification.data.noise import independent_share
from pam_ros.identification.fit.unknowns import OfEffect
from pam_ros.identification.problem import Problem

Array = NDArray[np.float64]

SIGNIFICANCE = 0.01  # of the whole family of candidates
GAIN = 0.03  # least relative fall of the RMSE kept back
LOSS = 0.15  # relative rise of it that parameters near to those declared may cost
LATER_SHARE = 0.03  # a second or third effect must explain this share of what re-tuning left
AMBIGUOUS = 6.0  # difference of scores that does not decide between two effects
LATER_GAIN = 0.4  # or lower the RMSE kept back by this share
HARDLY = 1e-3  # share of a strength that is as good as none of it
BEYOND_DOUBT = 1e-6  # p of the model without an effect that needs no interval
SIGMAS = 2.6  # of a strength's distance from 0
LEAST = 24.0
FEWEST = 12.0  # degrees of freedom of a residual that drifts
LONGEST = 4000  # samples over which a residual's correlation is summed


@dataclass(frozen=True)
class Evidence:
    """What speaks for a fit with one more effect than its parent."""

    p: float
    gain: float
    interval_clear: bool
    absorbed: bool


def independent_samples(fit: Fit) -> float:
    """Return how many independent samples the residuals of *fit* are worth in a test.

    The fewer of what the noise allows and of what their own correlation allows, but not below
    LEAST: a drift that fills the record has no correlation time that the record could show.
    """
    r = fit.solution.r
    own = max(LEAST, r.size * independent_share(r, LONGEST))
    return min(fit.solution.problem.independent, own)


def f_test(parent: Fit, child: Fit) -> float:
    """Return the p value of the child's lower sum of squares under the parent's model."""
    k = len(child.solution.u) - len(parent.solution.u)
    left = float(child.solution.r @ child.solution.r)
    fall = float(parent.solution.r @ parent.solution.r) - left
    freedom = max(independent_samples(child) - len(child.solution.u), FEWEST)
    if fall <= 0.0:
        return 1.0
    # Sums of squares are scaled alike by samples per independent sample, so the ratio stands.
    return float(f_distribution.sf((fall / k) / (left / freedom), k, freedom))


def holm(p: Array) -> Array:
    """Return p values corrected for their number after Holm (1979)."""
    order = np.argsort(p)
    m = p.size
    corrected = np.minimum(1.0, np.maximum.accumulate(p[order] * (m - np.arange(m))))
    out = np.empty(m)
    out[order] = corrected
    return out


def strengths_clear(fit: Fit, p: float) -> bool:
    """Say whether a strength of the newest effect is surely not 0 and has its physical sign.

    Either its standard error says so, or the model without the effect is as unlikely as *p* and
    taking the strength away, all else kept, leaves an unlikely one, too: a stop may be of any
    stiffness above some, and its standard error is then no measure of the distance from none. A
    strength that does nothing while the effect's other parameters do the work is not clear.
    """
    solution = fit.solution
    problem: Problem = solution.problem
    worth = max(independent_samples(fit) / problem.independent, 1e-6)
    error = np.sqrt(np.diag(solution.covariance()) / worth)
    effect = next(e for e in problem.layout.library if e.name == fit.effects[-1])
    signs = {p.name: p.sign for p in effect.parameters if p.strength}
    for k, unknown in enumerate(problem.unknowns):
        of = unknown.of
        if not isinstance(of, OfEffect) or of.which.effect != effect.name:
            continue
        name = of.which.parameter
        if name not in signs:
            continue
        value = solution.u[k]
        if not (value * signs[name] > 0.0 if signs[name] else value != 0.0):
            continue
        if abs(value) > SIGMAS * error[k]:
            return True
        if p < BEYOND_DOUBT:
            without = solution.u.copy()
            without[k] *= HARDLY
            rise = problem.cost(without, problem.residuals(without)) - solution.cost
            if rise * worth > SIGMAS**2:
                return True
    return False


def held_difference(a: Fit, b: Fit) -> tuple[float, float]:
    """Return mean and standard error of e_b^2 - e_a^2 over the samples kept back."""
    d = _held(b) ** 2 - _held(a) ** 2
    if d.size == 0:
        return 0.0, np.inf
    independent = max(2.0, d.size * independent_share(d, LONGEST))
    return float(d.mean()), float(d.std() / np.sqrt(independent))


def _held(fit: Fit) -> Array:
    problem = fit.solution.problem
    parts = [
        (p - s.target)[~s.fit]
        for p, s in zip(problem.predict(fit.solution.u), problem.segments, strict=True)
    ]
    return np.concatenate(parts)
