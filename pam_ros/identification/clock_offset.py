# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Outputs that precede the input that causes them: two clocks, which no effect explains.

No rig moves before its command. If a model whose input acts earlier than it was stamped explains
what the effects of the library alone do not, the stamps are of two clocks. A motion that is later
than its input is never taken for that: a dead time explains it.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.parts import like, parts_of
from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.data.thinning import thinned
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.solve import Solution, converge, initial_solution
from pam_ros.identification.fit.time_offset import OffsetFit, fit_offsets, profile_offsets
from pam_ros.identification.search.search import Search
from pam_ros.identification.search.setting import Model, Setting, rms
from pam_ros.identification.verdict import explains
from pam_ros.identification.wording import interval, number
from pam_ros.recording.input_offset import has_measured_input, with_earlier_input
from pam_ros.recording.recording import Recording

Array = NDArray[np.float64]
ROUNDS = 3  # searches with an offset, each from that of the model which the last one has found
SPREADS = 3.0  # standard deviations of the times of receipt by which an input may seem early
RESOLVED = 0.25  # share of the period of a search, below which an offset is not resolved
WIDE = 1.96  # standard deviations of a 95 % interval


class Attempt(Protocol):
    """A search of recordings, with what else its caller needs of it."""

    @property
    def search(self) -> Search:
        """The search."""


T = TypeVar('T', bound=Attempt)


def on_one_clock(
    first: T,
    recordings: Sequence[Recording],
    shares: tuple[float, float],
    begin: Callable[[Sequence[Recording]], T],
) -> tuple[T, list[Recording], list[str]]:
    """Return the search of *recordings* whose input and outputs are on one clock, and them.

    *first* is the search of the recordings as they are, which are divided by *shares*. If their
    outputs precede the input, and only this explains the data, *begin* searches recordings with
    corrected times of the input, and the last value has a sentence on each, with the size of the
    offset. Otherwise nothing is changed.
    """
    unchanged: tuple[T, list[Recording], list[str]] = (first, [*recordings], [])
    clocks = _Clocks(first.search, recordings, shares)
    fit = clocks.suspected(first.search)
    if fit is None:
        return unchanged
    for _ in range(ROUNDS):
        found = begin(clocks.corrected(fit))
        if found.search.setting.onset is not None:
            return unchanged
        moved, fit = fit.offsets, clocks.fit(found.search.best, fit.offsets)
        if fit is None or not clocks.are_better(fit, first.search):
            return unchanged
        if np.all(np.abs(moved - fit.offsets) <= fit.deviations):
            break
    if not clocks.is_sure(found.search, first.search, fit):
        return unchanged
    return found, clocks.corrected(fit), clocks.sentences(fit)


def tests_on_one_clock(
    search: Search, tests: Sequence[Recording]
) -> tuple[list[Recording], list[str]]:
    """Return *tests* whose input and outputs are on one clock, and a sentence on each correction.

    The best model of *search* is not fitted to them. A test is corrected if the offset of its
    input explains what this model does not.
    """
    setting, known = search.setting, search.best.solution
    corrected, sentences = [], []
    for test in tests:
        offset, deviation = _offset_with(known, test, setting)
        corrected.append(_corrected(test, offset, deviation) if offset else test)
        sentences += [_sentence(test, offset, deviation)] if offset else []
    return corrected, sentences


def _offset_with(known: Solution, recording: Recording, setting: Setting) -> tuple[float, float]:
    """Return the offset of a *recording* that is not fitted and its deviation in s, 0 if none.

    The model is that of the solution *known*, without a further fit.
    """
    nothing = np.zeros(0)

    def problem_at(offsets: Array) -> tuple[Problem, list[int]]:
        moved = with_earlier_input(recording, float(offsets[0]))
        segments = tuple(thinned(s, setting.period) for s in segments_of([moved]))
        row = known.problem.row_at(known.u)
        problem = replace(known.problem, row=row, unknowns=(), segments=segments)
        return problem, len(segments) * [0]

    problem, owners = problem_at(np.zeros(1))
    before = initial_solution(problem, nothing)
    offsets, _ = profile_offsets(before, owners, 1)
    fit = fit_offsets(problem_at, nothing, np.maximum(offsets, 0.0), setting.pool)
    offset, deviation = float(fit.offsets[0]), float(fit.deviations[0])
    left = setting.above(rms(fit.solution.r))
    is_explained = left <= setting.criteria.left * setting.above(rms(before.r))
    if is_explained and offset - WIDE * deviation > _least_offset(recording, setting):
        return offset, deviation
    return 0.0, 0.0


class _Clocks:
    """The recordings of a search, and the time by which the input of each is early."""

    def __init__(
        self, search: Search, recordings: Sequence[Recording], shares: tuple[float, float]
    ) -> None:
        self._recordings = recordings
        self._setting = replace(search.setting, parts=parts_of(recordings, *shares), onset=None)
        self._least = np.array([_least_offset(one, search.setting) for one in recordings])

    def suspected(self, search: Search) -> OffsetFit | None:
        """Return the best fit in which an offset lowers the score of the same model, or None."""
        setting, pool = self._setting, self._setting.pool
        problem = setting.problem
        nominal = initial_solution(problem, np.zeros(len(problem.unknowns)), pool=pool)
        if search.setting.onset is None:
            models = list(dict.fromkeys((search.retuned, search.best)))
        else:
            # The models of this search are those of a part of the recordings.
            models = [setting.model((), converge(nominal, pool=pool))]
        starts = [(models[0], nominal), *((model, model.solution) for model in models)]
        fits = [
            fit
            for model, start in starts
            for offsets in (self._profile(start),)
            if (offsets > 0.0).any()
            for fit in (self.fit(model, offsets, start.u),)
            if fit is not None and self._are_early(fit).any()
            if fit.fall_from(model.score, model.solution.r.size) > setting.criteria.margin
        ]
        return min(fits, key=lambda fit: fit.score / fit.solution.r.size, default=None)

    def _profile(self, start: Solution) -> Array:
        """Return the offsets in s from which a fit may begin; 0 where the input is not early."""
        problem, owners = self._problem(start.problem, np.zeros(len(self._recordings)))
        offsets, falls = profile_offsets(
            replace(start, problem=problem), owners, len(self._recordings)
        )
        is_early = (offsets > 0.0) & (falls > self._setting.criteria.margin)
        return np.where(is_early, offsets, 0.0)

    def fit(self, model: Model, offsets: Array, u: Array | None = None) -> OffsetFit | None:
        """Return the fit of *model* with offsets in s, from *offsets* and u on."""
        known = model.solution
        if len(self._problem(known.problem, offsets)[0].segments) != len(known.problem.segments):
            return None
        return fit_offsets(
            lambda at: self._problem(known.problem, at),
            known.u if u is None else u,
            offsets,
            self._setting.pool,
        )

    def _problem(self, problem: Problem, offsets: Array) -> tuple[Problem, list[int]]:
        """Return *problem* with inputs earlier by *offsets*, and the recording of each run."""
        pairs = zip(self._recordings, offsets.tolist(), strict=True)
        shifted = [with_earlier_input(one, offset) for one, offset in pairs]
        parts = like(self._setting.parts, shifted)
        segments = replace(self._setting, parts=parts).problem.segments
        return replace(problem, segments=segments), [s.recording for s in segments]

    def _are_early(self, fit: OffsetFit) -> NDArray[np.bool_]:
        """Return for each recording whether its input is earlier than its stamps can explain."""
        low = fit.offsets - WIDE * fit.deviations
        return np.asarray(low > self._least)

    def is_sure(self, search: Search, before: Search, fit: OffsetFit) -> bool:
        """Return whether the models of *search*, with the offsets of *fit*, are better.

        Their score is lower than that of any model *before*, whose inputs are as stamped. They
        explain the data, or most of the error that the best model before has left.
        """
        setting = self._setting
        was, now = before.best.errors, search.best.errors
        most = setting.criteria.left
        is_most = all(
            setting.above(b) <= most * setting.above(a)
            for a, b in ((was.fit, now.fit), (was.choose, now.choose))
        )
        return self.are_better(fit, before) and (is_most or explains(search))

    def are_better(self, fit: OffsetFit, before: Search) -> bool:
        """Return whether inputs of *fit* are early, and its score is lower than *before*."""
        best = before.best
        fall = fit.fall_from(best.score, best.solution.r.size)
        return bool(self._are_early(fit).any()) and fall > self._setting.criteria.margin

    def corrected(self, fit: OffsetFit) -> list[Recording]:
        """Return the recordings with the offsets of *fit*, where they are early."""
        offsets = self._corrections(fit)
        return [
            _corrected(one, *offsets[k]) if k in offsets else one
            for k, one in enumerate(self._recordings)
        ]

    def sentences(self, fit: OffsetFit) -> list[str]:
        """Return a sentence on each recording whose input is early."""
        corrections = self._corrections(fit).items()
        return [_sentence(self._recordings[k], *found) for k, found in corrections]

    def _corrections(self, fit: OffsetFit) -> dict[int, tuple[float, float]]:
        """Return the offset and its deviation in s of each recording whose input is early.

        Recordings that decide between models are not fitted: their offsets are those with which
        the model of the fit explains them.
        """
        early = self._are_early(fit)
        found = {
            k: (float(fit.offsets[k]), float(fit.deviations[k]))
            for k in np.flatnonzero(early).tolist()
        }
        fitted = {s.recording for s in fit.solution.problem.segments}
        for k in {*range(len(self._recordings))} - fitted:
            offset = _offset_with(fit.solution, self._recordings[k], self._setting)
            if offset[0]:
                found[k] = offset
        return dict(sorted(found.items()))


def _least_offset(recording: Recording, setting: Setting) -> float:
    """Return the offset in s up to which the stamps of a recording may be of one clock."""
    return max(SPREADS * recording.command_spread, RESOLVED * setting.period)


def _corrected(recording: Recording, offset: float, deviation: float) -> Recording:
    """Return *recording* with an input that is earlier by *offset* s."""
    spread = float(np.hypot(recording.command_spread, deviation))
    return replace(with_earlier_input(recording, offset), command_spread=spread)


def _sentence(recording: Recording, offset: float, deviation: float) -> str:
    """Return a sentence on the offset in s of a recording."""
    what = 'measured pressures' if has_measured_input(recording) else 'commands'
    low, high = offset - WIDE * deviation, offset + WIDE * deviation
    size, limits = number(1e3 * offset), interval(1e3 * low, 1e3 * high)
    return (
        f'{recording.name}: the outputs precede the {what} that cause them by {size} ms ({limits} '
        'ms), which no rig can do: two clocks have stamped them, or their times were shifted. '
        f'Here the {what} act earlier by this time. A dead time of the rig would make the offset '
        'appear smaller, and cannot be seen'
    )
