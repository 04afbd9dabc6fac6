# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Dead band: below a threshold of the pressure, bladder or valve do nothing.

What a muscle with this effect has as its pressure is what acts on its braid, which a sensor in the
chamber does not see where the bladder has the threshold.
"""

from pam_ros.compiled import scalar
from pam_ros.effects.base import Compensation, Effect, EffectParameter, Row


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
    """Return what of the pressure p in Pa is beyond the band q[j].

    The corner is q[j + 1] wide, but no wider than the band: no pressure stays none.
    """
    if q[j] == 0.0:
        return p
    return beyond(p, q[j], min(q[j + 1], q[j]))


EFFECT = Effect(
    name='dead_band',
    text='threshold of the pressure, below which the bladder or the valve does nothing',
    source='Klute and Hannaford 2000 (bladder inside the braid); valves with overlap',
    parameters=(
        EffectParameter(
            'band',
            0.0,
            'pressure up to which nothing happens',
            'Pa',
            0.0,
            2e5,
            scale=2e4,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'width',
            2e3,
            'pressure on either side of the corner over which the effect sets in',
            'Pa',
            1.0,
            1e5,
            scale=5e3,
        ),
    ),
    signature='residual that grows up to the threshold, and is then constant',
    experiment='slow ramps from no pressure up, at two loads',
    fit_starts=({'band': 1e4}, {'band': 5e4}, {'band': 3e4, 'width': 1e4}),
    example={'band': 2e4, 'width': 4e3},
    compensation=Compensation.PATH,
    rivals=('pressure_offset', 'slack'),
    # Where the pressure always stays beyond the band.
    contains={'pressure_offset': {'offset': 'band'}},
    pressure=pressure,
)
