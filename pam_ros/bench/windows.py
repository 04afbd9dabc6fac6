# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parts of a trial that scores are about: its motion, its rest, its jumps and its changes.

Lengths are counted in periods, so that the rounding of the times makes no difference. The time of
an outage, in which no controller can act, belongs to none of them.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.bench.trial import Trial

STILL = 1e-9  # m or rad: a reference that differs by no more is constant, up to rounding
ROUNDING = 1e-9  # s: the stamps of ROS are whole nanoseconds
REST = 4.0  # s for which reference and rig must be constant at the end
JUDGED = 2.0  # s at the end of this rest that are judged
LATEST = 1.0  # s after the start from which a trial without motion and change is judged
NEAR = 1.0  # s around a change in which the reference must be constant


class Part(NamedTuple):
    """Samples from ``begin`` on, up to but without ``end``, after an event at time ``time`` in s.

    ``jump`` is the signed size of the jump of the reference at ``begin``, 0 at a change. What is
    before the event ends without the sample ``before``: the begin of an outage from which the rig
    returns at ``begin``.
    """

    begin: int
    end: int
    time: float
    jump: float = 0.0
    before: int = 0

    @property
    def samples(self) -> slice:
        """The samples as a slice."""
        return slice(self.begin, self.end)


def periods(trial: Trial, seconds: float) -> int:
    """Return how many periods there are in *seconds*, rounded."""
    return round(seconds / trial.period)


def can_act(trial: Trial) -> NDArray[np.bool_]:
    """Return whether a controller can act at each sample (n,): not during an outage."""
    t = trial.t + ROUNDING
    acts = np.ones(t.size, dtype=bool)
    for begin, end in trial.outages:
        acts &= (t < begin) | (t >= end)
    return acts


def motion(trial: Trial) -> NDArray[np.int64] | None:
    """Return the samples from the first motion of the reference or event of the rig on.

    If there is neither, they begin 1 s after the start. Those of outages are left out; None if
    none remains.
    """
    moved = np.flatnonzero(np.abs(trial.reference - trial.reference[0]) > STILL)
    begins = [*moved[:1], *event_samples(trial)[:1]] or [periods(trial, LATEST)]
    samples = np.flatnonzero(can_act(trial))
    samples = samples[samples >= min(begins)]
    return samples if samples.size else None


def commands(trial: Trial) -> tuple[NDArray[np.float64], float] | None:
    """Return the commands of :func:`motion` and the one before them, and their duration in s.

    A command that is not finite is replaced by the last one before it that is finite, as a valve
    keeps its pressure; None if a muscle has no finite command, or if there is no duration.
    """
    part = motion(trial)
    is_finite = np.isfinite(trial.pressure)
    if part is None or not is_finite.any(axis=0).all():
        return None
    rows = np.arange(trial.t.size)[:, None]
    last = np.maximum.accumulate(np.where(is_finite, rows, -1), axis=0)
    kept = np.where(last < 0, is_finite.argmax(axis=0), last)  # before the first one: the first
    filled = np.take_along_axis(trial.pressure, kept, axis=0)
    first = np.flatnonzero(can_act(trial)[: part[0]])[-1:]
    samples = np.concatenate([first, part])
    return (filled[samples], (samples.size - 1) * trial.period) if samples.size > 1 else None


def rest(trial: Trial) -> slice | None:
    """Return the samples of the last 2 s, if reference and rig are constant in the last 4 s."""
    begin = trial.t.size - 1 - periods(trial, REST)
    if begin < 0 or not _is_still(trial.reference[begin:]):
        return None
    if any(sample > begin for sample in event_samples(trial)) or not can_act(trial)[begin:].all():
        return None
    return slice(trial.t.size - 1 - periods(trial, JUDGED), trial.t.size)


def _samples_at(trial: Trial, times: NDArray[np.float64]) -> list[int]:
    """Return the first sample at or after each of *times* in s, n for one after the end."""
    return [int(k) for k in np.searchsorted(trial.t + ROUNDING, times)]


def event_samples(trial: Trial) -> list[int]:
    """Return the first sample at or after each event of the rig, ascending, each once.

    These are its changes, and the begin and the end of its outages.
    """
    times = np.concatenate([trial.changes, trial.outages.ravel()])
    return sorted({k for k in _samples_at(trial, times) if k < trial.t.size})


def jumps(trial: Trial) -> list[Part]:
    """Return the part after each jump, up to the next jump or event of the rig, or to the end.

    Empty unless the reference is constant but for jumps from one sample to the next. A jump during
    an outage is left out.
    """
    begins = np.flatnonzero(np.abs(np.diff(trial.reference)) > STILL) + 1
    if np.any(np.diff(begins) < 2) or not all(
        _is_still(level) for level in np.split(trial.reference, begins)
    ):
        return []
    events, acts = [*begins, *event_samples(trial), trial.t.size], can_act(trial)
    return [
        Part(
            int(k),
            int(min(event for event in events if event > k)),
            float(trial.t[k]),
            float(trial.reference[k] - trial.reference[k - 1]),
        )
        for k in begins
        if acts[k]
    ]


def changes(trial: Trial) -> list[Part]:
    """Return the part after each change of the rig and each return from an outage.

    It lasts up to the next event of the rig or motion of the reference, or to the end. One while
    the reference moves, or within 1 s of its motion, is left out: the errors before and after it
    are those of the motion as well. A change during an outage belongs to the return.
    """
    acts, near = can_act(trial), periods(trial, NEAR)
    befores = {k: k for k in _samples_at(trial, trial.changes)}
    befores |= {
        end: begin
        for begin, end in zip(*(_samples_at(trial, ends) for ends in trial.outages.T), strict=True)
    }
    events = [*event_samples(trial), trial.t.size]
    found = []
    for k, before in sorted(befores.items()):
        if k == trial.t.size or not acts[k]:
            continue
        if _is_still(trial.reference[max(before - near, 0) : k + near + 1]):
            following = min(event for event in events if event > k)
            moved = np.abs(trial.reference[k:following] - trial.reference[k]) > STILL
            end = k + int(moved.argmax()) if moved.any() else following
            found.append(Part(k, end, float(trial.t[k]), before=before))
    return found


def _is_still(values: NDArray[np.float64]) -> bool:
    return bool(np.ptp(values) <= STILL)
