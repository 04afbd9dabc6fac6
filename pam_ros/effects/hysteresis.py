# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rate-independent hysteresis of braid and bladder: a force that depends on the way come from.

Two operators stand side by side, since measured loops are of two families. Bouc and Wen's has
minor loops that drift until they are closed by the major one; Maxwell's slip elements close
every minor loop and remember all turning points. Either may be absent. Both are driven by

    s = kappa + C p,

so that a muscle held at its length, too, shows the loop that is measured when it is filled and
vented: braid and bladder rub when the pressure changes, whether the ends move or not.
"""

from math import exp, expm1, log1p

from pam_ros.effects.base import Effect, EffectParameter, Row

ELEMENTS = 6
P_REFERENCE = 3e5  # Pa, where the amplitude is as given, whatever its growth


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
    """Return f - g(p) (A z + B m), z and m in -1..1, exact for any monotone way of s.

    Bouc-Wen (n = 1) over l = |s|/W, u = z sign(ds): du/dl = 1 - u on loading, u > 0, and
    1 - a u on unloading, u < 0. A = q[j], W = q[j + 1], a = q[j + 2]: 1 is Dahl's law, 0 has
    elastic unloading. x[i] is z.

    Maxwell slip: the mean of elements that stick up to thresholds from r D to D and slip there.
    B = q[j + 3], D = q[j + 4], r = q[j + 5]; r = 1 is a single element. x[i + 2] and on are
    their strains.

    g = 1 + G (p / 300 kPa - 1), G = q[j + 6], not negative. C = q[j + 7]. x[i + 1] is s.
    """
    if q[j] == 0.0 and q[j + 3] == 0.0:
        return f
    s = kappa + q[j + 7] * p
    ds = s - x[i + 1]
    xn[i + 1] = s
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
        mean = 0.0
        for n in range(ELEMENTS):
            d = q[j + 4] * (q[j + 5] + (1.0 - q[j + 5]) * (n + 0.5) / ELEMENTS)
            strain = min(max(x[i + 2 + n] + ds, -d), d)
            xn[i + 2 + n] = strain
            mean += strain / d
        rub += q[j + 3] * mean / ELEMENTS
    return f - max(1.0 + q[j + 6] * (p / P_REFERENCE - 1.0), 0.0) * rub


def start(q: Row, j: int, p: float, kappa: float, y: float) -> tuple[float, ...]:
    """Return the middle of all loops."""
    return (0.0, kappa + q[j + 7] * p) + ELEMENTS * (0.0,)


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
            1e-5,
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
            1e-5,
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
            'pressure_share',
            0.0,
            'contraction that a change of pressure counts for, at held length too',
            '1/Pa',
            0.0,
            1e-4,
            scale=5e-7,
        ),
    ),
    signature='loops over contraction or pressure whose area does not depend on the speed',
    experiment='slow triangles at two rates with minor loops',
    fit_starts=(
        {'amplitude': 5.0, 'width': 0.003},
        {'amplitude': 10.0, 'width': 0.03, 'unloading': 0.5},
        {'slip': 5.0, 'slip_width': 0.01},
        {'slip': 10.0, 'slip_width': 0.05, 'slip_onset': 0.2},
        {'amplitude': 10.0, 'pressure_share': 3e-7},
        {'amplitude': 20.0, 'pressure_share': 3e-8},
    ),
    states=('loop', 'path', *(f'strain {n + 1}' for n in range(ELEMENTS))),
    start=start,
    rivals=('coulomb_friction', 'creep'),
    force=force,
)
