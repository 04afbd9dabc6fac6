# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Scores of a controller in a trial. Lower is better for all of them.

A new score is one function with one registration, :func:`score`. It returns None where it has no
meaning in the trial.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import detrend

from pam_ros.bench.forces import responses
from pam_ros.bench.outcome import ScoreAbout
from pam_ros.bench.trial import Trial
from pam_ros.bench.windows import (
    NEAR,
    Part,
    changes,
    commands,
    jumps,
    motion,
    periods,
    rest,
)

Compute = Callable[[Trial], float | None]

SETTLED = 0.02  # of the jump
BAND = 1e-4, 1e-3  # smallest band of a recovery: m, and rad
BAND_RATIO = 5.0  # band of a recovery to the RMS error before
LIMIT_ROUNDING = 0.1  # Pa: 600 kPa in single precision
KILO = 1e-3  # kPa in a Pa
MILLI = 1e3  # ms in a s
MICRO = 1e6  # um in a m
LOAD = 'It depends on the machine and on what else runs on it.'


@dataclass(frozen=True)
class Score(ScoreAbout):
    """A score, with the function that computes it.

    Scores that do not depend on the machine are equal to the bit for equal trials.
    """

    compute: Compute


SCORES: list[Score] = []


def score(
    name: str, *, unit: str, text: str, source: str = '', is_of_machine: bool = False
) -> Callable[[Compute], Compute]:
    """Register the decorated function as the score *name*; the arguments are those of Score.

    Raises ValueError if there is a score of this name.
    """
    if any(known.name == name for known in SCORES):
        raise ValueError(f'there is a score {name} already')

    def register(function: Compute) -> Compute:
        SCORES.append(Score(name, unit, text, source, is_of_machine, function))
        return function

    return register


def scores_of(trial: Trial) -> dict[str, float | None]:
    """Return the value of each score by its name, in the order of SCORES.

    A value is None if the score has no meaning in this trial, such as an overshoot without a jump,
    or if it is not finite, as for a position that is not. A trial of less than two samples has no
    scores.
    """
    if trial.t.size < 2:
        return {one.name: None for one in SCORES}
    with np.errstate(all='ignore'):  # numbers that are too large become infinite, and then None
        values = {one.name: one.compute(trial) for one in SCORES}
    return {
        name: value + 0.0 if value is not None and np.isfinite(value) else None  # not -0.0
        for name, value in values.items()
    }


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _settling(trial: Trial, part: Part, band: float) -> float:
    """Return the time in s after which |error| stays within *band*, at most that to the end."""
    outside = np.flatnonzero(~(np.abs(trial.error[part.samples]) <= band))
    if not outside.size:
        return 0.0
    inside = min(part.begin + int(outside[-1]) + 1, trial.t.size - 1)
    return max(float(trial.t[inside] - part.time), 0.0)


# Errors ------------------------------------------------------------------------------------------


@score(
    'error_at_rest',
    unit='position',
    text='Largest absolute error in the last 2 s. It needs a reference that is constant and a rig '
    'that does not change and has no outage in the last 4 s.',
)
def _error_at_rest(trial: Trial) -> float | None:
    part = rest(trial)
    return None if part is None else float(np.max(np.abs(trial.error[part])))


@score(
    'rms_error',
    unit='position',
    text='Root of the mean square of the error, from the first motion of the reference or the '
    'first change or outage of the rig on, whichever is earlier; from 1 s after the start if '
    'there is none. The time of outages does not count, the time from the return on does.',
)
def _rms_error(trial: Trial) -> float | None:
    part = motion(trial)
    return None if part is None else _rms(trial.error[part])


@score(
    'worst_error',
    unit='position',
    text='Largest absolute error in the time of rms_error. After a jump of the reference this is '
    'usually the jump itself.',
)
def _worst_error(trial: Trial) -> float | None:
    part = motion(trial)
    return None if part is None else float(np.max(np.abs(trial.error[part])))


# Responses ---------------------------------------------------------------------------------------


@score(
    'settling_time',
    unit='s',
    text='Time after a jump of the reference after which the absolute error stays within 2 % of '
    'the jump until the next jump, the next change or outage of the rig or the end; the longest '
    'of all jumps. If it never stays there, it is the whole time until then. It needs a reference '
    'that is constant but for jumps. Jumps during an outage do not count.',
    source='Ogata, Modern Control Engineering, 5th edition, 2010, section 5-3',
)
def _settling_time(trial: Trial) -> float | None:
    times = [_settling(trial, part, SETTLED * abs(part.jump)) for part in jumps(trial)]
    return max(times, default=None)


@score(
    'overshoot',
    unit='percent',
    text='How far the position goes beyond the new reference, in the direction of the jump and '
    'in percent of the jump, until the next jump, the next change or outage of the rig or the '
    'end; the largest of all jumps, 0 if it does not go beyond. It needs a reference that is '
    'constant but for jumps. Jumps during an outage do not count.',
    source='Ogata, Modern Control Engineering, 5th edition, 2010, section 5-3',
)
def _overshoot(trial: Trial) -> float | None:
    beyond = [np.max(-trial.error[part.samples] / part.jump) for part in jumps(trial)]
    return 100.0 * float(np.max(beyond, initial=0.0)) if beyond else None


@score(
    'recovery',
    unit='s',
    text='Time after a change of the rig, or after its return from an outage, after which the '
    'absolute error stays within a band until the next change or outage, the next motion of the '
    'reference or the end; the longest of all. The band is 5 times the root mean square error of '
    'the last second before the change or the outage, and at least 0.1 mm or 1 mrad. If the error '
    'never stays there, it is the whole time until then. Changes and outages within 1 s of a '
    'motion of the reference do not count.',
)
def _recovery(trial: Trial) -> float | None:
    times = []
    for part in changes(trial):
        before = trial.error[max(part.before - periods(trial, NEAR), 0) : part.before]
        usual = BAND_RATIO * _rms(before) if before.size else 0.0
        times.append(_settling(trial, part, max(BAND[trial.is_revolute], usual)))
    return max(times, default=None)


@score(
    'compliance',
    unit='um/N',
    text='Motion per force under a sinusoidal force on the load, at its frequency; the largest of '
    'all frequencies. It is the amplitude of a sinusoid, fitted to whole periods in the second '
    'half of the time in which the force is the same. It needs a periodic_disturbance for at '
    'least 6 periods, and a joint that does not turn.',
)
def _compliance(trial: Trial) -> float | None:
    found = [] if trial.is_revolute else responses(trial)
    return MICRO * max((one.compliance for one in found), default=np.nan)


@score(
    'force_response',
    unit='percent',
    text='The motion of compliance in percent of that of the same rig at constant pressures; the '
    'largest of all frequencies.',
)
def _force_response(trial: Trial) -> float | None:
    return 100.0 * max((one.compliance / one.alone for one in responses(trial)), default=np.nan)


# Pressures ---------------------------------------------------------------------------------------


@score(
    'pressure_variation',
    unit='kPa/s',
    text='Sum of the absolute changes of the commanded pressure from period to period, divided by '
    'the time, mean of the muscles, in the time of rms_error; the changes at its start and from '
    'the last command before an outage to the first one after it count. A command that is not '
    'finite counts as the one before it.',
    source='Total variation of the input: Skogestad, Journal of Process Control 13, 2003, 291-309',
)
def _pressure_variation(trial: Trial) -> float | None:
    sent = commands(trial)
    if sent is None:
        return None
    pressure, duration = sent
    return KILO * float(np.mean(np.sum(np.abs(np.diff(pressure, axis=0)), axis=0))) / duration


@score(
    'chatter',
    unit='kPa',
    text='Difference of the highest and the lowest commanded pressure in the last 2 s, after the '
    'best straight line is subtracted; the largest of the muscles. It needs the same rest as '
    'error_at_rest, and finite commands.',
)
def _chatter(trial: Trial) -> float | None:
    part = rest(trial)
    if part is None or not np.isfinite(trial.pressure[part]).all():
        return None
    return KILO * float(np.max(np.ptp(detrend(trial.pressure[part], axis=0), axis=0)))


@score(
    'limit_violations',
    unit='percent',
    text='Share of the commands of all muscles that are below p_min, above p_max or not finite, '
    'also of those during outages. Up to 0.1 Pa beyond a limit counts as rounding to single '
    'precision.',
)
def _limit_violations(trial: Trial) -> float:
    low, high = trial.limits
    is_within = (trial.pressure >= low - LIMIT_ROUNDING) & (
        trial.pressure <= high + LIMIT_ROUNDING
    )
    return 100.0 * float(np.mean(~is_within))


@score(
    'filling',
    unit='kPa/s',
    text='Sum of all rises of the commanded pressure, within the limits, divided by the time, sum '
    'of the muscles, in the time of pressure_variation. The air that muscles of a given volume '
    'use is proportional to it. It is not a measured consumption: volumes change with the '
    'contraction, and the pressure follows its command with a lag.',
)
def _filling(trial: Trial) -> float | None:
    sent = commands(trial)
    if sent is None:
        return None
    pressure, duration = sent
    rises = np.diff(np.clip(pressure, *trial.limits), axis=0)
    return KILO * float(np.sum(rises[rises > 0.0])) / duration


# Computing ---------------------------------------------------------------------------------------


@score(
    'computing_time',
    unit='ms',
    text=f'Median time from sending a state to receiving its command. {LOAD}',
    is_of_machine=True,
)
def _computing_time(trial: Trial) -> float | None:
    return _answer_time(trial, 50.0)


@score(
    'computing_time_worst',
    unit='ms',
    text=f'99th percentile of the time from sending a state to receiving its command. {LOAD}',
    is_of_machine=True,
)
def _computing_time_worst(trial: Trial) -> float | None:
    return _answer_time(trial, 99.0)


def _answer_time(trial: Trial, percent: float) -> float | None:
    """Return a percentile of the times in ms of the states that were answered."""
    answered = trial.answer[np.isfinite(trial.answer)]
    return MILLI * float(np.percentile(answered, percent)) if answered.size else None
