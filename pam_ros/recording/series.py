# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One signal as it was sampled, with its own stamps, before signals become a recording."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError

Array = NDArray[np.float64]

GAP_PERIODS = 10.0  # a pause of more than this many sampling periods,
GAP_SECONDS = 0.05  # and of more than this many s, is a gap: the scheduler causes shorter ones
EDGE = 1.0  # s that a signal may begin later or end earlier than the others
COARSE = 0.01  # share of equal stamps above which the clock is called too coarse


@dataclass(frozen=True, eq=False)
class Series:
    """Values in SI at stamps in s, both (n,), as they came from *source*.

    Values are (n, muscles) after the signals of several muscles are combined. ``is_received``
    means that the stamps are those of the receipt of messages.
    """

    source: str
    t: Array
    value: Array
    is_received: bool = False

    @classmethod
    def taken(
        cls, name: str, source: str, t: Array, value: Array, is_received: bool = False
    ) -> 'Series':
        """Return the samples that were taken: those of *value* that are not NaN.

        Single samples may be missing, or the rate of the column may be lower than that of the
        stamps *t*. Raises RecordingError, with the name of the recording, for infinite values,
        and for a stretch without values that is longer than :attr:`gap_limit` (at the ends also
        longer than 1 s), since the sensor has failed there.
        """
        if np.isinf(value).any():
            at = t[np.argmax(np.isinf(value))]
            raise RecordingError(f'{name}: {source} is infinite at {at:.6g} s')
        taken = np.isfinite(value)
        one = cls(source, t[taken], value[taken], is_received)
        edges = np.concatenate(([t[0]], one.t, [t[-1]]))
        limits = np.full(edges.size - 1, one.gap_limit)
        limits[0] = limits[-1] = max(one.gap_limit, EDGE)
        for i in np.flatnonzero(np.diff(edges) > limits):
            start, end = edges[i : i + 2]
            inside = np.count_nonzero((t > start) & (t < end))
            if inside:
                raise RecordingError(
                    f'{name}: {source} has no values from {start:.6g} s to {end:.6g} s ({inside} '
                    'empty or NaN): repair the sensor, or cut the recording there'
                )
        return one

    @property
    def gap_limit(self) -> float:
        """Return the pause in s above which samples are missing."""
        if self.t.size < 2:
            return GAP_SECONDS
        return max(GAP_PERIODS * float(np.median(np.diff(self.t))), GAP_SECONDS)

    def holes(self) -> list[tuple[float, float]]:
        """Return the pauses (from, to) in s that are longer than :attr:`gap_limit`."""
        at = np.flatnonzero(np.diff(self.t) > self.gap_limit)
        return [(float(self.t[i]), float(self.t[i + 1])) for i in at]

    @property
    def shared(self) -> int:
        """Return how many samples have the time of the one before, and another value.

        A message that is published again while time stands still has the same value: it is the
        same sample.
        """
        values = self.value.reshape(self.t.size, -1)
        differs = (values[1:] != values[:-1]).any(axis=1)
        return int(np.count_nonzero(differs & (np.diff(self.t) == 0.0)))

    @property
    def is_coarse(self) -> bool:
        """Return whether so many share their time that the clock must be too coarse."""
        return self.shared > max(COARSE * self.t.size, 2)

    def ascending(self) -> 'Series':
        """Return the series with strictly ascending stamps: of equal stamps, the last is kept."""
        keep = np.append(np.diff(self.t) > 0.0, True)
        return replace(self, t=self.t[keep], value=self.value[keep])


def refuse_backwards(t: Array, what: str) -> None:
    """Raise RecordingError if the stamps *t* in s go backwards."""
    at = np.flatnonzero(np.diff(t) < 0.0)
    if at.size:
        i = int(at[0])
        raise RecordingError(
            f'{what} goes backwards: {t[i + 1]:.9g} s after {t[i]:.9g} s, at sample {i + 2} of '
            f'{t.size} (a clock that was set, a simulation that was reset, or two recordings '
            'in one file?)'
        )
