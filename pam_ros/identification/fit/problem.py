# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A model with unknowns, and recordings that it must explain: free runs against measurements.

Residuals and their derivatives are in the unit of the measurement; the discrepancy gives their
weights, see :mod:`pam_ros.identification.fit.discrepancy`. So one Jacobian, which costs one
simulation per column, can be used for every discrepancy.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from pam_ros.cached_property import cached_property
from pam_ros.effects.base import Effect
from pam_ros.identification.data.segment import (
    CommandedSegment,
    FreeSegment,
    HeldSegment,
    PressureSegment,
    Segment,
)
from pam_ros.identification.data.thinning import HELD_STEP
from pam_ros.identification.fit.discrepancy import Discrepancy, Whitening
from pam_ros.identification.fit.of_rig import OfRig, fill, given_numbers
from pam_ros.identification.fit.places import effect_of
from pam_ros.identification.fit.slopes import Indices, Slopes
from pam_ros.identification.fit.unknowns import (
    OF_RUNS,
    CommandTime,
    Constant,
    MemoryStart,
    OfEffect,
    OnsetTime,
    RunLevel,
    RunNumber,
    RunStart,
    Unknown,
)
from pam_ros.rig import layout as at
from pam_ros.rig.bind import bind
from pam_ros.rig.changes import Change, run_over, run_pressures
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import Layout
from pam_ros.rig.start import behind_reservoir, fill_chambers, start_state

Array = NDArray[np.float64]
T = TypeVar('T')
DIFFERENCE = 1e-3  # step of u for a derivative; a thousandth of a parameter's typical size
# Residual of a simulation without a finite result, beyond that of any rig: in m, rad or N, or Pa.
DIVERGED, DIVERGED_PRESSURE = 1e6, 1e12


@dataclass(frozen=True, eq=False)
class Problem:
    """Runs to be explained by parameters, starts and memories, some of which are unknown.

    ``row`` holds the values that are not unknown, all rows of the kernel's q one after the other.
    ``active`` are the effects that the kernel computes, and ``step`` is the longest step in s.
    Numbers of a load can be unknown only if ``joint``, which has the load, is given. Unknowns need
    finite priors. Residuals are those of the samples that the segments mark for fitting, n in all,
    of the runs one after the other. on_run(steps) is called before each run with the number of its
    time steps, from any thread; an exception that it raises ends the fit.
    """

    segments: tuple[Segment, ...]
    layout: Layout
    active: tuple[type[Effect], ...]
    row: Array
    unknowns: tuple[Unknown, ...]
    step: float = 1e-3
    joint: Joint | None = None
    on_run: Callable[[float], object] = lambda steps: None

    @property
    def prior(self) -> Array:
        """Standard deviations of the priors of u (k,)."""
        return np.array([unknown.prior for unknown in self.unknowns])

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest u, (k,) each."""
        low, high = np.array([k.bounds for k in self.unknowns]).reshape(-1, 2).T
        return low, high

    def row_at(self, u: Array) -> Array:
        """Return the parameter row at the unknowns u."""
        q: Array = self.row.copy()
        for indices, unknown, k in self._in_row:
            q[indices] = unknown.value(u[k])
        numbers = self.numbers_at(u)
        if numbers:
            assert self.joint is not None
            fill(q.reshape(self.layout.rows, self.layout.parameters), self.joint, numbers)
        return q

    def _row_of_run(self, run: int, row: Array, u: Array) -> Array:
        """Return the parameter row of a run: *row*, or with the numbers that are its own."""
        own = dict(self._given[run])
        own |= {of.of: k.value(u[n]) for of, k, n in self._of(RunNumber) if run in of.runs}
        if not own:
            return row
        assert self.joint is not None
        q: Array = row.reshape(self.layout.rows, self.layout.parameters).copy()
        fill(q, self.joint, {**self.numbers_at(u), **own})
        return q.reshape(-1)

    def numbers_at(self, u: Array) -> dict[OfRig, float]:
        """Return the unknown numbers of load, transmission and mounting at the unknowns u."""
        return {of: unknown.value(u[k]) for of, unknown, k in self._of(OfRig)}

    def runs(self, u: Array, only: int | None = None) -> list[Array]:
        """Return the free run of every segment, or of segment *only*, at u.

        Each is (n, 2 + 2 muscles): position and velocity (m or rad), then for each muscle the
        chamber pressure in Pa and, in runs at a prescribed length, the force in N. In runs of the
        pressure path the joint does not move.
        """
        shape, shared = (self.layout.rows, self.layout.parameters), self.row_at(u)
        kernel, layout = bind(self.layout, self.active), self.layout
        found = []
        for k in range(len(self.segments)) if only is None else (only,):
            s = self.segments[k]
            self.on_run(self._steps[k])
            q = self._row_of_run(k, shared, u).reshape(shape)
            change = self._change(q, u)
            if isinstance(s, FreeSegment):
                changes = [] if change is None or change.time <= s.t[0] else [change]
                first = self._before(q) if changes else q
                x = self._start(k, first, u)
                given = s.drive_t, s.drive, self.step
                out = run_over(kernel, layout, x, s.t, first, changes, *given, forces=False)
            elif isinstance(s, PressureSegment):
                given = s.drive_t, s.drive, self.step
                out = run_pressures(kernel, layout, self._start(k, q, u), s.t, q, *given)
            elif isinstance(s, HeldSegment):
                x, xn = self._start(k, q, u), layout.scratch()
                out = np.empty((s.t.size, layout.run_columns))
                pressure = s.pressure[:, None]
                kernel.simulate_held(
                    x, xn, q, s.t, pressure, s.position, s.velocity, HELD_STEP, out
                )
            found.append(out)
        return found

    def _change(self, q: Array, u: Array) -> Change | None:
        """Return the change to the parameters q (rows, parameters) when unknown effects begin.

        None if they act from the start.
        """
        if not self._of(OnsetTime):
            return None
        _, unknown, n = self._of(OnsetTime)[0]
        time = unknown.value(u[n])
        rows = {(k // self.layout.parameters, e.name) for e, k in self._strengths}
        begun = [
            [effect for effect in self.layout.library if (row, effect.name) in rows]
            for row in range(self.layout.rows)
        ]
        return Change(time, q, begun)

    def _before(self, q: Array) -> Array:
        """Return the parameters q (rows, parameters) as they are before unknown effects begin."""
        before: Array = q.copy()
        before.flat[[k for _, k in self._strengths]] = 0.0
        return before

    def _start(self, run: int, q: Array, u: Array) -> Array:
        """Return the state at the start of a run."""
        s = self.segments[run]
        y0, v0 = s.y0, s.v0
        for of, unknown, k in self._of(RunStart):
            if of.run == run and of.is_velocity:
                v0 = unknown.value(u[k])
            elif of.run == run:
                y0 = unknown.value(u[k])
        pressures = s.first_pressures
        x = start_state(self.layout, q, pressures, y0, v0, self._present)
        memories = [one for one in self._of(MemoryStart) if one[0].run == run]
        if memories:
            for memory, unknown, k in memories:
                x[memory.row, memory.column] += unknown.value(u[k])
            fill_chambers(self.layout, q, x, pressures, self._present)
        return x

    def predict(self, u: Array, only: int | None = None) -> list[Array]:
        """Return the simulated target of every segment, or of segment *only*, at u.

        If commands acted earlier by d than their stamps, the motion did, too: s(t + d) = s + v d,
        and so did the pressure.
        """
        levels = {of.run: unknown.value(u[k]) for of, unknown, k in self._of(RunLevel)}
        early = sum(unknown.value(u[k]) for _, unknown, k in self._of(CommandTime))
        which = range(len(self.segments)) if only is None else (only,)
        found = []
        for run, out in zip(which, self.runs(u, only), strict=True):
            s = self.segments[run]
            simulated: Array = out[:, s.column] + levels.get(run, 0.0)
            if early and isinstance(s, CommandedSegment) and s.drive_spread:
                is_free = isinstance(s, FreeSegment)
                simulated += early * (out[:, at.RUN_V] if is_free else np.gradient(simulated, s.t))
            found.append(simulated)
        return found

    def residuals(self, u: Array) -> Array:
        """Return simulated - measured (n,).

        A simulation that diverges gives large finite residuals, so that a fit steps back.
        """
        left = [self._left(k, simulated) for k, simulated in enumerate(self.predict(u))]
        return left[0] if len(left) == 1 else np.concatenate(left)

    def _left(self, run: int, simulated: Array) -> Array:
        s = self.segments[run]
        e: Array = (simulated - s.target)[s.fit]
        most = DIVERGED_PRESSURE if s.quantity == 'pressure' else DIVERGED
        if np.max(np.abs(e), initial=0.0) <= most:  # false also for NaN
            return e
        return np.clip(np.nan_to_num(e, nan=most), -most, most)

    def jacobian(
        self, u: Array, r: Array, pool: Executor | None = None, only: Sequence[int] | None = None
    ) -> Array:
        """Return dr/du (n, columns) by differences, with one simulation per column.

        *r* are the residuals at u; *only* restricts the columns; *pool* computes them in parallel.
        The step is to a side that the bounds allow. The column of an unknown of one run needs only
        a simulation of this run. Two numbers of a rig may act exactly alike, which the error of a
        one-sided difference would hide: theirs are central where the bounds allow it.
        """
        columns = range(len(u)) if only is None else only
        starts = [0, *self._ends]

        def column(k: int) -> Array:
            unknown, run = self.unknowns[k], self._run_of[k]
            h = DIFFERENCE if u[k] + DIFFERENCE <= unknown.bounds[1] else -DIFFERENCE
            moved = u.copy()
            moved[k] += h
            if isinstance(unknown.of, OfRig):
                back = u.copy()
                back[k] = np.clip(u[k] - h, *unknown.bounds)
                change = self.residuals(moved) - self.residuals(back)
                central: Array = change / (moved[k] - back[k])
                return central
            if run is None:
                return (self.residuals(moved) - r) / h
            own = slice(starts[run], starts[run + 1])
            out = np.zeros_like(r)
            out[own] = (self._left(run, self.predict(moved, run)[0]) - r[own]) / h
            return out

        run: Callable[..., object] = map if pool is None else pool.map
        found = list(run(column, columns))  # type: ignore[call-overload]
        return np.stack(found, axis=1) if found else np.empty((r.size, 0))

    def slopes(self, jacobian: Array) -> Slopes:
        """Return dr/du (n, k) as one block for each run, of the unknowns that act in it."""
        return Slopes.of(self.by_run(jacobian), self._acting)

    @property
    def steps(self) -> float:
        """The number of time steps of one simulation of all runs."""
        return sum(self._steps)

    # Cached, since each of many simulations needs them -----------------------------------------

    @cached_property
    def _steps(self) -> list[float]:
        """The number of time steps of each run."""
        longest = [HELD_STEP if s.kind == 'held' else self.step for s in self.segments]
        pairs = zip(self.segments, longest, strict=True)
        return [max(s.t.size, float(s.t[-1] - s.t[0]) / step) for s, step in pairs]

    @cached_property
    def _given(self) -> list[dict[OfRig, float]]:
        """The numbers of the rig that are given for each run instead of the common ones."""
        return [
            given_numbers(self.joint, s.numbers) if self.joint and s.numbers else {}
            for s in self.segments
        ]

    @cached_property
    def _run_of(self) -> list[int | None]:
        """The run in which each unknown acts, None if it acts in all."""
        return [k.of.run if isinstance(k.of, OF_RUNS) else None for k in self.unknowns]

    @cached_property
    def _acting(self) -> list[Indices]:
        """The indices of the unknowns that act in each run."""
        return [
            np.array([k for k, own in enumerate(self._run_of) if own in (None, run)], dtype=int)
            for run in range(len(self.segments))
        ]

    def _of(self, kind: type[T]) -> list[tuple[T, Unknown, int]]:
        """Return what is unknown of one *kind*, each with its unknown and the index of its u."""
        found: list[tuple[T, Unknown, int]] = self._by_kind.get(kind, [])
        return found

    @cached_property
    def _by_kind(self) -> dict[type, list[Any]]:
        """What is unknown, by its type: see :meth:`_of`."""
        found: dict[type, list[Any]] = {}
        for k, unknown in enumerate(self.unknowns):
            found.setdefault(type(unknown.of), []).append((unknown.of, unknown, k))
        return found

    @cached_property
    def _in_row(self) -> list[tuple[list[int], Unknown, int]]:
        """The indices in the parameter row of each unknown that has some, see :meth:`_of`."""
        constants = [(list(of.indices), one, k) for of, one, k in self._of(Constant)]
        return constants + [(list(of.indices), one, k) for of, one, k in self._of(OfEffect)]

    @cached_property
    def _present(self) -> tuple[type[Effect], ...]:
        """The effects that may be present, in the order of the library."""
        free = {effect_of(k.of.place) for k in self.unknowns if isinstance(k.of, OfEffect)}
        index, muscles = self.layout.index, range(self.layout.muscles)

        def has_strength(effect: type[Effect]) -> bool:
            strengths = [k for k, p in enumerate(effect.parameters()) if p.strength]
            return any(self.row[index(effect, k, i)] != 0.0 for k in strengths for i in muscles)

        found = [e for e in self.layout.library if e.name in free or has_strength(e)]
        is_held = self.segments[0].kind == 'held'
        return tuple(behind_reservoir(found) if is_held else found)

    @cached_property
    def _strengths(self) -> list[tuple[type[Effect], int]]:
        """The effects of unknown strength, each with the index of one in the parameter row."""
        library = {effect.name: effect for effect in self.layout.library}
        unknown = [k.of for k in self.unknowns if isinstance(k.of, OfEffect)]
        found = [(library[effect_of(of.place)], of) for of in unknown]
        return [
            (effect, index)
            for effect, of in found
            if any(p.strength and p.name == of.parameter for p in effect.parameters())
            for index in of.indices
        ]

    # Weights of the residuals ------------------------------------------------------------------

    def stamps(self) -> list[Array]:
        """Return the stamps in s of the fitted samples of each run."""
        return [s.t[s.fit] for s in self.segments]

    @cached_property
    def _ends(self) -> NDArray[np.int_]:
        """The end index of the residuals of each run."""
        return np.cumsum([np.count_nonzero(s.fit) for s in self.segments])

    def by_run(self, values: Array) -> list[Array]:
        """Return *values* (n,) or (n, k) split into those of each run."""
        return np.split(values, self._ends[:-1])

    def whitenings(self, discrepancy: Discrepancy) -> list[Whitening]:
        """Return the map that whitens the residuals of each run."""
        return [discrepancy.whitening(t) for t in self.stamps()]

    def whitened(self, values: Array, whitenings: Sequence[Whitening]) -> Array:
        """Return residuals (n,), or the columns of a Jacobian (n, k), after these maps."""
        if len(whitenings) == 1:
            return whitenings[0](values)
        parts = zip(whitenings, self.by_run(values), strict=True)
        return np.concatenate([whitening(part) for whitening, part in parts])
