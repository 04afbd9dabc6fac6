# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rate-independent hysteresis of braid and bladder: a force that depends on the way come from.

Three operators stand side by side, since measured loops are of more than one family; each may
be absent. Over contraction, Bouc and Wen's, whose minor loops drift until the major one closes
them, and Maxwell's slip elements, which close every minor loop and remember all turning points.
Over pressure, Maxwell's slip once more: braid and bladder rub when the muscle is filled or
vented, whether its ends move or not, and the loop is so many Pa wide (Hunt et al. 2017).
"""

from math import exp, expm1, log1p

from pam_ros.compiled import plain, scalar
from pam_ros.effects.base import Compensation, Effect, EffectParameter, HiddenState, Row
from pam_ros.effects.rows import A1, A3, A4, A5
from pam_ros.muscle.law import gain

ELEMENTS = 10
P_REFERENCE = 3e5  # Pa, where the amplitude is as given, whatever its growth


@scalar
def threshold(n: int, onset: float, crowding: float) -> float:
    """Return the threshold of Maxwell element n as a share of the last one's.

    From onset to 1, evenly with crowding 0; the nearer to 1 it is, the more of them are small.
    """
    s = (n + 0.5) / ELEMENTS
    return onset + (1.0 - onset) * s * (1.0 - crowding) / (1.0 - crowding * s)


@scalar
def slipped(
    ds: float, width: float, onset: float, crowding: float, x: Row, i: int, xn: Row
) -> float:
    """Return the mean of Maxwell elements after a way ds, in -1..1; x[i] and on are strains.

    They stick up to their thresholds, the last one's being *width*, and slip there.
    """
    mean = 0.0
    for n in range(ELEMENTS):
        d = width * threshold(n, onset, crowding)
        strain = min(max(x[i + n] + ds, -d), d)
        xn[i + n] = strain
        mean += strain / d
    return mean / ELEMENTS


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
    """Return f - g(p) (A z + B m) - P (dF/dp) n, with z, m, n in -1..1 and exact.

    Bouc-Wen (n = 1) over l = |kappa|/W, u = z sign(dkappa): du/dl = 1 - u on loading, u > 0,
    and 1 - a u on unloading, u < 0. A = q[j], W = q[j + 1], a = q[j + 2]: 1 is Dahl's law, 0
    has elastic unloading. x[i] is z, x[i + 1] kappa, x[i + 2] the pressure before.

    Maxwell slip m over contraction: B = q[j + 3], width q[j + 4], onset q[j + 5], crowding
    q[j + 11]; n over pressure: P = q[j + 7], width q[j + 8], onset q[j + 9], crowding q[j + 12].

    g = 1 + G (p / 300 kPa - 1), G = q[j + 6], not negative.
    """
    if q[j] == 0.0 and q[j + 3] == 0.0 and q[j + 7] == 0.0:
        return f
    ds = kappa - x[i + 1]
    dp = p - x[i + 2]
    xn[i + 1] = kappa
    xn[i + 2] = p
    rub = 0.0
    if q[j] != 0.0:
        side = 1.0 if ds > 0.0 else -1.0
        left = abs(ds) / q[j + 1]
        u = x[i] * side
        if u < 0.0:
            a = max(q[j + 2], 1e-9)
            down = min(left, log1p(-a * u) / a)
            u = u * exp(-a * down) - expm1(-a * down) / a
            left -= down
        if left > 0.0:
            u = 1.0 + (u - 1.0) * exp(-left)
        xn[i] = u * side
        rub = q[j] * xn[i]
    if q[j + 3] != 0.0:
        rub += q[j + 3] * slipped(ds, q[j + 4], q[j + 5], q[j + 11], x, i + 3, xn)
    f -= max(1.0 + q[j + 6] * (p / P_REFERENCE - 1.0), 0.0) * rub
    if q[j + 7] != 0.0:
        late = q[j + 7] * slipped(dp, q[j + 8], q[j + 9], q[j + 12], x, i + 3 + ELEMENTS, xn)
        f -= late * gain(kappa, q[A1], q[A3], q[A4], q[A5])
    return f


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return all loops at the share q[j + 10] of their height: from -1 to 1, 0 in the middle."""
    every, share_of = range(ELEMENTS), plain(threshold)
    slip = [q[j + 10] * q[j + 4] * share_of(n, q[j + 5], q[j + 11]) for n in every]
    over_p = [q[j + 10] * q[j + 8] * share_of(n, q[j + 9], q[j + 12]) for n in every]
    return (q[j + 10], kappa, p, *slip, *over_p)


EFFECT = Effect(
    name='hysteresis',
    text='rate-independent hysteresis of braid and bladder',
    source='Dahl 1968; Wen 1976; Minh et al. 2011 (Maxwell slip); Hunt et al. 2017 (by pressure)',
    parameters=(
        EffectParameter(
            'amplitude',
            0.0,
            'half height of the loop, Bouc-Wen',
            'N',
            0.0,
            1e3,
            scale=10.0,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'width',
            0.01,
            'contraction over which the Bouc-Wen loop approaches its height',
            'fraction',
            5e-4,
            10.0,
            scale=0.01,
        ),
        EffectParameter(
            'unloading',
            1.0,
            'shape of Bouc-Wen unloading: 1 as loading (Dahl), 0 elastic',
            '',
            0.0,
            1.0,
            scale=0.5,
        ),
        EffectParameter(
            'slip',
            0.0,
            'half height of the loop, Maxwell slip',
            'N',
            0.0,
            1e3,
            scale=10.0,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'slip_width',
            0.02,
            'contraction over which the last Maxwell element slips',
            'fraction',
            1.5e-3,
            10.0,
            scale=0.02,
        ),
        EffectParameter(
            'slip_onset',
            0.0,
            'share of it at which the first one slips; 1: all at once',
            '',
            0.0,
            1.0,
            scale=0.3,
        ),
        EffectParameter(
            'pressure_growth',
            0.0,
            'growth of the loop with pressure around 300 kPa; 1: in proportion',
            '',
            -1.0,
            1.0,
            scale=0.5,
        ),
        EffectParameter(
            'pressure',
            0.0,
            'half width of the loop over pressure, Maxwell slip',
            'Pa',
            0.0,
            1e5,
            scale=5e3,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'pressure_width',
            3e4,
            'pressure over which the last of its elements slips',
            'Pa',
            10.0,
            1e6,
            scale=3e4,
        ),
        EffectParameter(
            'pressure_onset',
            0.0,
            'share of it at which the first one slips; 1: all at once',
            '',
            0.0,
            1.0,
            scale=0.3,
        ),
        EffectParameter(
            'initial',
            0.0,
            'where the loops stand at the start; 1: as after a long way up, -1: down',
            '',
            -1.0,
            1.0,
            scale=0.5,
        ),
        EffectParameter(
            'slip_crowding',
            0.0,
            'how far the thresholds crowd at small ways; 0: evenly spread',
            '',
            0.0,
            0.98,
            scale=0.3,
        ),
        EffectParameter(
            'pressure_crowding',
            0.0,
            'how far the thresholds crowd at small ways; 0: evenly spread',
            '',
            0.0,
            0.98,
            scale=0.3,
        ),
    ),
    signature='loops over contraction or pressure whose area does not depend on the speed',
    experiment='slow triangles at two rates with minor loops',
    fit_starts=(
        {'amplitude': 5.0, 'width': 0.003, 'initial': 0.0},
        {'amplitude': 10.0, 'width': 0.03, 'unloading': 0.5, 'initial': 0.0},
        {'slip': 5.0, 'slip_width': 0.01, 'initial': 0.0},
        {'slip': 10.0, 'slip_width': 0.05, 'initial': 0.0},
        {
            'slip': 8.0,
            'slip_width': 0.03,
            'slip_onset': 0.05,
            'slip_crowding': 0.5,
            'initial': 0.0,
        },
        {'pressure': 3e3, 'pressure_width': 1e4, 'initial': 0.0},
        {'pressure': 1e4, 'pressure_width': 5e4, 'initial': 0.0},
        {
            'pressure': 6e3,
            'pressure_width': 5e4,
            'pressure_onset': 0.05,
            'pressure_crowding': 0.5,
            'initial': 0.0,
        },
    ),
    example={'amplitude': 9.0, 'slip': 5.0, 'pressure': 4e3},
    compensation=Compensation.FEED_FORWARD,
    states=(
        HiddenState('loop', '', 0.5),
        HiddenState('contraction', 'fraction'),
        HiddenState('pressure', 'Pa'),
        *(HiddenState(f'strain {n + 1}', 'fraction', 5e-3) for n in range(ELEMENTS)),
        *(HiddenState(f'strain over pressure {n + 1}', 'Pa', 1e4) for n in range(ELEMENTS)),
    ),
    start=start,
    rivals=('coulomb_friction', 'creep'),
    contains={'coulomb_friction': {'level': 'amplitude'}},
    force=force,
    needs_muscle=True,
)
