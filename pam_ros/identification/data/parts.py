# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Three parts of every recording: what fits see, what choices see, and what judges at the end.

Where a load moves freely they are the first, the next and the last of the time: what a model is
worth is how far it carries on by itself. Where there are enough recordings, whole ones decide:
each may have a single step up and a single step back at its end, which no fit would see otherwise.
A muscle at a prescribed length has no motion of its own, and such a recording often has a single
rise and a single fall of the pressure. There the parts are blocks of time in turn, so that each of
them sees all that was done.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.segment import (
    HeldSegment,
    Segment,
    require_one_kind,
    segments_of,
)
from pam_ros.recording.recording import Recording

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
FEWEST = 16  # samples with which a run can be fitted
BLOCKS = 20  # of a recording at a prescribed length: 3 s of a minute
GOLDEN = 0.6180339887  # multiples of it, without their whole parts, fill 0 to 1 in no rhythm
FIT, CHOOSE, JUDGE = range(3)


@dataclass(frozen=True, eq=False)
class Part:
    """A gapless stretch of a recording, and what each of its blocks is for.

    ``ends`` (m,) are the times in s, ascending, at which a block ends, and ``roles`` (m + 1,) say
    of each block whether it is fitted, decides between models, or judges: that, nothing sees
    before a verdict.
    """

    segment: Segment
    ends: Array
    roles: NDArray[np.int_]

    def _is(self, role: int) -> Mask:
        block = np.searchsorted(self.ends, self.segment.t, side='right')
        return np.asarray(self.roles[block] == role)

    @property
    def fit(self) -> Mask:
        """Marks the samples that are fitted (n,)."""
        return self._is(FIT)

    @property
    def choose(self) -> Mask:
        """Marks the samples that decide between models (n,)."""
        return self._is(CHOOSE)

    @property
    def judge(self) -> Mask:
        """Marks the samples that judge (n,)."""
        return self._is(JUDGE)

    @property
    def known(self) -> Mask:
        """Marks the samples that a verdict may rest on (n,): all that do not judge."""
        return ~self.judge

    @property
    def is_fitted(self) -> bool:
        """Whether enough of it may be fitted to be a run of a fit."""
        return int(np.count_nonzero(self.fit)) >= FEWEST

    @property
    def to_fit(self) -> Segment:
        """The segment as a run of a fit."""
        return run_of(self.segment, self.fit)

    @property
    def known_stretches(self) -> list[Segment]:
        """The gapless stretches of samples that a verdict may rest on."""
        edges = np.flatnonzero(np.diff(self.known)) + 1
        rows = np.split(np.arange(self.known.size), edges)
        return [_only(self.segment, some) for some in rows if self.known[some[0]]]


def parts_of(recordings: Sequence[Recording], fit: float, choose: float) -> list[Part]:
    """Return the gapless stretches of *recordings*, those with enough to be fitted first.

    *fit* is the share of the time that is fitted, *choose* the share that is fitted or decides:
    of each recording, or, but for what judges, of the recordings where whole ones can decide.
    Raises RecordingError when kinds are mixed.
    """
    require_one_kind(recordings)
    deciding = _deciding(recordings, 1.0 - fit / choose)
    found = []
    for k, recording in enumerate(recordings):
        segments = segments_of([recording])
        if not segments:
            continue
        start, end = segments[0].t[0], segments[-1].t[-1]
        if recording.kind == 'held':
            places = np.arange(1, BLOCKS) / BLOCKS
            draws = _draws(BLOCKS)
        elif deciding:
            places = np.array([choose])
            draws = np.array([fit if k in deciding else 0.0, choose])
        else:
            places, draws = np.array([fit, choose]), np.array([0.0, fit, choose])
        # The last sample belongs to the last part that there is.
        ends = np.where(places < 1.0, start + places * (end - start), np.inf)
        roles = np.searchsorted([fit, choose], draws, side='right')
        found += [Part(segment, ends, roles) for segment in segments]
    return sorted(found, key=lambda part: not part.is_fitted)


def _deciding(recordings: Sequence[Recording], share: float) -> set[int]:
    """Return the numbers of the free recordings that decide as a whole: none where they are few.

    They have at most this *share* of the time of all.
    """
    if recordings[0].kind == 'held':
        return set()
    times = [recording.duration for recording in recordings]
    found: set[int] = set()
    for k in np.argsort(-_draws(len(recordings)), kind='stable').tolist():
        if sum(times[i] for i in (*found, k)) <= share * sum(times):
            found.add(k)
    return found


def _draws(count: int) -> Array:
    """Return numbers (count,) between 0 and 1, in no rhythm."""
    return np.asarray(np.arange(1, count + 1) * GOLDEN % 1.0, dtype=float)


def run_of(segment: Segment, fit: Mask) -> Segment:
    """Return *segment* as a run of a fit to the samples that *fit* (n,) marks.

    It is cut off after the last of them; those before are simulated, and are not compared.
    """
    rows = np.arange(int(np.flatnonzero(fit)[-1]) + 1)
    return _only(replace(segment, fit=fit), rows)


def _only(segment: Segment, rows: NDArray[np.int_]) -> Segment:
    """Return *rows* of the samples of *segment*; commands stay as they are."""
    names = ['t', 'target', 'fit']
    if isinstance(segment, HeldSegment):
        names += ['pressure', 'position', 'velocity']
    return replace(segment, **{name: getattr(segment, name)[rows] for name in names})
