# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the simulator says of its rate."""

import pytest

from pam_ros.health.health import Level
from pam_ros.health.simulator import RunProgress, timing
from pam_ros.settings.sim import SimSettings
from pam_ros.timing.ticker import Punctuality

KEPT = Punctuality(span=2.0, ticks=1000, overruns=3, worst=0.004)
DONE = RunProgress(
    published=1000,
    speed=1.0,
    time=12.5,
    lost=0.0,
    jumps=0,
    is_paused=False,
    follows_clock=False,
    has_clock=True,
    waits='',
    fault='',
)
BEHIND = {'published': 900}


@pytest.mark.parametrize(
    ('mode', 'done', 'level', 'message'),
    [
        ('real_time', {}, Level.OK, 'keeps its rate'),
        ('real_time', BEHIND, Level.WARN, 'publishes at 450.0 Hz instead of 500'),
        ('real_time', {**BEHIND, 'follows_clock': True}, Level.OK, 'keeps its rate'),
        (
            'real_time',
            {'follows_clock': True, 'has_clock': False, 'is_paused': True},
            Level.WARN,
            'waits for /clock (use_sim_time is set)',
        ),
        ('real_time', {**BEHIND, 'is_paused': True}, Level.OK, 'paused'),
        ('real_time', {'fault': 'lost', 'is_paused': True}, Level.ERROR, 'lost'),
        ('scaled', {'speed': 2.0}, Level.WARN, 'publishes at 500.0 Hz instead of 1000'),
        ('scaled', {'speed': 0.0}, Level.OK, 'as fast as possible'),
        ('lockstep', {'speed': 0.0}, Level.OK, 'in lockstep'),
        ('lockstep', {'speed': 0.0, 'waits': 'nobody'}, Level.WARN, 'nobody'),
    ],
)
def test_the_worst_of_the_rate_is_reported(mode, done, level, message):
    health = timing(SimSettings(time_mode=mode), KEPT, DONE._replace(**done), 'normal')
    assert (health.level, health.message) == (level, message)
    assert ('speed (simulated s / s)' in health.values) == (mode != 'real_time')
    assert health.values['overruns'] == 3
