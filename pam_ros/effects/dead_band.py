# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Dead band: below a threshold of the pressure, the bladder or the valve does nothing.

A recording of commands cannot distinguish a valve that gives no pressure below a threshold from a
bladder that must be inflated before it acts on the braid. In both cases the pressure that is
published is the one that acts in the muscle. A sensor in the chamber of a muscle whose bladder has
the threshold measures more than that, by the width of the band: do not connect it to
``pam_control``.
"""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectEquations, Row, Starts
from pam_ros.effects.parameter import effect_parameter, start_from, strength

BAND, WIDTH = range(2)


@scalar
def beyond(p: float, band: float, width: float) -> float:
    """Return max(p - band, 0), with a corner rounded by a parabola over +-*width*."""
    above = p - band
    if above >= width:
        return above
    if above <= -width:
        return 0.0
    return (above + width) * (above + width) / (4.0 * width)


def pressure(p: float, t: float, h: float, x: Row, i: int, xn: Row, q: Row, j: int) -> float:
    """Return the part of the pressure p in Pa that exceeds the band.

    The corner is rounded over the width, but at most over the band: 0 Pa stays 0 Pa.
    """
    if q[j + BAND] == 0.0:
        return p
    return beyond(p, q[j + BAND], min(q[j + WIDTH], q[j + BAND]))


@dataclass(frozen=True)
class DeadBand(Effect):
    """Threshold of the pressure, below which the bladder or the valve does nothing."""

    band: float = strength(
        'threshold of the pressure; below it the muscle gets none', 'Pa', high=2e5, scale=2e4
    )
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
    equation: ClassVar = (
        'p = max(p_in - band, 0)\n'
        'The corner is rounded by a parabola over +-width, but at most over +-band.'
    )
    signature: ClassVar = 'residual that grows up to the threshold, and is then constant'
    experiment: ClassVar = 'slow ramps from no pressure up, at two loads'
    excitation: ClassVar = {'segments': ('slow_triangle',), 'pressure_min': 0.0}
    compensation: ClassVar = Compensation.PATH
    rivals: ClassVar = ('pressure_offset', 'slack')
    # Above the band it is an offset of the other sign.
    contains: ClassVar = {'pressure_offset': {}}
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
        """Return the effect clearly present."""
        return cls(band=2e4, width=4e3)
