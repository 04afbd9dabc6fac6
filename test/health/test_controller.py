# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the controller says of its control."""

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.signal import impulse

from pam_ros.control.gains import Gains
from pam_ros.control.loop import BLIND, DISABLED, RUNNING, WAITING, Loop
from pam_ros.control.plausibility import Plausibility, bounds_of
from pam_ros.health.controller import Received, control, timing
from pam_ros.health.health import Level
from pam_ros.settings.control import settings_of
from pam_ros.settings.tables import checked
from pam_ros.timing.ticker import Punctuality

WELL = Received(age=0.01)
NO_JOINT = 'joint_states has no joint pam'
PAUSE = 'no command was given for 2.00 s, longer than command_timeout (1 s)'
FALSE = 'joint_states has a position -1 m, which is beyond the travel of the joint'
DELAYED = '20 of 100 joint_states were late according to their stamps, by up to 0.21 s'
LASTS = 'the command is at a limit of pressure for more than 3 s'


def setup_of(**given):
    table, build = settings_of(given)
    return build(checked(table, given))


def loop_of(made):
    law = made.law.make_law()
    return Loop(
        law, made.law.make_reference_source(), 0.002, Plausibility(bounds_of(law.allocation))
    )


@pytest.fixture(scope='module')
def made():
    return setup_of()


@pytest.mark.parametrize(
    ('state', 'received', 'fault', 'level', 'message'),
    [
        (RUNNING, {}, '', Level.OK, 'controlling'),
        (RUNNING, {'refusal': 'too far', 'refused': 1}, '', Level.OK, 'controlling'),
        (RUNNING, {'refusal': 'too far', 'is_refusal_new': True}, '', Level.WARN, 'too far'),
        (RUNNING, {'blindness': NO_JOINT}, '', Level.WARN, NO_JOINT),
        (RUNNING, {'pause': PAUSE, 'pauses': 1}, '', Level.OK, 'controlling'),
        (RUNNING, {'pause': PAUSE, 'is_pause_new': True}, '', Level.WARN, PAUSE),
        (RUNNING, {'implausibility': FALSE}, '', Level.OK, 'controlling'),
        (
            RUNNING,
            {'implausibility': FALSE, 'is_implausibility_new': True},
            '',
            Level.WARN,
            FALSE,
        ),
        (RUNNING, {'tracking': LASTS}, '', Level.WARN, LASTS),
        (RUNNING, {'delay': DELAYED}, '', Level.WARN, DELAYED),
        (RUNNING, {'tracking': LASTS, 'delay': DELAYED}, '', Level.WARN, LASTS),
        (RUNNING, {'tracking': LASTS, 'blindness': NO_JOINT}, '', Level.WARN, NO_JOINT),
        (WAITING, {'tracking': LASTS}, '', Level.WARN, 'waits for joint_states'),
        (WAITING, {}, '', Level.WARN, 'waits for joint_states'),
        (
            WAITING,
            {'blindness': NO_JOINT},
            '',
            Level.ERROR,
            f'waits for joint_states: {NO_JOINT}',
        ),
        (BLIND, {}, '', Level.ERROR, 'joint_states has stopped: vents'),
        (DISABLED, {}, '', Level.OK, 'disabled: sends no commands'),
        (
            DISABLED,
            {},
            'the law gave a pressure that is not finite',
            Level.ERROR,
            'the law gave a pressure that is not finite',
        ),
    ],
)
def test_the_worst_of_the_control_is_reported(made, state, received, fault, level, message):
    loop = loop_of(made)
    loop.state = state
    health = control(loop, made, WELL._replace(**received), fault)
    assert (health.level, health.message) == (level, message)
    assert (health.values['error (m)'] is None) == (state != RUNNING)
    assert health.values['last reason'] == received.get('refusal', '')


@pytest.mark.parametrize(
    ('ticks', 'wanted', 'level', 'message'),
    [
        (1000, 500.0, Level.OK, 'keeps its rate'),
        (900, 500.0, Level.WARN, 'runs at 450.0 Hz instead of 500'),
        (40, None, Level.OK, 'answers each joint state (use_sim_time is set)'),
    ],
)
def test_the_rate_is_reported_if_there_is_one(ticks, wanted, level, message):
    health = timing(Punctuality(2.0, ticks, 0, 0.0), 10, wanted)
    assert (health.level, health.message) == (level, message)
    assert health.values['command rate (Hz)'] == 5.0


# What it says of the joint -----------------------------------------------------------------------

LEFT = 'configured, without feedforward'


def values_of(**given):
    now = setup_of(**given)
    loop = loop_of(now)
    loop.state = RUNNING
    return control(loop, now, WELL, '').values


def test_configured_effects_that_nothing_compensates_ahead_are_named():
    assert LEFT not in values_of()
    compensated = {'effects.pressure_lag.fill': 0.05, 'effects.coulomb_friction.level': 5.0}
    assert LEFT not in values_of(**compensated)
    assert values_of(**{**compensated, 'effects.leak.rate': 0.1})[LEFT] == 'leak'
    stop = {'effects.end_stop.stiffness': 1e4, 'effects.end_stop.upper': 0.09}
    assert values_of(**stop, **{'effects.leak.rate': 0.1})[LEFT] == 'leak, end_stop'


@pytest.mark.parametrize('kind', ['antagonistic', 'parallel'])
def test_they_are_named_of_joints_of_several_muscles_too(kind):
    one = {'joint': kind, 'muscles': ('first', 'second'), 'second.effects.leak.rate': 0.1}
    assert values_of(**one)[LEFT] == 'leak'
    assert LEFT not in values_of(joint=kind)


def test_a_pair_reports_its_stiffness_and_a_parallel_joint_has_none_to_choose():
    values = values_of(joint='antagonistic')
    low, high = (values[f'{which} co-contraction (N m/rad)'] for which in ('lowest', 'highest'))
    assert low < high
    assert values['error (rad)'] == 0.0
    assert 'co-contraction (N m/rad)' in values
    assert not [name for name in values_of(joint='parallel') if 'co-contraction' in name]


def test_commands_are_a_number_of_one_muscle_and_all_of_several():
    for given, commands in (({}, (2e5,)), ({'joint': 'antagonistic'}, (2e5, 1e5))):
        now = setup_of(**given)
        loop = loop_of(now)
        assert control(loop, now, WELL, '').values['command (Pa)'] is None
        loop.pressures = commands
        shown = control(loop, now, WELL, '').values['command (Pa)']
        assert shown == (commands if len(commands) > 1 else commands[0])


def test_the_bounds_of_the_surface_are_shown():
    values = values_of(mass=20.0)
    width = 200.0 / (20.0 * 14.0)
    assert values['half width of the boundary layer (m/s)'] == pytest.approx(width)
    gains = Gains()
    z, w = gains.surface_damping, gains.surface_bandwidth
    t = np.linspace(0.0, 40.0 / (z * w), 400_001)
    _, answer = impulse(([1.0, 0.0], [1.0, 2.0 * z * w, w * w]), T=t)
    area = trapezoid(np.abs(answer), t)
    bound = 'largest error within the disturbance bound (m)'
    assert values[bound] == pytest.approx(width * area, rel=1e-3)


def test_the_levels_of_rejection_are_shown():
    values = values_of(mass=20.0)
    assert values['rejection level'] == 0.0
    assert values['highest rejection level'] == 0.0  # no step was made
    assert values['share of the feedback gains'] == 1.0


def test_pid_has_neither():
    values = values_of(controller='pid')
    assert not {'rejection level', 'largest error within the disturbance bound (m)'} & {*values}


@pytest.mark.parametrize(('share', 'level'), [(0.7, Level.OK), (0.34, Level.WARN)])
def test_a_loop_that_oscillated_is_a_warning_while_its_gains_are_low(made, share, level):
    loop = loop_of(made)
    loop.state = RUNNING
    loop.law.terms.feedback = share
    shown = control(loop, made, WELL, '')
    assert shown.level == level
    assert shown.values['share of the feedback gains'] == share
    if level == Level.WARN:
        assert '34% of the feedback gains' in shown.message
