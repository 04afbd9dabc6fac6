# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Shares of the PID gains over the reach and the stiffness of a nominal joint."""

from bisect import bisect
from dataclasses import dataclass
from math import isfinite

import numpy as np

from pam_ros.control.allocation import Allocation
from pam_ros.control.pid_margin import LinearPlant, Share, share
from pam_ros.control.tuning import number
from pam_ros.errors import ParameterError, RangeError


@dataclass(frozen=True)
class ScheduleTuning:
    """Where the shares are found; between these places they are interpolated."""

    places: int = number(17, '', 'along the reach: from one to the next k changes at most by 1.6')


TUNING = ScheduleTuning()


def plant_at(allocation: Allocation, s: float, stiffness: float) -> LinearPlant:
    """Return the joint at rest at *s*, with the *stiffness* if it can be chosen."""
    model = allocation.model
    p = allocation.split(model.gravity(s), stiffness, s).pressures
    k = model.stiffness(p, s) + model.gravity_stiffness(s)
    gain = sum(map(abs, allocation.gains(s)))
    return LinearPlant(model.inertia, model.damping(p, s, 0.0), k, gain)


class Schedule:
    """Shares of some gains (Kp, Ki, Kd, bandwidth of the filter) for each reference.

    Raises ParameterError if some place of the reach has no stable share of the gains.
    """

    def __init__(
        self, allocation: Allocation, gains: tuple[float, float, float, float], stiffness: float
    ) -> None:
        """Find them for the desired *stiffness*, and for the least and the greatest one."""
        low, high = allocation.reach
        self._places = np.linspace(low, high, TUNING.places) if isfinite(high) else np.zeros(1)
        self._allocation, self._gains = allocation, gains
        self._levels = [stiffness]
        if allocation.can_stiffen:
            ranges = [allocation.stiffness_range(float(s)) for s in self._places]
            least, most = min(r[0] for r in ranges), max(r[1] for r in ranges)
            self._levels = sorted({min(least, stiffness), stiffness, max(most, stiffness)})
        self._table = [self._row(k) for k in self._levels]
        self._refuse_unstable(self._table[self._levels.index(stiffness)])

    def _row(self, stiffness: float) -> list[Share | None]:
        return [
            share(self._gains, plant_at(self._allocation, float(s), stiffness))
            for s in self._places
        ]

    def _refuse_unstable(self, row: list[Share | None]) -> None:
        for s, found in zip(self._places, row, strict=True):
            if found is None:
                unit = self._allocation.model.joint.transmission.equations
                k = plant_at(self._allocation, float(s), self._levels[0]).stiffness
                raise ParameterError(
                    f'no share of these PID gains is stable at {s:.4g} {unit.unit}, where the '
                    f'joint has a stiffness of {k:.4g} {unit.effort_unit}/{unit.unit} with that '
                    'of gravity: give a larger pid.proportional, or take the sliding_mode law'
                )

    def refuse_stiffness(self, stiffness: float) -> None:
        """Raise RangeError if no share of the gains is stable with a *stiffness*."""
        below, above, _ = self._between(stiffness)
        if None not in self._table[below] and None not in self._table[above]:
            return
        row = self._row(stiffness)
        if None in row:
            unit = self._allocation.model.joint.transmission.equations
            raise RangeError(
                f'co-contraction {stiffness:.6g} {unit.effort_unit}/{unit.unit} leaves no share '
                'of these PID gains stable in all of the reach: give a larger one'
            )
        at = bisect(self._levels, stiffness)
        self._levels.insert(at, stiffness)
        self._table.insert(at, row)

    def at(self, s: float, stiffness: float) -> Share:
        """Return the share at a reference *s*, interpolated over position and stiffness."""
        below, above, part = self._between(stiffness)
        one, two = self._along(below, s), self._along(above, s)
        return Share(*(a + part * (b - a) for a, b in zip(one, two, strict=True)))

    def _between(self, stiffness: float) -> tuple[int, int, float]:
        """Return the levels around a *stiffness*, and its share of the distance between them."""
        levels = self._levels
        for i in range(len(levels) - 1):
            if stiffness < levels[i + 1]:
                part = (stiffness - levels[i]) / (levels[i + 1] - levels[i])
                return (i, i + 1, part) if part > 0.0 else (i, i, 0.0)
        return len(levels) - 1, len(levels) - 1, 0.0

    def _along(self, level: int, s: float) -> Share:
        row, places = self._table[level], self._places
        if len(row) == 1:
            return row[0] or _NONE
        at = (s - places[0]) / (places[-1] - places[0]) * (len(row) - 1)
        i = min(max(int(at), 0), len(row) - 2)
        part = min(max(at - i, 0.0), 1.0)
        one, two = row[i] or _NONE, row[i + 1] or _NONE
        return Share(*(a + part * (b - a) for a, b in zip(one, two, strict=True)))


_NONE = Share(1.0, 1.0)  # if no share is stable: rejected before use
