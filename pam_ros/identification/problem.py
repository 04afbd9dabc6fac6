# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Output-error residuals: free runs of the rig's kernel against what was measured."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.identification.data.segment import FreeSegment, HeldSegment, Segment
from pam_ros.identification.data.thinning import HELD_STEP
from pam_ros.identification.fit.unknowns import Constant, OfEffect, RunStart, Unknown
from pam_ros.rig import layout as at
from pam_ros.rig.bind import bind
from pam_ros.rig.layout import Layout
from pam_ros.rig.run import acting_commands, delays_of
from pam_ros.rig.start import start_state

Array = NDArray[np.float64]
DIFFERENCE = 1e-3  # step of u for a derivative; a thousandth of a parameter's typical size


@dataclass(frozen=True, eq=False)
class Problem:
    """Runs to be explained by parameters of which some are unknown.

    ``row`` holds the values of what is not unknown, all rows of the kernel's q one after the
    other; ``step`` is the longest step in s, and
    ``slope_step`` that of the runs from which derivatives come, where it is longer: they need
    not be as exact as what they correct.
    ``independent`` is how many independent samples the fitted ones are worth. Residuals
    beyond ``outlier`` (in the target's unit) count by their size, not its square (pseudo-Huber);
    those of run k are multiplied by ``weights[k]``, if there are any weights.
    """

    segments: Sequence[Segment]
    layout: Layout
    active: tuple[Effect, ...]
    row: Array
    unknowns: tuple[Unknown, ...]
    independent: float
    step: float = 1e-3
    outlier: float = np.inf
    slope_step: float = 0.0
    weights: tuple[float, ...] = ()
    fit_rows: tuple[NDArray[np.intp], ...] = field(init=False)

    def __post_init__(self) -> None:
        """Find the samples to be fitted once."""
        rows = tuple(np.flatnonzero(s.fit) for s in self.segments)
        object.__setattr__(self, 'fit_rows', rows)

    def row_at(self, u: Array) -> Array:
        """Return the parameter row at the unknowns u."""
        q: Array = self.row.copy()
        for unknown, value in zip(self.unknowns, u, strict=True):
            if isinstance(unknown.of, Constant | OfEffect):
                q[unknown.of.index] = unknown.value(value)
        return q

    def matrix_at(self, u: Array) -> Array:
        """Return the kernel's parameters q at the unknowns u."""
        return self.row_at(u).reshape(self.layout.rows, self.layout.parameters)

    def runs(self, u: Array, only: int | None = None) -> list[Array]:
        """Return the free run of every segment, or of segment *only*, at u.

        Each is (n, 4): position m, velocity m/s, chamber pressure Pa, and for held segments
        the force N.
        """
        q = self.matrix_at(u)
        kernel, scratch = bind(self.layout, self.active), self.layout.scratch()
        delays = delays_of(self.layout, q)
        found = []
        for k, s in enumerate(self.segments):
            if only not in (None, k):
                continue
            y0, v0 = s.y0, s.v0
            for unknown, value in zip(self.unknowns, u, strict=True):
                if isinstance(unknown.of, RunStart) and unknown.of.run == k:
                    if unknown.of.is_velocity:
                        v0 = unknown.value(value)
                    else:
                        y0 = unknown.value(value)
            out = np.empty((s.t.size, self.layout.run_columns))
            x = start_state(self.layout, q, (s.first_pressure,), y0, v0)
            if isinstance(s, FreeSegment):
                act_t, acting = acting_commands(s.drive_t, s.drive[:, None], delays)
                kernel.simulate(x, scratch, q, s.t, act_t, acting, self.step, out, False)
            elif isinstance(s, HeldSegment):
                pressure = s.pressure[:, None]
                kernel.simulate_held(
                    x, scratch, q, s.t, pressure, s.position, s.velocity, HELD_STEP, out
                )
            found.append(out)
        return found

    def predict(self, u: Array, only: int | None = None) -> list[Array]:
        """Return the simulated target of every segment, or of segment *only*, at u."""
        column = at.RUN_S if self.segments[0].kind == 'free' else at.RUN_F
        return [out[:, column] for out in self.runs(u, only)]

    def residuals(self, u: Array) -> Array:
        """Return simulated - measured of the samples to be fitted, outliers compressed.

        A simulation that diverges gives large finite residuals, so that a fit steps back.
        """
        return np.concatenate([self._left(k, p) for k, p in enumerate(self.predict(u))])

    def _left(self, k: int, simulated: Array) -> Array:
        """Return the residuals of run k: their squares are pseudo-Huber's loss."""
        rows = self.fit_rows[k]
        e = finite(simulated[rows] - self.segments[k].target[rows])
        d = self.outlier
        if d < np.inf:
            e = np.sign(e) * d * np.sqrt(2.0 * (np.sqrt(1.0 + (e / d) ** 2) - 1.0))
        return self.weights[k] * e if self.weights else e

    def priors(self, u: Array) -> Array:
        """Return the distance of every unknown from what is expected, in standard deviations."""
        return np.array([x / k.prior for k, x in zip(self.unknowns, u, strict=True)])

    def cost(self, u: Array, r: Array) -> float:
        """Return -2 log posterior at u with residuals r, the noise variance profiled out."""
        z = self.priors(u)
        return float(self.independent * np.log(np.mean(r * r) + 1e-300) + z @ z)

    def jacobian(
        self, u: Array, r: Array, pool: Executor | None = None, only: Sequence[int] | None = None
    ) -> Array:
        """Return dr/du (rows, columns) by differences, one column a simulation.

        *r* are the residuals at u; *only* restricts the columns; *pool* runs them side by side.
        A column steps to the side that its bounds leave open.
        """
        if self.slope_step > self.step:
            coarse = replace(self, step=self.slope_step, slope_step=0.0)
            return coarse.jacobian(u, coarse.residuals(u), pool, only)
        columns = range(len(u)) if only is None else only

        def column(k: int) -> Array:
            unknown = self.unknowns[k]
            h = DIFFERENCE if u[k] + DIFFERENCE <= unknown.bounds[1] else -DIFFERENCE
            moved = u.copy()
            moved[k] += h
            if isinstance(unknown.of, RunStart):
                return self._column_of_run(moved, r, h, unknown.of.run)
            return (self.residuals(moved) - r) / h

        run: Callable[..., object] = map if pool is None else pool.map
        return np.stack(list(run(column, columns)), axis=1)  # type: ignore[call-overload]

    def _column_of_run(self, moved: Array, r: Array, h: float, run: int) -> Array:
        """Return the column of what a run has for itself: only that run changes."""
        out = np.zeros_like(r)
        first = sum(rows.size for rows in self.fit_rows[:run])
        own = slice(first, first + self.fit_rows[run].size)
        out[own] = (self._left(run, self.predict(moved, run)[0]) - r[own]) / h
        return out

    def errors(self, u: Array) -> tuple[float, float]:
        """Return the RMSE of the fitted samples and of those kept back (NaN without any)."""
        fit, held = [], []
        for p, s in zip(self.predict(u), self.segments, strict=True):
            e = p - s.target
            fit.append(e[s.fit])
            held.append(e[~s.fit])
        return _rms(np.concatenate(fit)), _rms(np.concatenate(held))


def finite(e: Array) -> Array:
    """Return *e* with what is no number, or beyond all reason, as large numbers."""
    return np.clip(np.nan_to_num(e, nan=1e6), -1e6, 1e6)


def _rms(e: Array) -> float:
    return float(np.sqrt(np.mean(e * e))) if e.size else float('nan')
