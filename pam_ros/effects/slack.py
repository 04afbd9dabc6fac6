# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Slack: a muscle pulls, but cannot push, or only until it buckles."""

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
    """Return max(f, -b), the corner rounded off by a parabola over w around it.

    w = q[j] is the toe, b = q[j + 1] the push at which the muscle buckles, both in N.
    """
    w = q[j]
    above = f + q[j + 1]
    if w == 0.0 or above >= w:
        return f
    if above <= -w:
        return -q[j + 1]
    return (above + w) * (above + w) / (4.0 * w) - q[j + 1]


EFFECT = Effect(
    name='slack',
    text='no push: below its threshold pressure a shortened muscle goes slack',
    source='Tension-only tendon with a toe; threshold pressure: Martens & Boblan 2017',
    parameters=(
        EffectParameter(
            'toe',
            0.0,
            'force on either side of the corner over which the pull sets in; 1 for a sharp one',
            'N',
            0.0,
            500.0,
            scale=10.0,
            strength=True,
            sign=1,
        ),
        EffectParameter(
            'push', 0.0, 'push at which the slack muscle buckles', 'N', 0.0, 500.0, scale=5.0
        ),
    ),
    signature='residual only where the model would push: high contraction, low pressure',
    experiment='vent the muscle at held lengths beyond 10 % contraction with a force cell',
    fit_starts=({'toe': 2.0}, {'toe': 30.0}, {'toe': 30.0, 'push': 10.0}),
    rivals=('end_stop',),
    force=force,
)
