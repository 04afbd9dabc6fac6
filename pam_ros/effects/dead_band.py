# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Dead band: below a threshold of the pressure, bladder or valve do nothing.

What a muscle with this effect has as its pressure is what acts on its braid, which a sensor in the
chamber does not see where the bladder has the threshold.
"""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectEquations, Row, Starts
from pam_ros.effects.parameter import effect_parameter, start_from, strength

BAND, WIDTH = range(2)


@scalar
def beyond(p: float, band: float, width: float) -> float:
    """Return max(p - band, 0), the corner rounded by a parabola over *width* to either side."""
    above = p - band
    if above >= width:
        return above
    if above <= -width:
        return 0.0
    return (above + width) * (above + width) / (4.0 * width)


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return what of the pressure p in Pa is beyond the band.

    The corner has its width, but no wider than the band: no pressure stays none.
    """
    if q[j + BAND] == 0.0:
        return p
    return beyond(p, q[j + BAND], min(q[j + WIDTH], q[j + BAND]))


@dataclass(frozen=True)
class DeadBand(Effect):
    """Threshold of the pressure, below which the bladder or the valve does nothing."""

    band: float = strength('pressure up to which nothing happens', 'Pa', high=2e5, scale=2e4)
    width: float = effect_parameter(
        2e3,
        'pressure on either side of the corner over which the effect sets in',
        'Pa',
        low=1.0,
        high=1e5,
        scale=5e3,
    )

    name: ClassVar = 'dead_band'
    text: ClassVar = 'threshold of the pressure, below which the bladder or the valve does nothing'
    source: ClassVar = 'Klute and Hannaford 2000 (bladder inside the braid); valves with overlap'
    signature: ClassVar = 'residual that grows up to the threshold, and is then constant'
    experiment: ClassVar = 'slow ramps from no pressure up, at two loads'
    compensation: ClassVar = Compensation.PATH
    rivals: ClassVar = ('pressure_offset', 'slack')
    contains: ClassVar = {'pressure_offset': {'offset': 'band'}}
    equations: ClassVar = EffectEquations(pressure=pressure)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, band=1e4),
            start_from(cls, band=5e4),
            start_from(cls, band=3e4, width=1e4),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return it clearly present."""
        return cls(band=2e4, width=4e3)
