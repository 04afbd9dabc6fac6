# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parts of a trial that scores are about: its motion, its rest, its jumps and its changes.

Lengths are counted in periods, so that the rounding of the times makes no difference.
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

    ``jump`` is the signed size of the jump of the reference at ``begin``, 0 at a change.
    """

    begin: int
    end: int
    time: float
    jump: float = 0.0

    @property
    def samples(self) -> slice:
        """The samples as a slice."""
        return slice(self.begin, self.end)


def periods(trial: Trial, seconds: float) -> int:
    """Return how many periods there are in *seconds*, rounded."""
    return round(seconds / trial.period)


def motion(trial: Trial) -> slice | None:
    """Return the samples from the first motion of the reference or change of the rig on.

    If there is neither, they begin 1 s after the start; None if the trial ends before.
    """
    moved = np.flatnonzero(np.abs(trial.reference - trial.reference[0]) > STILL)
    begins = [*moved[:1], *change_samples(trial)[:1]] or [periods(trial, LATEST)]
    begin = int(min(begins))
    return slice(begin, trial.t.size) if begin < trial.t.size else None


def commands(trial: Trial) -> tuple[NDArray[np.float64], float] | None:
    """Return the commands from the sample before :func:`motion` on, and their duration in s.

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
    begin = max(part.start - 1, 0)
    duration = float(trial.t[-1] - trial.t[begin])
    filled = np.take_along_axis(trial.pressure, kept, axis=0)
    return (filled[begin:], duration) if duration > 0.0 else None


def rest(trial: Trial) -> slice | None:
    """Return the samples of the last 2 s, if reference and rig are constant in the last 4 s."""
    begin = trial.t.size - 1 - periods(trial, REST)
    if begin < 0 or not _is_still(trial.reference[begin:]):
        return None
    if any(sample > begin for sample in change_samples(trial)):
        return None
    return slice(trial.t.size - 1 - periods(trial, JUDGED), trial.t.size)


def change_samples(trial: Trial) -> list[int]:
    """Return the first sample at or after each change of the rig, ascending, each once."""
    samples = np.unique(np.searchsorted(trial.t + ROUNDING, trial.changes))
    return [int(k) for k in samples if k < trial.t.size]


def jumps(trial: Trial) -> list[Part]:
    """Return the part after each jump, up to the next jump or change, or to the end.

    Empty unless the reference is constant but for jumps from one sample to the next.
    """
    begins = np.flatnonzero(np.abs(np.diff(trial.reference)) > STILL) + 1
    if np.any(np.diff(begins) < 2) or not all(
        _is_still(level) for level in np.split(trial.reference, begins)
    ):
        return []
    events = [*begins, *change_samples(trial), trial.t.size]
    return [
        Part(
            int(k),
            int(min(event for event in events if event > k)),
            float(trial.t[k]),
            float(trial.reference[k] - trial.reference[k - 1]),
        )
        for k in begins
    ]


def changes(trial: Trial) -> list[Part]:
    """Return the part after each change, up to the next change or motion, or to the end.

    A change while the reference moves, or within 1 s of its motion, is left out: the errors before
    and after it are those of the motion as well.
    """
    samples = change_samples(trial)
    near = periods(trial, NEAR)
    found = []
    for k, following in zip(samples, [*samples, trial.t.size][1:], strict=True):
        level = trial.reference[max(k - near, 0) : k + near + 1]
        if _is_still(level):
            moved = np.abs(trial.reference[k:following] - trial.reference[k]) > STILL
            end = k + int(moved.argmax()) if moved.any() else following
            found.append(Part(k, end, float(trial.t[k])))
    return found


def _is_still(values: NDArray[np.float64]) -> bool:
    return bool(np.ptp(values) <= STILL)
