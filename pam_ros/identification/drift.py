# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Held recordings of one length that drift apart: the later ones say more of what comes next.

A muscle that was brought to another length settles there for many minutes, and a force cell's
zero wanders. Between recordings that takes its way unseen. A level that wanders is best foretold
by its last value (the local level model; Durbin and Koopman 2012, section 2.2, where the level
moves by more than its measurement is uncertain).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.candidate import Fit
from pam_ros.identification.data.segment import HeldSegment
from pam_ros.rig import layout as at

Array = NDArray[np.float64]
RECENT = 4.0  # how much more a recording counts than the one before it
SAME = 1e-3  # share of the muscle's length by which recordings of one length may differ
SLIPPED = 4.0  # typical distances from the middle one at which the last recording slipped


@dataclass(frozen=True, eq=False)
class Drift:
    """Runs of one length that differ by more than the noise, in the order of recording.

    runs: their numbers; kappa: the contraction; levels (n,): the median of the force in N that
    was measured beyond what a fit gives.
    """

    runs: tuple[int, ...]
    kappa: float
    levels: Array

    @property
    def last_slipped(self) -> bool:
        """Whether the last run lies off all of the others, so that it must not decide."""
        off = np.abs(self.levels - np.median(self.levels))
        return bool(off.size > 2 and off[-1] > SLIPPED * np.median(off))

    @property
    def shares(self) -> Array:
        """How much each run (n,) counts in the final fit: 1 on average."""
        order = np.arange(self.levels.size, dtype=float)
        if self.last_slipped:
            order[-1] = 0.0
        share = RECENT**order
        return np.asarray(share / share.mean())

    def __str__(self) -> str:
        """Say how far they are apart, and what is made of it."""
        levels = ', '.join(f'{level:+.1f}' for level in self.levels)
        counts = 'slipped and counts least' if self.last_slipped else 'counts most'
        return (
            f'the recordings at {100.0 * self.kappa:.4g} % contraction differ by '
            f'{np.ptp(self.levels):.1f} N, more than the noise ({levels} N, in their order): '
            f'the last one {counts}'
        )


def drifts(fit: Fit, sigma: float) -> list[Drift]:
    """Return the held lengths whose runs differ by more than the noise *sigma* in N.

    Runs are taken to be in the order in which they were recorded. A run whose length moves, and
    a free one, is not compared.
    """
    problem = fit.solution.problem
    runs = [s for s in problem.segments if isinstance(s, HeldSegment)]
    if len(runs) < len(problem.segments):
        return []
    simulated = problem.predict(fit.solution.u)
    l0 = float(problem.row[problem.layout.constant(at.L0)])
    found = []
    for same in _of_one_length(runs, SAME * l0):
        left = [(runs[k].target - simulated[k])[runs[k].fit] for k in same]
        levels = np.array([np.median(e) for e in left])
        if np.ptp(levels) > sigma:
            kappa = float(runs[same[0]].position.mean() / l0)
            found.append(Drift(tuple(same), kappa, levels))
    return found


def shares(drifting: Sequence[Drift], count: int) -> tuple[float, ...]:
    """Return how much each of *count* runs counts in the final fits; none where nothing drifts."""
    found = np.ones(count)
    for drift in drifting:
        found[list(drift.runs)] = drift.shares
    return tuple(found) if drifting else ()


def _of_one_length(segments: Sequence[HeldSegment], same: float) -> list[list[int]]:
    """Return the numbers of the runs at each length; lengths less than *same* m apart are one."""
    groups: dict[float, list[int]] = {}
    for k, s in enumerate(segments):
        if s.fit.any() and np.ptp(s.position) < same:
            length = float(s.position.mean())
            known = next((one for one in groups if abs(one - length) < same), length)
            groups.setdefault(known, []).append(k)
    return list(groups.values())
