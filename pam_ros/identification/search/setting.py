# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The setting of a search, and the models that it evaluates, with their errors.

Models are compared by their score, with the discrepancy. Their errors are evaluated where the free
run is nearest to the measurement, by least squares from the result of the fit. With a discrepancy
slow errors cost little, and the free run of a model that lacks an effect drifts: the constants of
the best score can be far from those of the nearest free run.
"""

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from math import ceil

import numpy as np
from numpy.typing import NDArray

from pam_ros.cached_property import cached_property
from pam_ros.identification.data.noise import noise_of
from pam_ros.identification.data.parts import Part
from pam_ros.identification.data.rests import without_rests
from pam_ros.identification.data.segment import Segment, windows
from pam_ros.identification.data.thinning import (
    LONGEST_PERIOD,
    PERIODS,
    coarse_period,
    longest_step,
    thinned,
)
from pam_ros.identification.fit.discrepancy import WHITE
from pam_ros.identification.fit.of_rig import joint_with
from pam_ros.identification.fit.places import Place, muscle_of, places_of
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.run_levels import level_unknowns
from pam_ros.identification.fit.solve import Solution, levenberg_marquardt, with_nominal_constants
from pam_ros.identification.fit.uncertain import Spreads, spread_unknowns
from pam_ros.identification.fit.unknowns import (
    OF_RETUNING,
    OF_RUNS,
    MemoryStart,
    onset_unknown,
    proper,
    run_unknowns,
    time_unknowns,
)
from pam_ros.identification.search.criteria import Budget, Criteria
from pam_ros.identification.work import Work
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
MANY = 3.0  # times as many samples as a search needs, from which on rests are shortened


@dataclass(frozen=True)
class Errors:
    """RMSE in m, rad, N or Pa over the part that was fitted, and over the part for choices.

    ``free_run`` is that of the free run over *choose*. The others are those of the same run,
    except for a load without a spring, for which they are those of short runs. At prescribed
    lengths, and if only pressures were recorded, the parts are interleaved, so that initial
    memories that suit the fit suit *choose*, too. Therefore the run for *choose* begins there with
    memories at rest, as in another recording.
    """

    fit: float
    choose: float
    free_run: float


@dataclass(frozen=True, eq=False)
class Model:
    """A fitted model: its effects, and the result of the fit.

    Its errors are computed on demand, since most models are rejected by their scores alone.
    ``without`` stores the models without one of its effects, which several moves need.
    """

    effects: tuple[str, ...]  # names of their places
    solution: Solution
    setting: 'Setting'
    is_screened: bool
    without: dict[str, 'Model'] = field(default_factory=dict, repr=False)

    @property
    def score(self) -> float:
        """-2 ln(evidence) without a constant of the data: the lower, the better."""
        return self.solution.score

    @cached_property
    def nearest(self) -> Solution:
        """The solution whose free run is nearest to the measurement.

        It results from least squares that begin at the result of the fit. If the fit has moved
        the constants further than specimens differ, least squares also begin with nominal ones,
        and the nearer result is used. For a cheap fit a few cheap steps are made.
        """
        setting, plain = self.setting, replace(self.solution, discrepancy=WHITE)
        if self.is_screened:
            return levenberg_marquardt(plain, setting.budget.screening, renew=False)
        near = levenberg_marquardt(plain, setting.budget.nearer)
        if self.strain <= setting.criteria.strain:
            return near
        again = (
            levenberg_marquardt(one, setting.budget.nearer)
            for one in with_nominal_constants(plain)
        )
        return min((near, *again), key=lambda one: one.cost)

    @cached_property
    def errors(self) -> Errors:
        """The errors of the nearest free run."""
        return self.setting.errors(self.nearest)

    @property
    def strain(self) -> float:
        """Prior chi-square of the nominal constants, a measure of how far re-tuning moved them."""
        solution = self.solution
        pairs = zip(solution.problem.unknowns, solution.z, strict=True)
        return float(sum(z * z for unknown, z in pairs if isinstance(unknown.of, OF_RETUNING)))


@dataclass(frozen=True, eq=False)
class Setting:
    """The nominal model, the parts of the recordings, the criteria and the limits of computing.

    ``work`` counts the simulations.
    """

    joint: Joint
    parts: Sequence[Part]
    criteria: Criteria
    budget: Budget
    pool: Executor
    muscles: tuple[str, ...] = ()  # names of the muscles of a joint that has several
    uncertain: Spreads = field(default_factory=dict)  # standard deviations of nominal values
    onset: float | None = None  # s, near which effects begin; None: at the start
    transition: tuple[float, float] | None = None  # s, left out, in which they develop
    is_behind_chambers: bool = False  # whether the input are chamber pressures, commands known
    work: Work = field(default_factory=Work)

    @cached_property
    def noise(self) -> float:
        """Standard deviation in m, rad or N of the noise, estimated without any model."""
        known = [stretch for part in self.parts for stretch in part.known_stretches]
        return noise_of([(s.t, s.target) for s in known]).sigma

    @cached_property
    def period(self) -> float:
        """Sampling period in s to which runs are thinned.

        If there are more samples than a search needs, it is a multiple of the usual period, as far
        as the rig's own frequency allows.
        """
        usual, longest = self.coarse_period(), self.coarse_period(LONGEST_PERIOD)
        times = ceil(self._size(self._brief, usual) / self.budget.samples)
        return max(usual, min(times * usual, longest))

    @property
    def is_of_pressures(self) -> bool:
        """Whether only pressures were recorded, which do not depend on muscles and load."""
        return self.parts[0].segment.quantity == 'pressure'

    def coarse_period(self, longest: float = PERIODS[1]) -> float:
        """Return the period in s that the fastest oscillation in any recording allows.

        A pressure path does not oscillate: its samples are thinned only as far as necessary.
        """
        if self.is_of_pressures:
            return PERIODS[1] if longest > PERIODS[1] else PERIODS[0]
        numbers = {tuple(sorted(part.segment.numbers.items())) for part in self.parts}
        joints = [joint_with(self.joint, dict(own)) for own in numbers]
        return min(coarse_period(joint, longest) for joint in joints)

    @property
    def step(self) -> float:
        """Longest step in s of simulations of thinned runs."""
        return longest_step(self.period)

    @property
    def is_crossed(self) -> bool:
        """Whether choices use only recordings that are not fitted, as in a cross-validation."""
        fitted = {part.segment.recording for part in self.parts if part.fit.any()}
        chosen = (part.segment.recording for part in self.parts if part.choose.any())
        return fitted.isdisjoint(chosen)

    @property
    def choices_interpolate(self) -> bool:
        """Whether a free run is compared with *choose* only between times that are fitted.

        Then only what judges shows how the run continues. False if other recordings judge.
        """
        is_in_turn = all(part.division.is_in_turn for part in self.parts)
        is_free = self.parts[0].segment.kind == 'free'
        return is_free and is_in_turn and any(part.judge.any() for part in self.parts)

    @cached_property
    def thin(self) -> list[Part]:
        """The parts that are searched, thinned."""
        return [replace(p, segment=thinned(p.segment, self.period)) for p in self.searched]

    @cached_property
    def searched(self) -> Sequence[Part]:
        """The parts that a search uses: all, or as many as the budget allows.

        If there are too many samples, fitted recordings are used from the shortest on: each is
        another experiment, and a longer one contains little more information on the effects. The
        last fits use all. Parts that are not fitted cost little.
        """
        fitted = [part for part in self._brief if part.is_fitted]
        fitted.sort(key=lambda part: self._size([part], self.period))
        sizes = np.cumsum([self._size([part], self.period) for part in fitted])
        room = max(1, int(np.count_nonzero(sizes <= self.budget.most)))
        left_out = fitted[room:]
        return [part for part in self._brief if part not in left_out]

    @cached_property
    def _brief(self) -> Sequence[Part]:
        """The parts, without the middle of the rests if there are far too many samples."""
        # An onset is a time on the clock of the recording, which must not change.
        size = self._size(self.parts, self.coarse_period())
        if size <= MANY * self.budget.samples or self.onset is not None:
            return self.parts
        return [without_rests(part, self.noise) for part in self.parts]

    def _size(self, parts: Sequence[Part], period: float) -> int:
        """Return how many samples of *parts* are fitted, thinned to *period* s."""
        return sum(thinned(p.segment, period).t.size for p in parts if p.is_fitted)

    @cached_property
    def problem(self) -> Problem:
        """The problem of re-tuning the nominal model to the samples that may be fitted."""
        runs: list[Segment] = [
            thin.to_fit
            for part, thin in zip(self.searched, self.thin, strict=True)
            if part.is_fitted
        ]
        return self.problem_of(runs, self.step)

    @property
    def drifts(self) -> bool:
        """Whether a load without a spring moves freely: then its runs are cut into short ones."""
        return self.joint.is_driven and self.parts[0].segment.kind == 'free'

    def problem_of(self, runs: Sequence[Segment], step: float) -> Problem:
        """Return the problem of re-tuning the nominal model to *runs*, with steps of *step* s.

        The runs of a load without a spring are cut into short ones.
        """
        if self.drifts:
            runs = [w for run in runs for w in windows(run, self.budget.window)]
        sigma = np.inf if self.drifts else self.noise
        levels = level_unknowns(runs, self.joint)
        starts = [*time_unknowns(runs), *run_unknowns(runs, sigma)]
        if self.onset is not None:
            starts.append(onset_unknown(runs, self.onset, self.transition is None))
        retuned = spread_unknowns(self.joint, self.muscles, self.uncertain)
        unknowns = [*([] if self.is_of_pressures else retuned), *starts, *levels]
        return Problem(
            tuple(runs),
            self.joint.layout,
            self.joint.active,
            self.joint.parameters().ravel(),
            tuple(map(proper, unknowns)),
            step,
            self.joint,
            self.work.simulated,
        )

    @property
    def left_out(self) -> tuple[type, ...]:
        """The types of unknowns of the fitted runs that do not apply to whole parts.

        The runs of a load without a spring are short ones, which have other starts.
        """
        return OF_RUNS if self.drifts else ()

    @cached_property
    def windows(self) -> list[Part]:
        """Short runs over all parts, of a load without a spring."""
        length = self.budget.window
        return [
            replace(part, segment=w) for part in self.thin for w in windows(part.segment, length)
        ]

    def model(
        self, effects: tuple[str, ...], solution: Solution, is_screened: bool = False
    ) -> Model:
        """Return the model of a solution; *is_screened* is true for a cheap fit."""
        return Model(effects, solution, self, is_screened)

    def errors(self, solution: Solution) -> Errors:
        """Return the errors of a solution without a further fit."""
        known = [part for part in self.thin if part.known.any()]
        whole = [part.segment for part in known]
        if self.drifts:
            short = [part.segment for part in self.windows]
            fit, choose = _rms_of(self.windows, simulate_on(solution, short, without=OF_RUNS))
            _, far = _rms_of(known, simulate_on(solution, whole, without=OF_RUNS))
            return Errors(fit, choose, far)
        fit, choose = _rms_of(known, simulate_on(solution, whole))
        if known[0].segment.kind != 'free':
            _, choose = _rms_of(known, simulate_on(solution, whole, without=(MemoryStart,)))
        return Errors(fit, choose, choose)

    @cached_property
    def places(self) -> dict[str, Place]:
        """Every place at which an effect of the library can act, by its name.

        If only pressures were recorded, these are the effects in the pressure path; behind the
        chambers, those that also act elsewhere.
        """
        every = places_of(self.joint, self.muscles)
        if self.is_of_pressures:
            return {name: one for name, one in every.items() if one.effect.acts_on_pressure()}
        if self.is_behind_chambers:
            return {name: one for name, one in every.items() if not one.effect.is_of_path()}
        return every

    def related(self, name: str, effects: Iterable[str]) -> list[str]:
        """Return the places of *effects* that belong to the place called *name*.

        They are in the same muscle if that place is in one, else in all muscles; or on the joint.
        """
        muscle = muscle_of(name)
        pairs = ((f'{muscle}.{effect}' if muscle else effect, effect) for effect in effects)
        return [same if same in self.places else other for same, other in pairs]

    def above(self, error: float) -> float:
        """Return the part of an error that is above the noise, in its unit."""
        return float(np.sqrt(max(error**2 - self.noise**2, 0.0)))


def simulate_on(
    solution: Solution, segments: Sequence[Segment], without: tuple[type, ...] = ()
) -> list[Array]:
    """Return a simulation of other segments by the model of *solution*, see :func:`transfer`."""
    problem, u = transfer(solution, segments, without)
    return problem.predict(u)


def transfer(
    solution: Solution, segments: Sequence[Segment], without: tuple[type, ...] = ()
) -> tuple[Problem, Array]:
    """Return the model of *solution* over other segments, and its unknowns.

    They begin like the fitted runs, which they continue. Unknowns of the types *without* are as in
    any recording: positions and velocities as measured, memories at rest, levels 0.
    """
    problem = solution.problem
    keep = [k for k, unknown in enumerate(problem.unknowns) if not isinstance(unknown.of, without)]
    unknowns = tuple(problem.unknowns[k] for k in keep)
    return replace(problem, segments=tuple(segments), unknowns=unknowns), solution.u[keep]


def _rms_of(parts: Sequence[Part], runs: Sequence[Array]) -> tuple[float, float]:
    """Return the RMSE over the fitted samples and over those for choices."""
    left = [run - part.segment.target for part, run in zip(parts, runs, strict=True)]
    fit = np.concatenate([e[part.fit] for part, e in zip(parts, left, strict=True)])
    choose = np.concatenate([e[part.choose] for part, e in zip(parts, left, strict=True)])
    return rms(fit), rms(choose)


def rms(e: Array) -> float:
    """Return the root of the mean square of e (n,), NaN if there is none."""
    return float(np.sqrt(np.mean(e**2))) if e.size else float('nan')
