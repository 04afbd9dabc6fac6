# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The error of the nominal model, the effects that it lacks, and the error with these effects."""

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import fields, replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import instance, sequence
from pam_ros.errors import RecordingError
from pam_ros.identification.command_times import of_command_times
from pam_ros.identification.data.checked import checked
from pam_ros.identification.data.noise import Noise, noise_of, step_of
from pam_ros.identification.data.parts import Part, parts_of
from pam_ros.identification.data.segment import (
    PressureSegment,
    Segment,
    require_joint,
    require_one_kind,
    segments_of,
)
from pam_ros.identification.far_constants import of_constants
from pam_ros.identification.fit.solve import Solution
from pam_ros.identification.fit.uncertain import spread_unknowns
from pam_ros.identification.fit.undetermined import undetermined_after, undetermined_before
from pam_ros.identification.identification import Identification
from pam_ros.identification.outcome import Given, Outcome, search_recordings
from pam_ros.identification.result import Conclusion, Estimate, Finding, Stage, Verdict
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.final import FinalFits, fit_finally, forecast_of_final
from pam_ros.identification.search.levels import apart
from pam_ros.identification.search.onset import (
    OnsetEstimate,
    estimate_onset_after,
)
from pam_ros.identification.search.search import Search, alternatives
from pam_ros.identification.search.setting import Setting, transfer
from pam_ros.identification.search.stages import (
    at_place,
    development_of,
    onset_of,
    stages,
    visible_since,
)
from pam_ros.identification.search.table import candidates, is_instead_of_constants, reason_for
from pam_ros.identification.structure import Structure, structure_of
from pam_ros.identification.verdict import (
    next_experiment,
    of_absolute_pressures,
    of_problem,
    of_unused,
    sentence,
    verdict,
)
from pam_ros.identification.work import Progress, Stop, TimeLeft, Work
from pam_ros.identification.workers import Workers
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.inputs import driving, refuse_copies, refuse_idle
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.changes import refuse_onsets
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]


@contextmanager
def _quiet() -> Iterator[None]:
    """Ignore a warning of scipy before 1.12: SLSQP leaves its bounds by rounding, and clips.

    Filters of warnings hold for all threads: they are set before the fits, and not by each fit.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings('ignore', 'Values in x were outside bounds', RuntimeWarning)
        yield


@_quiet()
def identify(
    model: Joint,
    recordings: Recording | Sequence[Recording],
    test: Recording | Sequence[Recording] = (),
    progress: Progress | None = None,
    *,
    uncertain: Mapping[str, float | str] | None = None,
    warn: Callable[[str], object] | None = None,
    muscles: Mapping[str, Muscle] | None = None,
    time_left: TimeLeft | None = None,
    stop: Stop | None = None,
) -> Identification:
    """Identify the effects of the model's library that *recordings* show beyond *model*.

    *recordings* and *test* are recordings of the joint, one or several. Errors are evaluated on
    *test*. Without it, they are evaluated on the part of each recording that was not used before,
    see :mod:`pam_ros.identification.data.parts`. progress(share, text) is called with the share of
    the work that is done and a text about the next step, and time_left(low, high) before it with
    the s that the rest takes at least and at most, as soon as they are known. warn(text) is called
    with each warning that is known before the fits, which may take minutes. stop() is asked often
    and from several threads, from the time on when there is a re-tuned model: if it returns true,
    the search ends, and the result is that of its best model so far (``is_complete`` is false).

    *uncertain* are standard deviations of nominal values by the names of parameters, such as
    ``{'inertia': '50%', 'mass': 0.2}``, see :mod:`pam_ros.identification.fit.uncertain`. Numbers
    of load, transmission and mounting that are not in it keep their nominal values. *muscles* are
    other muscles by name, one of which may have been recorded instead of the nominal one: if the
    model follows the recordings only with one of them, the result names it.

    Raises RecordingError if there are no recordings, if two are the same, if they do not fit
    together, have no output, cannot be right (in another unit, for example) or are too short for
    any fit. Raises ParameterError for objects of another type, for a model with an onset and for
    an uncertain parameter that the model does not have.
    """
    uncertain = {} if uncertain is None else uncertain
    recordings, test = _checked(model, recordings, test, uncertain)
    work = Work(progress, time_left, stop)
    # With test recordings, no part of the others is needed to judge.
    shares = (CRITERIA.fit / CRITERIA.choose, 1.0) if test else (CRITERIA.fit, CRITERIA.choose)
    with Workers(work.update) as pool:
        setting_of = partial(_setting, shares, pool, uncertain, work)
        setting = setting_of(model, recordings)
        for text in undetermined_before(setting.problem, setting.noise, pool):
            if warn is not None:
                warn(text)
        given = Given(tuple(recordings), tuple(test), shares)
        last = forecast_of_final(setting)
        with work.part('', last):
            outcome = search_recordings(setting, given, setting_of, muscles or {})
        work.step('fitting the chosen models in full', last)
        ends = fit_finally(outcome.search)
        tests = segments_of(outcome.given.test)
        three = stages(ends, outcome.search, tests)
        decision = _decision(outcome, three)
        conclusion = _conclusion(decision, outcome, ends, three, tests)
    work.end()
    # Another statement about the same recordings may help more than another recording.
    following = outcome.remedy or next_experiment(conclusion, model)
    return Identification(
        **{field.name: getattr(conclusion, field.name) for field in fields(Conclusion)},
        sentence=sentence(conclusion, outcome.lacking, decision.explaining),
        next_experiment=following.text,
        next_command=following.command,
        warnings=(*outcome.clocks, *_warnings(outcome, conclusion, ends.augmented)),
    )


def _refuse_stated(recordings: Sequence[Recording], uncertain: Mapping[str, object]) -> None:
    """Raise RecordingError for an *uncertain* number of the rig that a recording states."""
    for recording in recordings:
        for name in recording.numbers:
            if name in uncertain:
                raise RecordingError(
                    f'recording {recording.name} states {name} = {recording.numbers[name]:g}, and '
                    f'{name} is uncertain: give one of the two'
                )


def _setting(
    shares: tuple[float, float],
    pool: Executor,
    uncertain: Mapping[str, float | str],
    work: Work,
    joint: Joint,
    recordings: Sequence[Recording],
) -> Setting:
    """Return the setting of a search in *recordings* of *joint*."""
    parts, muscles = _parts(recordings, shares), recordings[0].muscles
    return Setting(joint, parts, CRITERIA, BUDGET, pool, muscles, uncertain, work=work)


def _parts(recordings: Sequence[Recording], shares: tuple[float, float]) -> list[Part]:
    """Return the parts of the recordings; raises RecordingError if none can be fitted."""
    parts = parts_of(recordings, *shares)
    if not any(part.is_fitted for part in parts):
        raise RecordingError(
            f'recording {recordings[0].name} is too short for a fit: its stretches between gaps '
            'have too few samples'
        )
    return parts


def _warnings(outcome: Outcome, conclusion: Conclusion, augmented: Solution) -> tuple[str, ...]:
    """Return the warnings about all recordings and about the result."""
    recordings = (*outcome.given.recordings, *outcome.given.test)
    is_used = outcome.path is not None or outcome.note
    final = conclusion.stages[2].parameters
    return (
        *(text for recording in recordings for text in recording.warnings),
        *apart(augmented, conclusion.noise.sigma),
        *undetermined_after(augmented),
        *of_absolute_pressures(final, driving(recordings[0])[0].quantity, conclusion.quantity),
        *of_command_times(conclusion),
        *((outcome.note,) if outcome.note else ()),
        *of_unused(recordings, ('force',) if is_used else ('pressure', 'force')),
        *of_constants(augmented, conclusion),
        *of_problem('' if conclusion.doubt else conclusion.stages[2].problem),
    )


def _checked(
    model: Joint,
    recordings: Recording | Sequence[Recording],
    test: Recording | Sequence[Recording],
    uncertain: Mapping[str, float | str],
) -> tuple[list[Recording], list[Recording]]:
    """Return the recordings and the tests, checked alone, together and with *uncertain*."""
    refuse_onsets(instance('model', model, Joint, 'a Joint'), 'a nominal joint')
    fitted, tested = _sequence('recordings', recordings), _sequence('test', test)
    if not fitted:
        raise RecordingError('recordings is empty: give at least one Recording')
    require_one_kind([*fitted, *tested])
    require_joint([*fitted, *tested], model)
    found = [[checked(one, model) for one in given] for given in (fitted, tested)]
    refuse_copies([*found[0], *found[1]])
    spread_unknowns(model, fitted[0].muscles, uncertain)
    _refuse_stated([*fitted, *tested], uncertain)
    refuse_idle(found[0])
    segments_of(found[1])
    return found[0], found[1]


def _sequence(name: str, given: Recording | Sequence[Recording]) -> tuple[Recording, ...]:
    """Return one or several recordings as a tuple."""
    several = (given,) if isinstance(given, Recording) else given
    return sequence(name, several, Recording, 'a Recording')


class _Decision(NamedTuple):
    """The verdict, the time since which the effects act, and what explains the time before it.

    ``since`` is also the time from which the best model fails. ``explaining`` are the effects of
    that model, none for the re-tuned one.
    """

    verdict: Verdict
    since: OnsetEstimate | None
    explaining: tuple[str, ...]


def _decision(outcome: Outcome, three: Sequence[Stage]) -> _Decision:
    """Return the verdict of a search."""
    search, since = outcome.search, outcome.since
    if outcome.lacking:
        return _Decision(Verdict.INSUFFICIENT_DATA, None, ())
    name = verdict(search, *(stage.held_error for stage in three))
    is_open = name == Verdict.UNEXPLAINED_STRUCTURE
    if is_open and search.best.effects and search.setting.onset is None:
        # A model with effects explains more than the re-tuned one, which may fail earlier.
        after = estimate_onset_after(search.best)
        if after is not None:
            return _Decision(name, after, search.best.effects)
    return _Decision(name, since, ())


def _conclusion(
    decision: _Decision,
    outcome: Outcome,
    ends: FinalFits,
    three: tuple[Stage, Stage, Stage],
    tests: Sequence[Segment],
) -> Conclusion:
    """Return the numbers of an identification, with its verdict."""
    setting = outcome.search.setting
    noise = _least(three, ends.parts, setting.pool)
    is_found = decision.verdict == Verdict.EFFECT_FOUND
    development = development_of(three[2], ends.parts, setting) if is_found else None
    first = ends.parts[0].segment
    return Conclusion(
        verdict=decision.verdict,
        quantity=first.quantity,
        unit=first.unit,
        noise=noise,
        stages=three,
        effects=_findings(outcome, three[2]) if is_found else (),
        candidates=candidates(outcome.search),
        structure=_structure(ends, outcome.search, noise.sigma),
        segments=tuple(replace(part.segment, fit=part.known) for part in ends.parts),
        test=tuple(tests),
        recordings=outcome.given.recordings,
        test_recordings=outcome.given.test,
        since=_since(decision, setting, ends, development),
        transition=setting.transition,
        development=development,
        uncertain={name: str(given) for name, given in setting.uncertain.items()},
        doubt=outcome.doubt.reason if outcome.doubt else '',
        uses_pressures=outcome.path is not None,
        is_complete=outcome.is_complete,
    )


def _since(
    decision: _Decision, setting: Setting, ends: FinalFits, development: float | None
) -> Estimate | None:
    """Return the time in s from which the effects act, or the best model fails."""
    since, is_found = decision.since, decision.verdict == Verdict.EFFECT_FOUND
    if is_found and setting.transition is None:
        return None if setting.onset is None else onset_of(ends.augmented)
    if since is not None and (is_found or decision.verdict == Verdict.UNEXPLAINED_STRUCTURE):
        return visible_since(since, ends.retuned, setting, development)
    return None


def _least(three: Sequence[Stage], parts: Sequence[Part], pool: Executor) -> Noise:
    """Return the smallest noise estimate: of the signal, and of the residual of each model.

    If a model follows the motion, its residual is smoother than the raw signal, whose fast parts a
    polynomial cannot follow.
    """
    signals = [[(part.segment.t, part.segment.target) for part in parts]]
    for stage in three:
        pairs = zip(parts, stage.simulated, strict=True)
        signals.append([(part.segment.t, part.segment.target - run) for part, run in pairs])
    steps = [step_of(part.segment.target) for part in parts]
    found = pool.map(lambda pairs: noise_of(pairs, steps), signals)
    return min(found, key=lambda noise: noise.sigma)


def _structure(ends: FinalFits, search: Search, floor: float) -> Structure:
    """Return the structure of the residual of the last model in the longest run."""
    segments = [part.segment for part in ends.parts]
    longest = max(range(len(segments)), key=lambda k: segments[k].t.size)
    known: Solution = ends.augmented
    problem, u = transfer(known, segments, search.setting.left_out)
    out = problem.runs(u, longest)[0]
    s = segments[longest]
    run = problem.predict(u, longest)[0]
    position, velocity = out[:, at.RUN_S], out[:, at.RUN_V]
    if isinstance(s, PressureSegment):
        position, velocity = s.commands(s.t)[:, s.muscle], np.gradient(run, s.t)
    inputs = (*out[:, at.RUN_P :: 2].T, position, velocity)
    return structure_of(s.t, s.target - run, inputs, floor)


def _findings(outcome: Outcome, last: Stage) -> tuple[Finding, ...]:
    """Return what is known of each effect; of those that only pressures show, from these."""
    search = outcome.search
    found = []
    for name in search.best.effects:
        parameters = at_place(last.parameters, search.setting.places[name])
        if outcome.path is not None and name in search.kept:
            others, reason = alternatives(outcome.path, name), reason_for(outcome.path, name)
            found.append(Finding(name, parameters, others, f'in the measured pressures {reason}'))
            continue
        others, reason = alternatives(search, name), reason_for(search, name)
        instead = is_instead_of_constants(search, name)
        found.append(Finding(name, parameters, others, reason, instead))
    return tuple(found)
