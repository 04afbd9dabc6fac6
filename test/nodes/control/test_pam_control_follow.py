# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The action of ``pam_control`` over DDS, with messages that are built from source."""

import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from std_msgs.msg import Float64
from std_srvs.srv import SetBool

import support
from support.control_watch import LOSE_NO_TERMS, Watch, stamp
from support.harness import Program
from support.interfaces import built

CLIENT = Path(support.__path__[0]) / 'follow_client.py'
DEADLINE = 300.0  # s; bounds how long a broken program may hang a test
# A busy machine may stop a program for a while, which must not end a goal.
AWAY = {'command_timeout': 60.0}
RIG = {'initial.pressure': 300e3, **AWAY}
LOCKSTEP = {**RIG, 'time_mode': 'lockstep'}
FOLLOWING = {'use_sim_time': True, 'state_rate': 500.0, **LOSE_NO_TERMS}
PATIENT = {'state_timeout': 60.0, 'state_rate': 500.0, **AWAY}
SUCCESSFUL, INVALID_GOAL, OFF_PATH, MISSED = 0, -1, -4, -5
WAY = 0.01  # m
LONG = 60.0  # s that a goal lasts which is ended before
pytestmark = pytest.mark.at_any_pace


@pytest.fixture(scope='module')
def messages(tmp_path_factory):
    return built('control_msgs', tmp_path_factory)


@pytest.fixture
def watch(peer, messages, monkeypatch):
    """Return what watches the controller; programs find the messages of the action."""
    for name, value in messages.items():
        monkeypatch.setenv(name, value)
    return Watch(peer)


def client(*goals):
    """Return the client of these goals, which runs."""
    program = subprocess.Popen(
        [sys.executable, CLIENT],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    program.stdin.write(json.dumps(goals) + '\n')
    program.stdin.flush()
    return program


def ended(program):
    """Return what became of each goal of a client."""
    out, errors = program.communicate(timeout=DEADLINE)
    assert program.returncode == 0, errors
    return [json.loads(line) for line in out.splitlines()]


def catch_up(watch):
    """Receive what was published while the test waited for a client."""
    now = time.time()
    watch.peer.until(lambda: stamp(watch.terms[-1]) > now, 'the terms of now')


def there_and_back(begin, seconds):
    """Return points that move from *begin* by WAY and back, and rest at both ends."""
    return [[0.5 * seconds, begin + WAY, 0.0], [seconds, begin, 0.0]]


def test_a_goal_is_reached_with_feedback(watch):
    with Program('pam_sim', parameters=LOCKSTEP), Program('pam_control', parameters=FOLLOWING):
        begin = watch.begin()
        goal = {'points': [[2.0, begin + WAY, 0.0]], 'path': [1e-3], 'end': [1e-4, 1e-3]}
        (found,) = ended(client({**goal, 'goal_time_tolerance': 5.0}))
        assert (found['accepted'], found['status']) == (True, GoalStatus.STATUS_SUCCEEDED)
        assert found['code'] == SUCCESSFUL
        assert 'reached' in found['text']
        assert found['joints'] == [['pam']]
        feedback = np.array(found['feedback'])  # (messages, 3, time and position and velocity)
        desired, actual, error = np.moveaxis(feedback, 1, 0)
        np.testing.assert_allclose(error[:, 1:], desired[:, 1:] - actual[:, 1:], atol=1e-12)
        np.testing.assert_allclose(np.diff(desired[:, 0]), 0.05, atol=3e-3)
        s = desired[:, 0] / 2.0
        np.testing.assert_allclose(desired[:, 1], begin + WAY * s * s * (3.0 - 2.0 * s), atol=1e-9)
        np.testing.assert_allclose(
            desired[:, 2], WAY * 6.0 * s * (1.0 - s) / 2.0, rtol=1e-6, atol=1e-9
        )
        assert np.abs(error[:, 1]).max() < 2e-4
        assert np.abs(error[:, 2]).max() < 5e-3


def test_the_first_command_may_be_a_goal(watch):
    # Without pressure the load rests below the lowest position at which it can be held.
    vented = {**LOCKSTEP, 'initial.pressure': 0.0}
    with Program('pam_sim', parameters=vented), Program('pam_control', parameters=FOLLOWING):
        begin = watch.begin()
        assert begin < -5e-3
        goal = {'points': [[0.0, begin, 0.0], [2.0, 0.07, 0.0]], 'end': [1e-4]}
        (found,) = ended(client({**goal, 'goal_time_tolerance': 5.0}))
        assert (found['code'], found['text'][:7]) == (SUCCESSFUL, 'reached'), found['text']
        actual = np.array(found['feedback'])[:, 1]
        assert actual[0, 1] < 0.0
        assert actual[-1, 1] == pytest.approx(0.07, abs=1e-3)


@pytest.mark.parametrize(
    ('tolerances', 'code', 'words'),
    [
        ({'path': [1e-7]}, OFF_PATH, 'the error of the position is'),
        ({'path': [0.0, 1e-7]}, OFF_PATH, 'the error of the velocity is'),
        ({'end': [1e-12], 'goal_time_tolerance': 0.02}, MISSED, 'after the end of the trajectory'),
    ],
)
def test_a_violated_tolerance_ends_a_goal(watch, tolerances, code, words):
    with Program('pam_sim', parameters=RIG), Program('pam_control', parameters=PATIENT):
        begin = watch.begin()
        (found,) = ended(client({'points': [[1.0, begin + WAY, 0.0]], **tolerances}))
        assert (found['status'], found['code']) == (GoalStatus.STATUS_ABORTED, code)
        assert words in found['text']
        # Where the tolerance of the path is violated, the joint stops.
        catch_up(watch)
        end = watch.rests('reference')
        assert (end == pytest.approx(begin + WAY, abs=1e-9)) == (code == MISSED)


def test_a_cancelled_goal_lets_the_joint_rest(watch):
    with Program('pam_sim', parameters=RIG), Program('pam_control', parameters=PATIENT):
        begin = watch.begin()
        slow = {'points': [[LONG, begin + WAY, 0.0]], 'patience': 5}
        cancelled, reached = ended(client(slow, {'points': there_and_back(begin, 1.0)}))
        assert cancelled['status'] == GoalStatus.STATUS_CANCELED
        assert 'comes to rest' in cancelled['text']
        at = cancelled['feedback'][-1][1][1]
        assert begin < at < begin + 0.9 * WAY
        assert reached['status'] == GoalStatus.STATUS_SUCCEEDED


def test_another_target_replaces_a_goal(watch):
    with Program('pam_sim', parameters=RIG), Program('pam_control', parameters=PATIENT):
        begin = watch.begin()
        first = {'points': there_and_back(begin, LONG), 'patience': 3, 'is_replaced': True}
        replaced, reached = ended(client(first, {'points': there_and_back(begin, 1.0)}))
        assert replaced['status'] == GoalStatus.STATUS_ABORTED
        assert replaced['text'] == 'replaced by another goal'
        assert reached['status'] == GoalStatus.STATUS_SUCCEEDED
        for replace, text in (
            (lambda: watch.refer(begin), 'replaced by another target'),
            (
                lambda: watch.peer.call(SetBool, 'pam_control/enable', data=False),
                'control ended: disabled',
            ),
        ):
            catch_up(watch)
            watch.peer.work(1.0)  # the reference passes the start once before it comes to rest
            watch.peer.until(lambda: watch.latest('reference') < begin + 1e-6, 'rest')
            running = client({'points': there_and_back(begin, LONG)})
            watch.peer.until(
                lambda: watch.latest('reference') > begin + 1e-4 or running.poll() is not None,  # noqa: B023
                'its motion',
            )
            replace()
            (found,) = ended(running)
            assert (found['status'], found['code']) == (GoalStatus.STATUS_ABORTED, INVALID_GOAL)
            assert text in found['text']


def test_goals_that_cannot_be_are_rejected_with_the_reason(watch):
    with (
        Program('pam_sim', parameters=RIG),
        Program('pam_control', parameters={**PATIENT, 'controller': 'pid'}) as control,
    ):
        begin = watch.begin()
        good = {'points': there_and_back(begin, 1.0)}
        bad = {
            'not for joint pam (joint_name), but elbow': {'joint': 'elbow'},
            'out of reach': {'points': [[1.0, 0.3]]},
            'without points': {'points': []},
            'is at 0.5 s: times must begin at 0': {'points': [[1.0, begin], [0.5, begin]]},
            'the trajectory ended': {'stamp': 0.001},
            "a tolerance is for joint 'elbow', not pam": {'path': [0.1], 'of': 'elbow'},
            'a tolerance of the position of -2 is not allowed': {'end': [-2.0]},
            'a tolerance of the velocity of 0.1 is not allowed': {'path': [0.0, 0.1]},
            'a tolerance of the acceleration of 1 is not allowed': {'path': [0.0, 0.0, 1.0]},
            'a goal_time_tolerance of -1 s is not allowed': {'goal_time_tolerance': -1.0},
        }
        found = ended(client(*({**good, **change} for change in bad.values())))
        assert found == [{'accepted': False}] * len(bad)
        catch_up(watch)
        assert {one.position[watch.names.index('reference')] for one in watch.terms} == {begin}
        (reached,) = ended(client({**good, 'path': [-1.0], 'end': [1.0]}))
        assert reached['status'] == GoalStatus.STATUS_SUCCEEDED
        output = control.output
    for words in bad:
        assert words in output


@pytest.mark.release
def test_a_trajectory_of_30_000_points_is_followed(watch):
    with Program('pam_sim', parameters=LOCKSTEP), Program('pam_control', parameters=FOLLOWING):
        begin = watch.begin()
        t = np.arange(1, 30_001) / 2000.0
        y = begin + WAY * np.sin(0.2 * np.pi * t) ** 2
        (found,) = ended(client({'points': np.column_stack([t, y]).tolist(), 'path': [1e-3]}))
        assert found['status'] == GoalStatus.STATUS_SUCCEEDED
        assert len(found['feedback']) > 200


def test_without_its_messages_there_is_no_action(peer):
    """Control is the same; that is how it is where control_msgs is not installed."""
    watch = Watch(peer)
    with Program('pam_sim', parameters=RIG), Program('pam_control', parameters=PATIENT):
        begin = watch.begin()
        peer.publish(Float64(data=begin + WAY), 'position_reference')
        peer.until(lambda: watch.latest('reference') > begin + 0.5 * WAY, 'the motion')
        topics = [name for name, _ in peer.node.get_topic_names_and_types()]
        assert not any('follow_joint_trajectory' in name for name in topics)
