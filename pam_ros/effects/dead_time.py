# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Dead time: the pressure answers a command only after a while."""

from pam_ros.effects.base import Compensation, Effect, EffectParameter, Row


def delay(q: Row, j: int) -> float:
    """Return the delay q[j] in s."""
    return q[j]


EFFECT = Effect(
    name='dead_time',
    text='transport delay between command and pressure',
    source='Wave travel in the tube, switching time of the valve, computing time',
    parameters=(
        EffectParameter(
            'delay',
            0.0,
            'time by which commands act late',
            's',
            0.0,
            1.0,
            scale=0.01,
            strength=True,
            sign=1,
        ),
    ),
    signature='phase that falls in proportion to frequency; nothing moves after a step for a time',
    experiment='steps recorded at 500 Hz or more, or a chirp up to the corner of the lag',
    fit_starts=({'delay': 0.005}, {'delay': 0.02}, {'delay': 0.05}),
    example={'delay': 0.0153},
    compensation=Compensation.PATH,
    rivals=('pressure_lag',),
    delay=delay,
)
