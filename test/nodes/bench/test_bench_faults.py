# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Messages are lost and delayed, and the rig fails and returns, in runs over DDS."""

import sys
from pathlib import Path

import numpy as np
import pytest

from pam_ros.bench.controllers import Controller, controllers_of
from pam_ros.bench.faults import CommandFaults, MessageFaults, Outage, StateFaults
from pam_ros.bench.references import reference_of
from pam_ros.bench.scenario import Scenario
from pam_ros.nodes.bench import run as running
from support import odd_controller

pytestmark = [pytest.mark.usefixtures('domain'), pytest.mark.at_any_pace]

RIG = {'muscle': 'dmsp_20_400n', 'mass': 20.0}
START = {'initial.pressure': 300e3}
SIM_TIME = ('--ros-args', '-p', 'use_sim_time:=true')
PERIOD = 2_000_000  # ns
FIRST = 10**9  # ns, the stamp of the first state


def scenario(duration, **more):
    wanted = reference_of({'kind': 'hold'}, 'reference')
    return Scenario('faults', 'Faults.', RIG, START, wanted, duration, **more)


def odd(kind, *more):
    command = (sys.executable, str(Path(odd_controller.__file__)), kind, *more)
    return Controller(kind, command=command)


def periods_of(path):
    """Return the periods whose states were received, by their stamps, without repetitions."""
    stamps = np.unique(np.loadtxt(path, dtype=np.int64))
    assert not ((stamps - FIRST) % PERIOD).any()
    return (stamps - FIRST) // PERIOD


def test_the_states_that_are_lost_are_those_of_the_seed(tmp_path, domain):
    """Simulated time does not wait for an answer to them."""
    faults = MessageFaults(StateFaults(0.2, 0.02))
    received, trials = [], []
    for k, seed in enumerate((0, 0, 1)):
        path = tmp_path / f'{k}'
        run = scenario(2.0, messages=faults)
        outcome, trial = running.run(run, odd('notes', str(path), *SIM_TIME), seed, domain)
        assert outcome.is_completed, outcome.reason
        assert not outcome.is_real_time
        received.append(periods_of(path))
        trials.append(trial)
    for found, trial in zip(received, trials, strict=True):
        # One more state is sent at the end, if it is not lost.
        np.testing.assert_array_equal(found[found < 1000], np.flatnonzero(trial.answer > 0.0))
    assert received[0].tolist() == received[1].tolist() != received[2].tolist()
    assert all(600 < found.size < 950 for found in received)


def test_a_command_acts_after_its_delay_and_only_if_it_arrives(domain):
    """The load moves as it does otherwise, but later, after the step of the sent command."""

    def moved(**commands):
        run = scenario(1.0, messages=MessageFaults(commands=CommandFaults(**commands)))
        outcome, trial = running.run(run, odd('steps', *SIM_TIME), 0, domain)
        assert outcome.is_completed, outcome.reason
        sent = np.flatnonzero(trial.pressure[:, 0] == 310e3)[0]
        return (trial.position - trial.position[0])[sent : sent + 250]

    at_once, late = moved(), moved(delay=0.03)
    assert at_once[0] < 1e-9 < at_once[3]
    assert np.abs(late[:16]).max() < 1e-9 < late[18]
    np.testing.assert_allclose(late[15:], at_once[:-15], rtol=0.0, atol=1e-9)
    lost = moved(loss=0.9, dropout=1.0)
    assert np.abs(lost).max() < 1e-9


def test_an_outage_has_no_states_and_its_stamps_continue(tmp_path, domain):
    outages = (Outage('freeze', 0.5, 0.3), Outage('restart', 1.2, 0.4))
    path = tmp_path / 'stamps'
    run = scenario(2.0, outages=outages)
    outcome, trial = running.run(run, odd('notes', str(path), *SIM_TIME), 0, domain)
    assert outcome.is_completed, outcome.reason
    present = [*range(250), *range(400, 600), *range(800, 1000)]
    found = periods_of(path)
    assert found[found < 1000].tolist() == present == np.flatnonzero(trial.answer > 0.0).tolist()
    depth = trial.position[0] - trial.position
    assert np.abs(depth[:601]).max() < 1e-6  # the valves keep their pressure while it freezes
    assert depth[800] > 5e-3  # and vent while it restarts
    assert (np.diff(depth[601:800]) > 0.0).all()
    assert abs(depth[-1]) < depth[800]  # commands act again


def test_pam_control_notices_an_outage_by_its_clock_and_continues(domain):
    """Its time-out of 0.5 s passes in simulated time; then it vents as the rig does."""
    run = scenario(4.0, outages=(Outage('restart', 1.0, 1.0),))
    (controller,) = controllers_of(['sliding_mode'])
    first, again = (running.run(run, controller, 0, domain) for _ in range(2))
    assert first.outcome.is_completed, first.outcome.reason
    pressure = first.trial.pressure[:, 0]
    assert pressure[740] == pytest.approx(300e3, rel=0.01)
    assert 200e3 < pressure[999] < 290e3
    assert 0.1 < first.outcome.scores['recovery'] < 1.5
    np.testing.assert_array_equal(first.trial.position, again.trial.position)


@pytest.mark.parametrize(
    ('outage', 'status', 'reason'),
    [
        (
            Outage('freeze', 0.38, 3.0),
            'stopped_answering',
            'sent no command for 2 s, 3.39',
        ),
        (Outage('stop', 0.38), 'completed', ''),
    ],
)
def test_silence_is_permitted_in_an_outage_only(domain, monkeypatch, outage, status, reason):
    """The controller answers 200 states, of which some ten come after the outage."""
    monkeypatch.setattr(running, 'SILENCE', 2.0)
    run = scenario(3.6, outages=(outage,))
    outcome = running.run(run, odd('stops', *SIM_TIME), 0, domain).outcome
    assert (outcome.status, reason in outcome.reason) == (status, True)


@pytest.mark.parametrize(('kind', 'arguments'), [('good', ()), ('timer', SIM_TIME)])
def test_outages_and_losses_with_another_clock(domain, monkeypatch, kind, arguments):
    """In real time, and in scaled time for a timer that goes on while no states come."""
    monkeypatch.setattr(running, 'SILENCE', 4.0)
    faults = MessageFaults(StateFaults(0.2, 0.02), CommandFaults(0.1, delay=0.005))
    run = scenario(2.0, outages=(Outage('restart', 0.5, 0.5),), messages=faults)
    outcome, trial = running.run(run, odd(kind, *arguments), 0, domain)
    assert outcome.is_completed, outcome.reason
    assert outcome.is_real_time
    answered = np.flatnonzero(trial.answer > 0.0)
    # The states at the begin and the end of the outage may be on either side of it.
    assert not ((answered > 251) & (answered < 499)).any()
    assert trial.position[500] < trial.position[250] - 5e-3
