# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a running loop reports, on a clock that the test sets."""

import logging

import pytest

from pam_ros.control.loop import BLIND, RUNNING, WAITING
from pam_ros.health.health import Level
from pam_ros.health.loop_health import LoopHealth
from pam_ros.health.reports import Reports
from pam_ros.settings.control import settings_of
from pam_ros.settings.tables import checked
from pam_ros.timing.loop_pacing import OneStepPerState, OwnRate
from pam_ros.timing.pace import SECOND
from pam_ros.timing.ticker import Punctuality
from support.steady import Steady

SECONDS = 2.0


@pytest.fixture(scope='module')
def made():
    table, build = settings_of({})
    return build(checked(table, {}))


@pytest.fixture
def wall():
    return Steady()


def health_of(made, wall, kind=OwnRate, state=RUNNING):
    loop = made.law.make_loop()
    loop.state = state
    pacing = kind(made.settings, wall, wall)
    reports = Reports(logging.getLogger('test'))
    return LoopHealth(loop, lambda: made, pacing, reports), loop, pacing


@pytest.mark.parametrize('kind', [OwnRate, OneStepPerState])
def test_commands_are_counted_since_the_last_report(made, wall, kind):
    health, _, _ = health_of(made, wall, kind)
    for _ in range(5):
        health.count_command()
    kept = Punctuality(SECONDS, round(SECONDS * made.settings.rate), 0, 0.0)
    values = [health.timing(kept).values for _ in range(2)]
    assert [one['command rate (Hz)'] for one in values] == [5 / SECONDS, 0.0]
    wanted = made.settings.rate if kind is OwnRate else None
    assert values[0]['wanted rate (Hz)'] == wanted


def test_a_stamp_that_lasts_is_the_reason_unless_there_is_a_better_one(made, wall):
    health, _, pacing = health_of(made, wall, state=BLIND)
    assert health.trouble() == 'joint_states has stopped: vents'
    pacing.use(pacing.arrive(3 * SECOND))
    wall.now += SECOND
    pacing.arrive(3 * SECOND)
    assert health.trouble().endswith(': vents: joint_states repeats the stamp 3.000 s: not used')
    health.blindness = 'joint_states has no joint pam'
    assert health.trouble() == 'joint_states has stopped: vents: joint_states has no joint pam'


def test_a_state_that_is_later_than_the_timeout_is_not_usable(made, wall):
    health, _, _ = health_of(made, wall, state=WAITING)
    health.note_lateness(made.settings.state_timeout)
    assert health.trouble() == 'waits for joint_states'
    late = 2.0 * made.settings.state_timeout
    health.note_lateness(late)
    assert f'arrives {late:.2f} s late' in health.trouble()
    assert health.control().values['late joint_states'] == 2


def test_the_age_of_the_states_and_the_fault_of_the_law_are_reported(made, wall):
    health, loop, pacing = health_of(made, wall)
    pacing.use(pacing.arrive(0))
    wall.now += SECOND // 2
    assert health.control().values['age of joint_states (s)'] == 0.5
    loop.enable(False)
    health.fault = 'the law gave a pressure that is not finite: disabled'
    assert (health.control().level, health.trouble()) == (Level.ERROR, health.fault)


def test_lost_states_are_logged_once_and_so_is_their_return(made, wall, caplog):
    health, loop, _ = health_of(made, wall, state=BLIND)
    caplog.set_level(logging.INFO)
    loop.timeout = 0.0
    for state in BLIND, BLIND, RUNNING, RUNNING:
        loop.state = state
        health.control()
    assert [record.message for record in caplog.records] == [
        'joint_states has stopped: vents',
        'joint_states are received again: control continues',
    ]


def test_an_error_that_lasts_is_reported(made, wall, caplog):
    health, loop, _ = health_of(made, wall)
    loop.law.terms.error = 0.5  # m
    for second in range(8):
        loop.time = float(second)
        health.record_step()
    assert health.control().level is Level.WARN
    assert 'the error is larger than' in caplog.text
