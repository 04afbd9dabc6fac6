# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rate-independent hysteresis of braid and bladder over pressure: Maxwell slip.

Braid and bladder rub against each other when the muscle is filled or vented, even if its ends do
not move: a muscle of constant length shows this loop as well. Its width is a pressure (Hunt et al.
2017).
"""

from dataclasses import dataclass
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations, HiddenState, Row, Starts
from pam_ros.effects.maxwell_slip import ELEMENTS, EQUATION, EVEN, MOST, slipped, strains
from pam_ros.effects.parameter import effect_parameter, start_from, strength
from pam_ros.effects.rows import A1, A3, A4, A5
from pam_ros.muscle.law import gain

SLIP, SLIP_WIDTH, SLIP_ONSET, SLIP_RATIO, INITIAL = range(5)
LAST_P, STRAINS = range(2)  # hidden states; the strains of the elements follow


def force(
    f: float,
    p: float,
    kappa: float,
    v: float,
    t: float,
    h: float,
    x: Row,
    i: int,
    xn: Row,
    q: Row,
    j: int,
) -> float:
    """Return f - P (dF/dp) n, with n in -1..1 and exact: Maxwell slip over pressure, P = slip."""
    if q[j + SLIP] == 0.0:
        return f
    dp = p - x[i + LAST_P]
    xn[i + LAST_P] = p
    late = q[j + SLIP] * slipped(
        dp, q[j + SLIP_WIDTH], q[j + SLIP_ONSET], q[j + SLIP_RATIO], x, i + STRAINS, xn
    )
    return f - late * gain(kappa, q[A1], q[A3], q[A4], q[A5])


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the loop at the share initial of its height: from -1 to 1, 0 in the middle."""
    slip = strains(q[j + INITIAL], q[j + SLIP_WIDTH], q[j + SLIP_ONSET], q[j + SLIP_RATIO])
    return (p, *slip)


@dataclass(frozen=True)
class PressureHysteresis(Effect):
    """Rate-independent hysteresis of braid and bladder over pressure."""

    slip: float = strength(
        'half width of the loop over pressure, Maxwell slip', 'Pa', high=1e5, scale=5e3
    )
    slip_width: float = effect_parameter(
        3e4,
        'pressure over which the last Maxwell element slips',
        'Pa',
        low=10.0,
        high=1e6,
        scale=3e4,
    )
    slip_onset: float = effect_parameter(
        0.0,
        'share of slip_width at which the first one slips; 1: all at once',
        low=0.0,
        high=1.0,
        scale=0.3,
    )
    slip_ratio: float = effect_parameter(
        EVEN,
        'growth of the gaps between the thresholds; 1: equal gaps, 1/slip_onset: geometric',
        low=EVEN,
        high=MOST,
        scale=10.0,
    )
    initial: float = effect_parameter(
        0.0,
        'state of the loop at the start; 1: as after a long rise of pressure, -1: a fall',
        low=-1.0,
        high=1.0,
        scale=0.5,
    )

    name: ClassVar = 'pressure_hysteresis'
    text: ClassVar = 'rate-independent hysteresis of braid and bladder over pressure'
    source: ClassVar = 'Hunt et al. 2017; Minh et al. 2011 (Maxwell slip)'
    equation: ClassVar = (
        'F = F_in - slip dF/dp m\n'
        f'Maxwell slip over x = p:\n{EQUATION}\n'
        'At the start: e_n / d_n = initial'
    )
    signature: ClassVar = (
        'loops over pressure, also at constant length, whose area does not depend on the speed'
    )
    experiment: ClassVar = 'slow triangles at two rates with minor loops, once at constant length'
    excitation: ClassVar = {'segments': ('slow_triangle', 'fast_triangle'), 'duration': 300.0}
    compensation: ClassVar = Compensation.FEED_FORWARD
    states: ClassVar = (
        HiddenState('pressure', 'Pa'),
        *(HiddenState(f'strain {n + 1}', 'Pa', 1e4) for n in range(ELEMENTS)),
    )
    rivals: ClassVar = ('hysteresis', 'creep', 'pressure_lag')
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(force=force, start=start)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, slip=3e3, slip_width=1e4, initial=0.0),
            start_from(cls, slip=1e4, slip_width=5e4, initial=0.0),
            start_from(
                cls, slip=6e3, slip_width=5e4, slip_onset=0.05, slip_ratio=20.0, initial=0.0
            ),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return it clearly present."""
        return cls(slip=4e3)
