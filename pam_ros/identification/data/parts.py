# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Three parts of every recording: for fits, for choices between models, and to judge them.

If a load moves freely, they are the first, the next and the last part of the time, since a model
is judged by how well its free run continues. If there are enough recordings, the choices use whole
recordings: each may have a single step up, and a single step down at its end, which otherwise no
fit would use.
A muscle at a prescribed length has no motion of its own, and such a recording often has a single
rise and a single fall of the pressure. Then the parts are interleaved blocks of time, so that each
part contains all of the excitation. It is the same if only pressures were recorded.
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
FEWEST = 16  # smallest number of samples of a run that can be fitted
BLOCKS = 20  # of a recording without a free motion: 3 s of a minute
GOLDEN = 0.6180339887  # the fractional parts of its multiples fill 0 to 1 without a period
FIT, CHOOSE, JUDGE = range(3)


@dataclass(frozen=True, eq=False)
class Part:
    """A gapless stretch of a recording, and the role of each of its blocks.

    ``ends`` (m,) are the times in s, ascending, at which a block ends. ``roles`` (m + 1,) are the
    roles of the blocks: a block is fitted, decides between models, or judges. A judging block is
    not used before the verdict.
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
        """Marks the samples that a verdict may be based on (n,): all that do not judge."""
        return ~self.judge

    @property
    def is_fitted(self) -> bool:
        """Whether enough of its samples may be fitted for a run of a fit."""
        return int(np.count_nonzero(self.fit)) >= FEWEST

    @property
    def to_fit(self) -> Segment:
        """The segment as a run of a fit."""
        return run_of(self.segment, self.fit)

    @property
    def known_stretches(self) -> list[Segment]:
        """The gapless stretches of samples that a verdict may be based on."""
        edges = np.flatnonzero(np.diff(self.known)) + 1
        rows = np.split(np.arange(self.known.size), edges)
        return [_only(self.segment, some) for some in rows if self.known[some[0]]]


def parts_of(recordings: Sequence[Recording], fit: float, choose: float) -> list[Part]:
    """Return the gapless stretches of *recordings*, first those with enough samples to fit.

    *fit* is the share of the time that is fitted, *choose* the share that is fitted or decides.
    They are shares of each recording. If whole recordings can decide, only the judging part is a
    share of each recording, and the other two are shares of the total duration of the recordings.
    Raises RecordingError if kinds are mixed.
    """
    require_one_kind(recordings)
    deciding = _deciding(recordings, 1.0 - fit / choose)
    found = []
    for k, recording in enumerate(recordings):
        segments = [replace(one, recording=k) for one in segments_of([recording])]
        if not segments:
            continue
        start, end = segments[0].t[0], segments[-1].t[-1]
        if recording.kind != 'free':
            places = np.arange(1, BLOCKS) / BLOCKS
            draws = _draws(BLOCKS)
        elif deciding:
            places = np.array([choose])
            draws = np.array([fit if k in deciding else 0.0, choose])
        else:
            places, draws = np.array([fit, choose]), np.array([0.0, fit, choose])
        # The last sample belongs to the last part that is not empty.
        ends = np.where(places < 1.0, start + places * (end - start), np.inf)
        roles = np.searchsorted([fit, choose], draws, side='right')
        found += [Part(segment, ends, roles) for segment in segments]
    return sorted(found, key=lambda part: not part.is_fitted)


def _deciding(recordings: Sequence[Recording], share: float) -> set[int]:
    """Return the indices of the free recordings that decide as a whole; none if there are few.

    Their duration is at most this *share* of the total duration.
    """
    if recordings[0].kind != 'free':
        return set()
    times = [recording.duration for recording in recordings]
    found: set[int] = set()
    for k in np.argsort(-_draws(len(recordings)), kind='stable').tolist():
        if sum(times[i] for i in (*found, k)) <= share * sum(times):
            found.add(k)
    return found


def _draws(count: int) -> Array:
    """Return numbers (count,) between 0 and 1, without a period."""
    return np.asarray(np.arange(1, count + 1) * GOLDEN % 1.0, dtype=float)


def run_of(segment: Segment, fit: Mask) -> Segment:
    """Return *segment* as a run of a fit to the samples that *fit* (n,) marks.

    It ends after the last of them. Other samples before are simulated, but not compared.
    """
    rows = np.arange(int(np.flatnonzero(fit)[-1]) + 1)
    return _only(replace(segment, fit=fit), rows)


def _only(segment: Segment, rows: NDArray[np.int_]) -> Segment:
    """Return *rows* of the samples of *segment*; its commands do not change."""
    names = ['t', 'target', 'fit']
    if isinstance(segment, HeldSegment):
        names += ['pressure', 'position', 'velocity']
    return replace(segment, **{name: getattr(segment, name)[rows] for name in names})
