# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Three parts of every recording: for fits, for choices between models, and to judge them.

If a load moves freely, they are the first, the next and the last part of the time, since a model
is judged by how well its free run continues. If there are enough recordings, the choices use whole
recordings: each may have a single step up, and a single step down at its end, which otherwise no
fit would use.
A muscle at a prescribed length has no motion of its own, and such a recording often has a single
rise and a single fall of the pressure. Then the parts are interleaved blocks of time, so that each
part contains all of the excitation. It is the same if only pressures were recorded, and if the
pressure of a load that moves freely rises and falls only once, as in a slow cycle.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.division import (
    CHOOSE,
    FIT,
    JUDGE,
    Division,
    deciding,
    divide,
    divide_in_time,
    divide_in_turn,
    with_one_role,
)
from pam_ros.identification.data.segment import (
    HeldSegment,
    Segment,
    require_one_kind,
    segments_of,
)
from pam_ros.recording.recording import Recording

Mask = NDArray[np.bool_]
FEWEST = 16  # smallest number of samples of a run that can be fitted


@dataclass(frozen=True, eq=False)
class Part:
    """A gapless stretch of a recording, and the division of the recording.

    The samples that judge are not used before the verdict.
    """

    segment: Segment
    division: Division

    def _is(self, role: int) -> Mask:
        return np.asarray(self.division.at(self.segment.t) == role)

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
    def used(self) -> Mask:
        """Marks the samples that are fitted or decide (n,): no judge, and none left out."""
        used: Mask = self.fit | self.choose
        return used

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
    chosen = deciding(recordings, 1.0 - fit / choose)

    def division(k: int, start: float, end: float) -> Division:
        if chosen:
            return with_one_role(start, end, CHOOSE if k in chosen else FIT, choose)
        return divide(recordings[k], start, end, fit, choose)

    return _parts(recordings, division)


def parts_in_time(recording: Recording, fit: float, choose: float) -> list[Part]:
    """Return the stretches of *recording*, of which the first, next and last part have the roles.

    The shares are those of :func:`parts_of`.
    """
    return _parts([recording], lambda k, start, end: divide_in_time(start, end, fit, choose))


def parts_in_turn(recordings: Sequence[Recording], fit: float, choose: float) -> list[Part]:
    """Return the stretches of *recordings*, whose blocks before those that judge are in turn.

    The shares are those of :func:`parts_of`, and the same samples judge.
    """
    return _parts(
        recordings, lambda k, start, end: divide_in_turn(start, end, fit, choose, choose)
    )


def like(parts: Sequence[Part], recordings: Sequence[Recording]) -> list[Part]:
    """Return the stretches of *recordings*, divided as *parts* at the same times.

    They are other signals of the recordings of *parts*, or have other inputs.
    """
    divisions = {part.segment.recording: part.division for part in parts}
    return _parts(recordings, lambda k, start, end: divisions.get(k))


def _parts(
    recordings: Sequence[Recording], division_of: Callable[[int, float, float], Division | None]
) -> list[Part]:
    """Return the stretches of *recordings*, first those that are fitted.

    division_of(k, start, end) returns the division of recording k between these times in s, or
    None if it has no stretch that is used.
    """
    found = []
    for k, recording in enumerate(recordings):
        segments = segments_of([recording])
        if segments and (division := division_of(k, segments[0].t[0], segments[-1].t[-1])):
            found += [Part(replace(segment, recording=k), division) for segment in segments]
    return sorted(found, key=lambda part: not part.is_fitted)


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
