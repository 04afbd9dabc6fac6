# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A run of a controller, as a process over DDS: its scores, to the bit, and how it can fail."""

import shlex
import sys
from pathlib import Path

import pytest

from pam_ros.bench.controllers import Controller, controllers_of
from pam_ros.bench.references import reference_of
from pam_ros.bench.scenario import Change, Scenario
from pam_ros.bench.scores import SCORES
from pam_ros.nodes.bench import run as running
from support import odd_controller

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

RIG = {'muscle': 'dmsp_20_400n', 'mass': 20.0}
START = {'initial.pressure': 300e3, 'sensor.position_noise': 20e-6}
SIM_TIME = ('--ros-args', '-p', 'use_sim_time:=true')


def outcome_of(*given):
    return running.run(*given).outcome


STEP = {'kind': 'step', 'size': 0.01, 'time': 0.5}


def scenario(duration=6.0, reference=STEP, **more):
    wanted = reference_of(reference, 'reference')
    return Scenario('short', 'A step.', RIG, START, wanted, duration, **more)


def odd(kind, *more):
    return Controller(
        kind, command=(sys.executable, str(Path(odd_controller.__file__)), kind, *more)
    )


def test_a_run_is_the_same_to_the_bit_and_its_noise_is_that_of_its_seed(domain):
    (controller,) = controllers_of(['sliding_mode'])
    first, again, other = (outcome_of(scenario(), controller, k, domain) for k in (0, 0, 1))
    same = [score.name for score in SCORES if not score.is_of_machine]
    assert first.is_completed
    assert not first.is_real_time
    assert [first.scores[name] for name in same] == [again.scores[name] for name in same]
    assert first.scores['rms_error'] != other.scores['rms_error']
    assert first.scores['error_at_rest'] < 20e-6
    assert first.scores['settling_time'] < 1.0
    assert 0.0 < first.scores['computing_time'] < 1e3


def test_a_change_of_the_rig_is_seen_and_rejected(domain):
    changes = (Change(2.0, {'effects.payload.mass': 5.0}),)
    (controller,) = controllers_of(['sliding_mode'])
    pushed = scenario(reference={'kind': 'hold'}, changes=changes)
    held = outcome_of(pushed, odd('good', *SIM_TIME), 0, domain)
    controlled = outcome_of(pushed, controller, 0, domain)
    assert held.scores['recovery'] == pytest.approx(4.0, abs=0.01)  # it never recovers
    assert 0.0 < controlled.scores['recovery'] < 1.0


@pytest.mark.parametrize(
    ('kind', 'status', 'reason'),
    [
        ('dies', 'died', 'ended with exit code 1 0.39'),
        ('stops', 'stopped_answering', 'sent no command for 2 s, 0.39'),
        ('nan', 'not_finite', 'commanded a pressure that is not finite 0.39'),
        ('silent', 'silent', 'sent no command within 2 s of receiving states'),
        ('deaf', 'silent', 'did not subscribe to joint_states within 4 s'),
        ('floods', 'flooded', 'commands'),
    ],
)
def test_a_controller_that_fails_has_a_reason_and_ends(domain, monkeypatch, kind, status, reason):
    monkeypatch.setattr(running, 'START', 4.0)
    monkeypatch.setattr(running, 'SILENCE', 2.0)
    outcome = outcome_of(scenario(2.0), odd(kind, *SIM_TIME), 0, domain)
    assert outcome.status == status
    assert reason in outcome.reason
    assert outcome.scores == {}
    if kind == 'dies':
        assert outcome.reason.endswith('RuntimeError: the gains are lost')


@pytest.mark.parametrize(('kind', 'arguments'), [('good', ()), ('timer', SIM_TIME)])
def test_a_controller_with_another_clock_runs_in_real_time(domain, kind, arguments):
    """Without simulated time, and with a timer that would wait for it."""
    outcome = outcome_of(scenario(2.0), odd(kind, *arguments), 0, domain)
    assert outcome.is_completed
    assert outcome.is_real_time
    assert outcome.seconds > 2.0


def test_two_controllers_of_one_rig_are_named(domain):
    one = shlex.join(odd('good', *SIM_TIME).command)
    both = Controller('both', command=('sh', '-c', f'{one} & {one}'))
    outcome = outcome_of(scenario(60.0), both, 0, domain)
    assert outcome.status == 'several_publishers'
    assert outcome.reason == '2 nodes send commands: is one left over?'
