# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Slack: a muscle pulls and never pushes."""

from pam_ros.effects.base import Effect, EffectParameter, Row


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
    """Return max(f, 0), rounded off by a parabola for |f| < w, the toe q[j] in N."""
    w = q[j]
    if w == 0.0 or f >= w:
        return f
    if f <= -w:
        return 0.0
    return (f + w) * (f + w) / (4.0 * w)


EFFECT = Effect(
    name='slack',
    text='no push: below its threshold pressure a shortened muscle goes slack',
    source='Tension-only tendon with a toe; threshold pressure of the bladder, Martens 2017',
    parameters=(
        EffectParameter(
            'toe',
            0.0,
            'force around 0 over which the pull sets in; 1 N or less for a sharp onset',
            'N',
            0.0,
            500.0,
            scale=10.0,
            strength=True,
            sign=1,
        ),
    ),
    signature='residual only where the model would push: high contraction, low pressure',
    experiment='vent the muscle at held lengths beyond 10 % contraction with a force cell',
    fit_starts=({'toe': 2.0}, {'toe': 30.0}),
    rivals=('end_stop',),
    force=force,
)
