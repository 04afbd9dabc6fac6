# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the controller says of its control."""

import pytest

from pam_ros.control.loop import BLIND, DISABLED, RUNNING, WAITING, Loop
from pam_ros.health.controller import Heard, control, timing
from pam_ros.health.health import Level
from pam_ros.settings.control import build_told, table
from pam_ros.settings.tables import checked
from pam_ros.timing.ticker import Punctuality

WELL = Heard(age=0.01, blindness='', refused=0, refusal='', is_refusal_new=False)
NO_JOINT = 'joint_states has no joint pam'


@pytest.fixture(scope='module')
def told():
    return build_told(checked(table({}), {}))


@pytest.mark.parametrize(
    ('state', 'heard', 'fault', 'level', 'message'),
    [
        (RUNNING, {}, '', Level.OK, 'controlling'),
        (RUNNING, {'refusal': 'too far', 'refused': 1}, '', Level.OK, 'controlling'),
        (RUNNING, {'refusal': 'too far', 'is_refusal_new': True}, '', Level.WARN, 'too far'),
        (RUNNING, {'blindness': NO_JOINT}, '', Level.WARN, NO_JOINT),
        (WAITING, {}, '', Level.WARN, 'waits for joint_states'),
        (
            WAITING,
            {'blindness': NO_JOINT},
            '',
            Level.ERROR,
            f'waits for joint_states: {NO_JOINT}',
        ),
        (BLIND, {}, '', Level.ERROR, 'joint_states stay away: vents'),
        (DISABLED, {}, '', Level.OK, 'disabled: commands nothing'),
        (DISABLED, {}, 'the law gave no number', Level.ERROR, 'the law gave no number'),
    ],
)
def test_the_worst_of_the_control_is_said(told, state, heard, fault, level, message):
    loop = Loop(told.make_law(), told.make_course(), 0.002)
    loop.state = state
    health = control(loop, told, WELL._replace(**heard), fault)
    assert (health.level, health.message) == (level, message)
    assert (health.values['error (m)'] is None) == (state != RUNNING)
    assert health.values['last reason'] == heard.get('refusal', '')


@pytest.mark.parametrize(
    ('ticks', 'wanted', 'level', 'message'),
    [
        (1000, 500.0, Level.OK, 'keeps its rate'),
        (900, 500.0, Level.WARN, 'runs at 450.0 Hz instead of 500'),
        (40, None, Level.OK, 'answers each joint state (use_sim_time is set)'),
    ],
)
def test_the_rate_is_said_where_there_is_one(ticks, wanted, level, message):
    health = timing(Punctuality(2.0, ticks, 0, 0.0), 10, wanted)
    assert (health.level, health.message) == (level, message)
    assert health.values['command rate (Hz)'] == 5.0
