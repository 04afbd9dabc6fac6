# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fit the constants a1..a6 of the force law to a measured static map, with standard errors.

For a given a3, equation (1) of Sárosi (2015) is linear in the other five constants. So only a3 is
searched, in one dimension, and the others are solved for each trial value (variable projection,
Golub & Pereyra 1973). No starting values are needed, and the least error over a wide range of a3
is the global minimum.

If a muscle is slack, the force law gives a pushing force, but the force cell reads 0. Such a point
only shows that the force of the law is not above this reading. It is fitted as censored (Tobin
1958), in the form of Olsen (1978), which is concave for the five linear constants and the noise
together. So the search stays one-dimensional and reliable.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar
from scipy.special import log_ndtr

from pam_ros.arguments import array, number
from pam_ros.errors import ParameterError
from pam_ros.muscle import law
from pam_ros.muscle.constants import CONTRACTION_UNITS, PRESSURE_UNITS, Constants
from pam_ros.muscle.muscle import Muscle

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
# -a3 times the largest absolute contraction of the map; with published muscles it is 8.
A3_RANGE = (0.2, 100.0)


@dataclass(frozen=True, eq=False)
class StaticFit:
    """The constants that explain a static map best, and their uncertainty.

    ``constants`` and ``standard_errors`` are a1..a6 in N, *pressure_unit* and *contraction_unit*;
    ``covariance`` (6, 6) is in the same units. ``rmse`` in N is over the ``points`` that were
    fitted; ``slack_points`` of the map were censored or left out. ``residuals`` (map) in N are
    measured minus fitted values, NaN for slack points.
    """

    constants: Constants
    standard_errors: Constants
    covariance: Array
    rmse: float
    points: int
    slack_points: int
    residuals: Array
    pressure_unit: str
    contraction_unit: str

    def muscle(self, **fields: Any) -> Muscle:
        """Return a muscle with these constants; *fields* are other fields of Muscle.

        Raises ParameterError if these are not valid for a muscle, as Muscle does.
        """
        a1, a2, a3, a4, a5, a6 = self.constants
        return Muscle(
            a1=a1,
            a2=a2,
            a3=a3,
            a4=a4,
            a5=a5,
            a6=a6,
            pressure_unit=self.pressure_unit,
            contraction_unit=self.contraction_unit,
            **fields,
        )


def fit_static_map(
    p: ArrayLike,
    kappa: ArrayLike,
    force: ArrayLike,
    pressure_unit: str = 'Pa',
    contraction_unit: str = 'fraction',
    slack_at: float | None = None,
    slack: str = 'censored',
) -> StaticFit:
    """Fit a1..a6 to a static map by least squares (by maximum likelihood with censored points).

    p, kappa, force: arrays of one shape, one entry for each measured point: gauge pressure in
    *pressure_unit*, contraction in *contraction_unit* (positive when shortened), pulling force in
    N. The constants have the same units. Readings of *slack_at* N or less are slack points, and
    *slack* ('censored' or 'excluded') sets how they are used. Without *slack_at* every number is
    used as measured.

    Standard errors hold for independent errors of equal size and are those of the linearised
    problem, with the noise estimated from the residuals (points - 6 degrees of freedom).

    Raises ParameterError for arrays that do not fit together, unknown units, and a map that does
    not determine the six constants.
    """
    p, kappa, force = _map(p=p, kappa=kappa, force=force)
    slack_at = None if slack_at is None else number('slack_at', slack_at)
    _one_of('pressure_unit', pressure_unit, tuple(PRESSURE_UNITS))
    _one_of('contraction_unit', contraction_unit, tuple(CONTRACTION_UNITS))
    _one_of('slack', slack, ('censored', 'excluded'))
    slack_points = force <= (-np.inf if slack_at is None else slack_at)
    used = np.ones_like(slack_points) if slack == 'censored' else ~slack_points
    # Scales for the search, so that all values are of the order of 1.
    p_unit, kappa_unit, n = (
        float(np.max(np.abs(a[used]), initial=0.0)) or 1.0 for a in (p, kappa, force)
    )
    scaled, spread = _Search(
        p=p[used] / p_unit,
        kappa=kappa[used] / kappa_unit,
        force=force[used] / n,
        slack=slack_points[used],
        level=0.0 if slack_at is None else slack_at / n,
    ).run()
    size = np.array([n / p_unit, n, 1 / kappa_unit, n / p_unit / kappa_unit, n / p_unit, n])
    constants = scaled * size
    covariance = spread * np.outer(size, size)
    a1, a2, a3, a4, a5, a6 = (float(a) for a in constants)
    residuals = force - law.force_v(p, kappa, a1, a2, a3, a4, a5, a6)
    residuals = np.where(slack_points, np.nan, residuals)
    e1, e2, e3, e4, e5, e6 = (float(e) for e in np.sqrt(np.diag(covariance)))
    return StaticFit(
        constants=(a1, a2, a3, a4, a5, a6),
        standard_errors=(e1, e2, e3, e4, e5, e6),
        covariance=covariance,
        rmse=float(np.sqrt(np.nanmean(residuals**2))),
        points=int(np.count_nonzero(~slack_points)),
        slack_points=int(np.count_nonzero(slack_points)),
        residuals=residuals,
        pressure_unit=pressure_unit,
        contraction_unit=contraction_unit,
    )


def _map(**columns: ArrayLike) -> list[Array]:
    arrays = [array(name, column) for name, column in columns.items()]
    if len({a.shape for a in arrays}) != 1:
        shapes = ', '.join(str(a.shape) for a in arrays)
        raise ParameterError(f'p, kappa and force must have one shape, not {shapes}')
    return arrays


def _one_of(name: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise ParameterError(f'{name} = {value!r} is not known: give one of ' + ', '.join(allowed))


@dataclass(frozen=True, eq=False)
class _Search:
    """A map scaled by its own size; ``slack`` marks points that are at most ``level``."""

    p: Array
    kappa: Array
    force: Array
    slack: Mask
    level: float

    def run(self) -> tuple[Array, Array]:
        """Return a1..a6 and their covariance."""
        measured = int(np.count_nonzero(~self.slack))
        if measured < 7:
            raise ParameterError(
                f'{measured} measured points do not determine six constants and the noise: '
                'give at least 7 with a pull'
            )
        trials = np.log(np.geomspace(*A3_RANGE, 40))
        costs = [self._solve(-np.exp(t))[1] for t in trials]
        best = int(np.argmin(costs))
        if best in (0, len(trials) - 1):
            zeros = int(np.count_nonzero(self.force[~self.slack] == 0.0))
            hint = f' ({zeros} readings of 0 N: if the muscle is slack there, give slack_at=0)'
            raise ParameterError(
                'the map does not determine a3: its curve over contraction shows no bend that the '
                'exponential of the force law could explain; give more contractions'
                + (hint if zeros > 1 else '')
            )
        found = minimize_scalar(
            lambda t: self._solve(-np.exp(t))[1],
            bounds=(trials[best - 1], trials[best + 1]),
            method='bounded',
            options={'xatol': 1e-9},
        )
        a3 = -float(np.exp(found.x))
        linear, _, noise = self._solve(a3)
        constants = np.insert(linear, 2, a3)
        return constants, self._covariance(constants, noise)

    def _columns(self, a3: float) -> Array:
        """Return the factors of a1, a2, a4, a5 and a6 in (1), (points, 5)."""
        e = np.exp(a3 * self.kappa)
        return np.stack([self.p * e, e, self.kappa * self.p, self.p, np.ones_like(e)], axis=-1)

    def _solve(self, a3: float) -> tuple[Array, float, float]:
        """Return a1, a2, a4, a5, a6 at a given a3, the cost there, and the noise (1 sigma)."""
        columns = self._columns(a3)
        x, y = columns[~self.slack], self.force[~self.slack]
        # Columns are scaled to one length, and least squares uses singular values: exp() over a
        # short range is nearly a straight line.
        size = np.linalg.norm(columns, axis=0)
        linear = np.linalg.lstsq(x / size, y, rcond=None)[0]
        noise = float(np.sqrt(np.mean((y - x / size @ linear) ** 2)))
        noise = max(noise, 1e-12)  # a map without any noise
        cost = y.size * np.log(noise)
        if np.any(self.slack):
            linear, noise, cost = self._censored(columns / size, linear, noise)
        return linear / size, float(cost), noise

    def _censored(self, x: Array, linear: Array, noise: float) -> tuple[Array, float, float]:
        """Return linear constants, noise and cost at the maximum likelihood (Newton's method)."""
        slack = self.slack
        # With u = (linear, 1)/sigma, rows @ u are the residuals over sigma. Those of slack points
        # are relative to the level.
        rows = np.column_stack([-x, np.where(slack, self.level, self.force)])
        measured = np.count_nonzero(~slack)
        u = np.append(linear, 1.0) / noise

        def cost(u: Array) -> float:
            if u[-1] <= 0.0:
                return np.inf
            r = rows @ u
            fit = 0.5 * np.sum(r[~slack] ** 2) - np.sum(log_ndtr(r[slack]))
            return float(fit - measured * np.log(u[-1]))

        now = cost(u)
        for _ in range(100):
            r = rows @ u
            pull, weight = _mills(r, slack)
            gradient = rows.T @ pull
            gradient[-1] -= measured / u[-1]
            information = rows.T @ (weight[:, None] * rows)
            information[-1, -1] += measured / u[-1] ** 2
            step = np.linalg.lstsq(information, gradient, rcond=1e-14)[0]
            share = 1.0
            while (new := cost(u - share * step)) > now and share > 1e-6:
                share *= 0.5
            if now - new <= 1e-12 * abs(now):
                break
            u, now = u - share * step, new
        return u[:-1] / u[-1], 1.0 / u[-1], now

    def _covariance(self, constants: Array, noise: float) -> Array:
        """Return the inverse information of a1..a6, with the noise estimated at the same time."""
        a1, a2, a3 = constants[:3]
        columns = self._columns(a3)
        by_a3 = (a1 * self.p + a2) * self.kappa * np.exp(a3 * self.kappa)
        jacobian = np.insert(columns, 2, by_a3, axis=1)
        measured = np.count_nonzero(~self.slack)
        size = np.linalg.norm(jacobian, axis=0)
        if np.linalg.matrix_rank(jacobian[~self.slack] / size, tol=1e-7) < 6:
            raise ParameterError(
                'the map does not determine the six constants: give more pressures (2 or more) '
                'and contractions (4 or more) with a pull'
            )
        # Second derivatives of the cost by the constants and by the logarithm of the noise. For
        # measured points they are simple, since the first derivatives are 0 at the optimum.
        r = (
            np.where(self.slack, self.level, self.force) - columns @ np.delete(constants, 2)
        ) / noise
        pull, weight = _mills(r, self.slack)
        jacobian /= size
        mixed = np.where(self.slack, weight * r - pull, 0.0)
        information = jacobian.T @ (weight[:, None] * jacobian)
        beside = jacobian.T @ mixed
        information -= np.outer(beside, beside) / (2.0 * measured + r @ mixed)
        spread = noise**2 * np.linalg.inv(information) * measured / (measured - 6)
        return np.asarray(spread / np.outer(size, size), dtype=float)


def _mills(r: Array, slack: Mask) -> tuple[Array, Array]:
    """Return the first and second derivative of the cost by the scaled residuals r.

    The cost is r^2/2 for measured points, and -log Phi(r) for slack points.
    """
    ratio = np.exp(-0.5 * r * r - 0.5 * np.log(2.0 * np.pi) - log_ndtr(r))
    return np.where(slack, -ratio, r), np.where(slack, ratio * (ratio + r), 1.0)
