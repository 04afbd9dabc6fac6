# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Three parts of every recording: what fits see, what choices see, and what judges at the end."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.segment import HeldSegment, Segment, segments_of
from pam_ros.recording.recording import Recording

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
FEWEST = 16  # samples with which a run can be fitted


@dataclass(frozen=True, eq=False)
class Part:
    """A gapless stretch of a recording, with the time in s at which each part of it ends.

    Samples before ``fit_until`` are fitted, those from there to ``choose_until`` decide between
    models, and the rest, which nothing sees before a verdict, judges.
    """

    segment: Segment
    fit_until: float
    choose_until: float

    @property
    def fit(self) -> Mask:
        """Marks the samples that are fitted (n,)."""
        return self.segment.t < self.fit_until

    @property
    def choose(self) -> Mask:
        """Marks the samples that decide between models (n,)."""
        return ~self.fit & self.known

    @property
    def known(self) -> Mask:
        """Marks the samples that a verdict may rest on (n,): all that do not judge."""
        return self.segment.t < self.choose_until

    @property
    def judge(self) -> Mask:
        """Marks the samples that judge (n,)."""
        return ~self.known

    @property
    def is_fitted(self) -> bool:
        """Whether enough of it may be fitted to be a run of a fit."""
        return int(np.count_nonzero(self.fit)) >= FEWEST

    @property
    def to_fit(self) -> Segment:
        """The segment cut off where fits end."""
        return cut(self.segment, self.fit)


def parts_of(recordings: Sequence[Recording], fit: float, choose: float) -> list[Part]:
    """Return the gapless stretches of *recordings*, those with enough to be fitted first.

    *fit* and *choose* are the shares of each recording's time at which these parts end. Raises
    RecordingError when kinds are mixed.
    """
    segments_of(recordings, keep_back=False)
    found = []
    for recording in recordings:
        segments = segments_of([recording], keep_back=False)
        if not segments:
            continue
        start, end = segments[0].t[0], segments[-1].t[-1]
        # The last sample belongs to the last part that there is.
        edges = [
            start + share * (end - start) if share < 1.0 else np.inf for share in (fit, choose)
        ]
        found += [Part(segment, *edges) for segment in segments]
    return sorted(found, key=lambda part: not part.is_fitted)


def cut(segment: Segment, keep: Mask) -> Segment:
    """Return the samples of *segment* that *keep* (n,) marks; commands stay as they are."""
    names = ['t', 'target', 'fit']
    if isinstance(segment, HeldSegment):
        names += ['pressure', 'position', 'velocity']
    return replace(segment, **{name: getattr(segment, name)[keep] for name in names})
