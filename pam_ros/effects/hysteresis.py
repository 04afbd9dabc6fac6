# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rate-independent hysteresis of braid and bladder over contraction.

The loop is one of force over contraction: a muscle of constant length does not show it. There are
two operators, since measured loops have different shapes, and each of them may be absent. Minor
loops of Dahl's operator, which is that of Bouc and Wen with equal loading and unloading, drift
until they reach the major loop. With Maxwell's slip elements every minor loop is closed, and all
turning points are stored.
"""

from dataclasses import dataclass
from math import exp
from typing import ClassVar

from pam_ros.effects.base import Compensation, Effect, EffectEquations, HiddenState, Row, Starts
from pam_ros.effects.maxwell_slip import ELEMENTS, EQUATION, EVEN, MOST, slipped, strains
from pam_ros.effects.parameter import effect_parameter, start_from, strength

AMPLITUDE, WIDTH, SLIP, SLIP_WIDTH, SLIP_ONSET, SLIP_RATIO, INITIAL = range(7)

# Hidden states; the strains of the elements follow.
LOOP, LAST_KAPPA, STRAINS = range(3)


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
    """Return f - (A z + B m), with z and m in -1..1, integrated exactly.

    Dahl: over l = |kappa|/W, u = z sign(dkappa) follows du/dl = 1 - u. A is the amplitude, W the
    width. m is Maxwell slip, of height B = slip.
    """
    if q[j + AMPLITUDE] == 0.0 and q[j + SLIP] == 0.0:
        return f
    ds = kappa - x[i + LAST_KAPPA]
    xn[i + LAST_KAPPA] = kappa
    rub = 0.0
    if q[j + AMPLITUDE] != 0.0:
        side = 1.0 if ds > 0.0 else -1.0
        xn[i + LOOP] = side + (x[i + LOOP] - side) * exp(-abs(ds) / q[j + WIDTH])
        rub = q[j + AMPLITUDE] * xn[i + LOOP]
    if q[j + SLIP] != 0.0:
        rub += q[j + SLIP] * slipped(
            ds, q[j + SLIP_WIDTH], q[j + SLIP_ONSET], q[j + SLIP_RATIO], x, i + STRAINS, xn
        )
    return f - rub


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the state in which all loops are at the share *initial*, -1 to 1, of their height."""
    initial = q[j + INITIAL]
    slip = strains(initial, q[j + SLIP_WIDTH], q[j + SLIP_ONSET], q[j + SLIP_RATIO])
    return (initial, kappa, *slip)


@dataclass(frozen=True)
class Hysteresis(Effect):
    """Rate-independent hysteresis of braid and bladder over contraction."""

    amplitude: float = strength('half height of the loop, Dahl', 'N', high=1e3, scale=10.0)
    width: float = effect_parameter(
        0.01,
        'contraction over which the loop of Dahl approaches its height',
        'fraction',
        low=5e-4,
        high=10.0,
        scale=0.01,
    )
    slip: float = strength('half height of the loop, Maxwell slip', 'N', high=1e3, scale=10.0)
    slip_width: float = effect_parameter(
        0.02,
        'contraction over which the last Maxwell element slips',
        'fraction',
        low=1.5e-3,
        high=10.0,
        scale=0.02,
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
        'state of the loops at the start; 1: as after a long motion up, -1: down',
        low=-1.0,
        high=1.0,
        scale=0.5,
    )

    name: ClassVar = 'hysteresis'
    text: ClassVar = 'rate-independent hysteresis of braid and bladder over contraction'
    source: ClassVar = 'Dahl 1968; Minh et al. 2011 (Maxwell slip)'
    equation: ClassVar = (
        'F = F_in - (amplitude z + slip m)\n'
        'Dahl, with s = sign(dκ/dt):\n'
        '  dz/dκ = (1 - s z) / width\n'
        f'Maxwell slip over x = κ:\n{EQUATION}\n'
        'At the start: z = e_n / d_n = initial'
    )
    signature: ClassVar = 'loops over contraction whose area does not depend on the speed'
    experiment: ClassVar = 'slow triangles at two rates with minor loops'
    excitation: ClassVar = {'segments': ('slow_triangle', 'fast_triangle'), 'duration': 300.0}
    compensation: ClassVar = Compensation.FEED_FORWARD
    states: ClassVar = (
        HiddenState('loop', '', 0.5),
        HiddenState('contraction', 'fraction'),
        *(HiddenState(f'strain {n + 1}', 'fraction', 5e-3) for n in range(ELEMENTS)),
    )
    rivals: ClassVar = ('coulomb_friction', 'pressure_hysteresis', 'creep')
    contains: ClassVar = {'coulomb_friction': {'level': 'amplitude'}}
    needs_muscle: ClassVar = True
    equations: ClassVar = EffectEquations(force=force, start=start)

    @classmethod
    def fit_starts(cls) -> Starts:
        """Return the values from which a fit begins."""
        return (
            start_from(cls, amplitude=5.0, width=0.003, initial=0.0),
            start_from(cls, amplitude=10.0, width=0.03, initial=0.0),
            start_from(cls, slip=5.0, slip_width=0.01, initial=0.0),
            start_from(cls, slip=10.0, slip_width=0.05, initial=0.0),
            start_from(
                cls, slip=8.0, slip_width=0.03, slip_onset=0.05, slip_ratio=20.0, initial=0.0
            ),
        )

    @classmethod
    def example(cls) -> Effect:
        """Return a hysteresis that is clearly visible."""
        return cls(amplitude=9.0, slip=5.0)
