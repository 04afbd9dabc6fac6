# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim`` in lockstep over DDS: a period for a command, whoever commands and however late."""

import math

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import SetBool, Trigger

from pam_ros.effects import Leak, Payload
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support.harness import Peer, Program, lose_nothing

pytestmark = pytest.mark.at_any_pace

PERIOD = 2_000_000  # ns
MANY = {'time_mode': 'lockstep', 'command_timeout': 0.0}
LOCKSTEP = {**MANY, **lose_nothing()}
RELEASED = {'initial.at_rest': False, 'initial.position': 0.0}


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def pressure_at(k):
    return 3e5 + 1e5 * math.sin(0.05 * k)


def last(states, after=0):
    return states[-1] if states and stamp(states[-1]) > after else None


class Controller:
    """Answers each state with pressures that the test knows; a repeated one, with the same."""

    def __init__(self, peer):
        self.peer, self.states = peer, peer.collect(JointState, 'joint_states')
        self.time, self.said, self.seen = 0, None, 0

    def next_state(self):
        """Return the next state when it is there, and answer the last one again if need be."""
        is_repeated = len(self.states) > self.seen and stamp(self.states[-1]) == self.time
        self.seen = len(self.states)
        if is_repeated:
            self.peer.publish(Float64(data=self.said), 'pressure_command')
        return last(self.states, self.time)

    def answer(self, pressure):
        """Wait for the next state, answer it and return it."""
        state = self.peer.until(self.next_state, 'the next state')
        self.time, self.said, self.seen = stamp(state), pressure, len(self.states)
        self.peer.publish(Float64(data=pressure), 'pressure_command')
        return state


def expected(periods, joint=None):
    """Return positions and velocities of the released rig, period by period."""
    rig = Simulation([joint or single_muscle_joint()], 1e-3)
    rig.reset([0.0], [0.0], [0.0])
    found = []
    for k in range(periods):
        found.append((rig.position.item(), rig.velocity.item()))
        rig.command([pressure_at(k)])
        rig.advance(2)
    return found


def test_a_command_is_a_period_to_the_bit_and_nothing_else_is(peer):
    clocks = peer.collect(Clock, '/clock')
    with Program('pam_sim', parameters={**LOCKSTEP, **RELEASED}):
        controller = Controller(peer)
        got = [controller.answer(pressure_at(k)) for k in range(200)]
        peer.until(lambda: last(controller.states, controller.time), 'the last state')
        end = len(controller.states)
        peer.work(1.5)  # a state is not published twice while the controller computes
        assert len(controller.states) == end
    assert [(m.position[0], m.velocity[0]) for m in got] == expected(200)
    assert set(np.diff([stamp(m) for m in got])) == {PERIOD}
    # 100 Hz of simulated time, from one clock with the states.
    ticks = sorted({m.clock.sec * 10**9 + m.clock.nanosec for m in clocks})
    assert set(np.diff(ticks)) == {10_000_000}
    assert ticks[-1] <= stamp(controller.states[-1])
    assert ticks[0] == stamp(got[0])


def test_effects_begin_at_their_onsets_also_those_set_while_it_runs(peer):
    """A load is taken off after 0.1 s, and a leak that is configured at 0.12 s begins at 0.2 s."""
    dropped = [Payload(mass=-5.0, onset=0.1)]
    leaking = [Leak(rate=2.0, refill=0.1, onset=0.2)]
    late = {'effects.payload.mass': -5.0, 'effects.payload.onset': 0.1}
    with Program('pam_sim', parameters={**LOCKSTEP, **RELEASED, **late}) as sim:
        controller = Controller(peer)
        got = [controller.answer(pressure_at(k)) for k in range(60)]
        peer.until(lambda: last(controller.states, controller.time), 'the next state')
        nominal = {'rate': 2.0, 'refill': 0.1, 'onset': 0.2}
        given = {f'effects__leak__{name}': value for name, value in nominal.items()}
        assert peer.set_together('pam_sim', **given).successful
        got += [controller.answer(pressure_at(k)) for k in range(60, 150)]
        begun = 'effects.leak acts from 0.2 s of simulated time on'
        peer.until(lambda: begun in sim.output, 'the line of the leak')
    expected_ones = expected(150, single_muscle_joint(effects=[*dropped, *leaking]))
    assert [(m.position[0], m.velocity[0]) for m in got] == expected_ones
    assert expected_ones != expected(150, single_muscle_joint(effects=dropped))
    assert expected_ones[:51] == expected(51)


def test_a_refused_command_is_a_period_with_the_last_good_one(peer):
    with Program('pam_sim', parameters=LOCKSTEP):
        controller = Controller(peer)
        a = controller.answer(3e5)
        b = controller.answer(math.nan)
        c = controller.answer(3e5)
        assert stamp(c) - stamp(a) == 2 * PERIOD
        assert c.position[0] > b.position[0] > a.position[0]


def test_without_its_controller_it_waits_with_a_warning_and_a_new_one_continues(peer):
    diagnostics = peer.collect(DiagnosticArray, '/diagnostics')

    def said(words):
        return [s.message for m in diagnostics for s in m.status if words in s.message]

    with Program('pam_sim', parameters={**LOCKSTEP, **RELEASED}):
        with Peer() as first:
            controller = Controller(first)
            got = [controller.answer(pressure_at(k)) for k in range(50)]
            first.until(lambda: last(controller.states, controller.time), 'the last state')
        diagnostics.clear()
        peer.until(lambda: said('waits for a controller'), 'word that one is missing')
        with Peer() as second:
            controller = Controller(second)
            got += [controller.answer(pressure_at(k)) for k in range(50, 100)]
        diagnostics.clear()
    assert [(m.position[0], m.velocity[0]) for m in got] == expected(100)
    assert set(np.diff([stamp(m) for m in got])) == {PERIOD}


def test_a_signal_ends_a_long_step_with_an_answer(peer):
    """All periods take minutes; the service's client has no such patience."""
    states = peer.collect(JointState, 'joint_states')
    with Program('pam_sim', parameters={**MANY, 'step_periods': 100_000}) as sim:
        peer.more(states)
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success
        client = peer.node.create_client(Trigger, 'pam_sim/step')
        peer.until(client.service_is_ready, 'the service')
        before = stamp(states[-1])
        answer = client.call_async(Trigger.Request())
        peer.until(lambda: stamp(states[-1]) >= before + 50 * PERIOD, 'some periods')
        sim.interrupt()
        peer.until(lambda: not sim.is_running, 'the end')
        assert sim.wait() == 0
        peer.until(answer.done, 'the answer')
    assert not answer.result().success
    assert answer.result().message.startswith('stop requested: simulated ')
    assert answer.result().message.endswith(' of 100000 periods')
    # As many were simulated when the stop was requested, and not all that were wanted.
    assert stamp(states[-1]) < before + 100_000 * PERIOD


def test_pause_keeps_an_answer_and_step_goes_on_without_one(peer):
    with Program('pam_sim', parameters={**LOCKSTEP, **RELEASED, 'step_periods': 7}):
        controller = Controller(peer)
        assert not peer.call(Trigger, 'pam_sim/step').success  # not while time goes on
        controller.answer(3e5)
        peer.until(lambda: last(controller.states, controller.time), 'the next state')
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success
        before = controller.answer(3e5)
        peer.more(controller.states, 3)  # it goes on telling its state
        assert stamp(controller.states[-1]) == stamp(before)
        assert controller.states[-1].position == before.position
        peer.call(SetBool, 'pam_sim/pause', data=False)
        after = peer.until(lambda: last(controller.states, stamp(before)), 'what it kept')
        assert stamp(after) - stamp(before) == PERIOD
        peer.call(SetBool, 'pam_sim/pause', data=True)
        count = len(controller.states)
        response = peer.call(Trigger, 'pam_sim/step')
        assert response.success, response.message
        peer.until(lambda: last(controller.states, stamp(after) + 6 * PERIOD), 'seven periods')
        peer.more(controller.states)
        assert stamp(controller.states[-1]) - stamp(after) == 7 * PERIOD
        stepped = {stamp(m) for m in controller.states[count:]} - {stamp(after)}
        assert len(stepped) == 7


def test_reset_repeats_the_run_and_time_goes_on(peer):
    given = {**LOCKSTEP, **RELEASED, 'sensor.position_noise': 1e-5, 'sensor.seed': 3}
    with Program('pam_sim', parameters=given):
        controller = Controller(peer)
        runs = []
        for _ in range(2):
            runs.append([controller.answer(pressure_at(k)) for k in range(100)])
            peer.until(lambda: last(controller.states, controller.time), 'the last state')
            controller.time = stamp(controller.states[-1])
            assert peer.call(Trigger, 'pam_sim/reset').success
        assert peer.set_together('pam_sim', sensor__seed=4, initial__position=0.02).successful
        assert peer.call(Trigger, 'pam_sim/reset').success
        peer.until(lambda: controller.states[-1].position[0] > 0.0199, 'the given state')
    first, second = ([(m.position[0], m.velocity[0], m.effort[0]) for m in run] for run in runs)
    assert first == second
    assert all(np.diff([stamp(m) for run in runs for m in run]) > 0)


def test_it_waits_for_the_commands_of_all_muscles(peer):
    names = ['left', 'right']
    given = {**MANY, 'muscles': names, 'muscle_topics': True}
    diagnostics = peer.collect(DiagnosticArray, '/diagnostics')
    with Program('pam_sim', parameters=given):
        states = peer.collect(JointState, 'joint_states')
        peer.more(states)
        begin = stamp(states[-1])

        def one_is_missing():
            peer.publish(Float64(data=2e5), 'left/pressure_command')
            return any('1 of 2 missing' in s.message for m in diagnostics for s in m.status)

        peer.until(one_is_missing, 'word that the other one is missing')
        assert stamp(states[-1]) == begin

        def both_are_there():
            peer.publish(Float64(data=1e5), 'right/pressure_command')
            return last(states, begin)

        peer.until(both_are_there, 'the next state')
        assert stamp(states[-1]) == begin + PERIOD

        def all_at_once():
            peer.publish(Float64MultiArray(data=[2e5, 1e5]), 'pressure_commands')
            return last(states, begin + 5 * PERIOD)

        peer.until(all_at_once, 'more periods')
        assert states[-1].name == names
        assert states[-1].position[0] > states[-1].position[1]


@pytest.mark.parametrize('values', [[3e5], [3e5] * 3])
def test_an_array_of_another_length_is_no_command(peer, values):
    diagnostics = peer.collect(DiagnosticArray, '/diagnostics')
    given = {**MANY, 'muscles': ['left', 'right']}
    with Program('pam_sim', parameters=given) as sim:
        states = peer.collect(JointState, 'joint_states')
        peer.more(states)
        begin = stamp(states[-1])

        def is_warned_of():
            peer.publish(Float64MultiArray(data=values), 'pressure_commands')
            return 'values for 2 muscles' in sim.output

        peer.until(is_warned_of, 'a warning')
        seconds = len(diagnostics)
        peer.until(lambda: len(diagnostics) > seconds, 'a second')
        assert stamp(states[-1]) == begin


class Naive:
    """A controller that answers all it hears, also what it has answered before."""

    def __init__(self, peer):
        self.received = []
        publisher = peer.node.create_publisher(Float64, 'pressure_command', 10)

        def answer(state):
            self.received.append((stamp(state), state.position[0], state.velocity[0]))
            publisher.publish(Float64(data=self.law(state.position[0])))

        peer.node.create_subscription(JointState, 'joint_states', answer, 10)

    @staticmethod
    def law(position):
        return 3e5 + 2e6 * (0.05 - position)


def test_a_controller_that_answers_too_often_gets_the_same_run(peer):
    with Program('pam_sim', parameters={**LOCKSTEP, **RELEASED}):
        naive = Naive(peer)
        peer.until(lambda: len(naive.received) > 300, 'some periods')
        for _ in range(2):
            assert peer.call(SetBool, 'pam_sim/pause', data=True).success
            count = len(naive.received)
            peer.until(lambda n=count: len(naive.received) > n + 4, 'the same state again')
            assert peer.call(SetBool, 'pam_sim/pause', data=False).success
            count = len(naive.received)
            peer.until(lambda n=count: len(naive.received) > n + 300, 'more periods')
    got = sorted(set(naive.received))
    rig = Simulation([single_muscle_joint()], 1e-3)
    rig.reset([0.0], [0.0], [0.0])
    assert len(got) > 600
    assert set(np.diff([time for time, *_ in got])) == {PERIOD}
    for _, position, velocity in got:
        assert (position, velocity) == (rig.position.item(), rig.velocity.item())
        rig.command([Naive.law(position)])
        rig.advance(2)
