# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` and its rig as processes, with one muscle and with a pair: following, safety."""

import math
import signal
from dataclasses import dataclass

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pam_ros.control.signals import term_names
from pam_ros.rig import statics
from support.control_watch import LOSE_NO_TERMS, Simulation, Watch, columns, sine
from support.harness import Program
from support.marks import at_release
from support.pair_loop import nominal

DEGREE = math.radians(1.0)
ENABLE = 'pam_control/enable'
PATIENT = {'state_timeout': 60.0}  # a busy machine may keep the rig of the test quiet


@dataclass(frozen=True)
class Kind:
    """A joint of a kind: what both programs are given, and coordinates and bounds in its units."""

    name: str
    muscles: int
    given: dict
    pressure: float  # Pa, of the simulator at its start
    middle: float  # a place within its reach
    way: float
    close: float  # of an error while it moves
    still: float  # of an error at rest
    load: float  # kg, another than is configured
    refused: tuple  # references, and what is said of them

    @property
    def lockstep(self):
        return {**self.given, 'time_mode': 'lockstep', 'initial.pressure': self.pressure}

    @property
    def following(self):
        return {**self.given, 'use_sim_time': True, 'state_rate': 500.0, **LOSE_NO_TERMS}


LOAD = Kind(
    *('load', 1, {}, 300e3, 0.06, 0.01, 1e-4, 1e-5, 21.0),
    (
        (0.3, ('reference 0.3 m', 'out of reach', ' to 0.09')),
        (-math.inf, ('reference -inf', ' to 0.09')),
    ),
)
PAIR = Kind(
    *('antagonistic', 2, {'joint': 'antagonistic'}, 250e3, 0.1, 0.2),
    *(0.2 * DEGREE, 0.1 * DEGREE, 1.3),
    (
        (2.0, ('reference 2 rad', 'out of reach', '-1.169 to 1.169 rad')),
        (math.nan, ('reference nan', '-1.169 to 1.169 rad')),
    ),
)
both = pytest.mark.parametrize('kind', [LOAD, PAIR], ids=lambda kind: kind.name)
of_a_load = pytest.mark.parametrize('kind', [LOAD], ids=lambda kind: kind.name)
of_a_pair = pytest.mark.parametrize('kind', [PAIR], ids=lambda kind: kind.name)


@pytest.fixture
def watch(peer, kind):
    names = term_names(kind.muscles)
    if kind.muscles == 1:
        return Watch(peer, names)
    return Watch(peer, names, Float64MultiArray, 'pressure_commands')


def pressures(kind):
    """Return the names of the terms that are the commanded pressures."""
    return [name for name in term_names(kind.muscles) if name.startswith('pressure')]


def stiffen(watch, value):
    watch.peer.publish(Float64(data=value), 'co_contraction_reference')


@both
@pytest.mark.at_any_pace
def test_a_step_and_a_sine_are_followed_in_lockstep(watch, kind):
    rig = {**kind.lockstep, 'mass': kind.load}
    with Program('pam_sim', parameters=rig), Program('pam_control', parameters=kind.following):
        begin = watch.begin()
        assert list(watch.terms[0].name) == list(term_names(kind.muscles))
        assert watch.latest('error') == pytest.approx(0.0, abs=kind.still)  # without a bump
        received = watch.lead(lambda: watch.refer(begin + kind.way), 2.0)
        t, seen = columns(received, watch.names)
        np.testing.assert_allclose(np.diff(t), 2e-3, atol=1e-8)
        assert seen['reference'][-1] == pytest.approx(begin + kind.way, abs=1e-9)
        assert np.max(np.abs(seen['error'][-100:])) < kind.still
        assert np.ptp([seen[name][-100:] for name in pressures(kind)], axis=1).max() < 1e3

        middle, swing = begin + kind.way, 0.5 * kind.way
        wave = sine(middle, swing)
        received = watch.lead(lambda: watch.peer.publish(wave, 'joint_trajectory'), 4.2)
        t, seen = columns(received, watch.names)
        begun = t[np.argmax(np.abs(seen['reference'] - middle) > 0.05 * swing)]
        moving = (t > begun + 1.0) & (t < begun + 3.0)
        assert np.ptp(seen['reference'][moving]) == pytest.approx(2.0 * swing, rel=0.02)
        assert np.sqrt(np.mean(seen['error'][moving] ** 2)) < kind.close


@of_a_pair
@pytest.mark.at_any_pace
def test_the_stiffness_is_led_while_the_angle_holds(watch, kind):
    # A third more load than is configured, and a sensor with noise.
    rig = {**kind.lockstep, 'mass': kind.load, 'sensor.position_noise': 0.02 * DEGREE}
    with Program('pam_sim', parameters=rig), Program('pam_control', parameters=kind.following):
        watch.begin()
        for wanted in (18.0, 38.0):
            received = watch.lead(
                lambda wanted=wanted: stiffen(watch, wanted), 2.0, 'co_contraction'
            )
            _, seen = columns(received, watch.names)
            assert np.max(np.abs(seen['error'])) < 0.1 * DEGREE
            assert seen['co_contraction'][-1] == pytest.approx(wanted)
            # By the closed form, at the pressures that are commanded.
            p = seen['pressure_1'][-1], seen['pressure_2'][-1]
            found = statics.stiffness(nominal(), p, seen['position'][-1])
            assert found == pytest.approx(wanted, rel=1e-3)
            (dim,) = watch.commands[-1].layout.dim
            assert dim.label == 'pam_1,pam_2'


@of_a_pair
def test_a_set_point_is_reached_in_real_time(watch, kind):
    with (
        Program('pam_sim', parameters={**kind.given, 'initial.pressure': kind.pressure}),
        Program('pam_control', parameters=kind.given) as control,
    ):
        begin = watch.begin()
        watch.refer(begin + 0.2)
        stiffen(watch, 35.0)

        def is_there():
            return (
                abs(watch.latest('position') - begin - 0.2) < 0.1 * DEGREE
                and abs(watch.latest('stiffness') - 35.0) < 0.1
            )

        watch.peer.until(is_there, 'angle and stiffness')
        control.interrupt(signal.SIGTERM)
        assert control.wait() == 0
        assert 'Traceback' not in control.output


@both
@pytest.mark.parametrize(('action', 'word'), [at_release('vent', 'vents'), ('hold', 'holds')])
def test_silence_of_the_joint_is_answered_safely(watch, kind, action, word):
    rig = Simulation(watch.peer)
    given = {**kind.given, 'on_timeout': action, 'state_timeout': 0.2}
    with Program('pam_control', parameters=given):
        rig.tell_until(lambda: len(watch.terms) > 10, 'control', kind.middle)
        status = watch.status(lambda s: 'has stopped' in s.message, 'the time-out')
        assert status.level == DiagnosticStatus.ERROR
        assert word in status.message
        commanded = np.atleast_1d(watch.steady_command())
        assert np.all(commanded == 0.0) if action == 'vent' else np.all(commanded > 1e5)
        if action == 'vent':
            watch.stops_publishing()  # a rig that starts again must not find a command to vent
        else:
            watch.peer.more(watch.commands)
        # When the joint is seen again, it goes on from there.
        before, there = len(watch.terms), kind.middle - kind.way
        rig.tell_until(lambda: len(watch.terms) > before, 'control again', there)
        assert watch.terms[before].position[0] == pytest.approx(there)


@both
@pytest.mark.at_any_pace
def test_bad_references_are_refused_with_the_range(watch, kind):
    with (
        Program('pam_sim', parameters=kind.lockstep),
        Program('pam_control', parameters=kind.following),
    ):
        begin = watch.begin()

        def is_refused(*words):
            status = watch.status(lambda s: all(word in s.message for word in words), str(words))
            assert status.level == DiagnosticStatus.WARN

        for bad, words in kind.refused:
            watch.refer(bad)
            is_refused(*words)
        watch.peer.publish(sine(begin, 0.0, 'elbow'), 'joint_trajectory')
        is_refused('elbow', 'pam')
        if kind is PAIR:
            stiffness = watch.rests('co_contraction')
            for bad, words in (
                (90.0, ('co-contraction 90 N m/rad', ' to 46.12 N m/rad')),
                (math.nan, ('co-contraction nan',)),
            ):
                stiffen(watch, bad)
                is_refused(*words)
            watch.peer.publish(sine(begin, 2.0), 'joint_trajectory')
            is_refused('reference', 'rad')
            assert watch.latest('co_contraction') == pytest.approx(stiffness, abs=1e-6)
            (values,) = (
                {v.key: v.value for v in s.values}
                for s in watch.arrays[-1].status
                if s.name == 'pam_control: control'
            )
            assert float(values['highest reference (rad)']) == pytest.approx(1.169)
            highest = float(values['highest co-contraction (N m/rad)'])
            assert highest == pytest.approx(46.12, abs=0.01)
        empty = JointTrajectory(joint_names=['pam'], points=[JointTrajectoryPoint()])
        watch.peer.publish(empty, 'joint_trajectory')
        is_refused('point 0 of the trajectory')
        assert watch.latest('reference') == begin
        assert np.all(np.isfinite([message.data for message in watch.commands]))


@both
@pytest.mark.at_any_pace
def test_disabled_it_commands_nothing_and_enabled_it_holds_the_load_where_it_is(watch, kind):
    rig = Simulation(watch.peer)
    given = {**kind.given, **PATIENT, 'start_enabled': False}
    with Program('pam_control', parameters=given):
        rig.tell_until(lambda: watch.arrays, 'the diagnostics')
        assert not watch.commands
        watch.refer(0.07)
        watch.status(lambda s: 'is ignored: disabled' in s.message, 'the refusal')
        assert watch.peer.call(SetBool, ENABLE, data=True).success
        rig.tell_until(lambda: watch.commands, 'commands', 0.055)
        assert watch.begin() == pytest.approx(0.055)
        answer = watch.peer.call(SetBool, ENABLE, data=False)
        assert answer.success
        assert 'disabled' in answer.message
        rig.tell(0.055)
        watch.status(lambda s: 'disabled' in s.message, 'its word')
        watch.stops_publishing()


@both
@pytest.mark.at_any_pace
def test_parameters_are_described_and_changed_or_refused_as_a_whole(watch, kind):
    with (
        Program('pam_sim', parameters=kind.lockstep),
        Program('pam_control', parameters=kind.following),
    ):
        begin = watch.begin()
        (about,) = watch.peer.describe('pam_control', 'gains.bandwidth')
        assert about.floating_point_range[0].from_value == 0.5
        assert '1/s' in about.description
        if kind is PAIR:
            (about,) = watch.peer.describe('pam_control', 'co_contraction')
            assert 'N m/rad' in about.description
        for name, bad, reason in (
            ('limits__pressure_high', -5.0, 'pressure_high'),
            ('gains__velocity_bandwidth', 2000.0, 'too fast for a control rate of 500 Hz'),
            *([('co_contraction', 900.0, '900 N m/rad is out of reach')] if kind is PAIR else []),
        ):
            refused = watch.peer.set_one('pam_control', **{name: bad})
            assert not refused.successful
            assert reason in refused.reason
        sent = len(watch.terms)
        assert watch.peer.set_one('pam_control', gains__bandwidth=10.0).successful
        # Another model: a new law.
        assert watch.peer.set_one('pam_control', mass=0.95 * kind.load).successful
        watch.peer.more(watch.terms, 800)
        _, seen = columns(watch.terms[sent:], watch.names)
        assert np.max(np.abs(seen['error'])) < kind.still
        assert abs(watch.latest('error')) < kind.still
        assert watch.peer.set_one('pam_control', velocity_source='measured').successful
        watch.lead(lambda: watch.refer(begin + kind.way), 2.0)
        assert abs(watch.latest('error')) < kind.still
        if kind is PAIR:
            watch.lead(
                lambda: watch.peer.set_one('pam_control', co_contraction=33.0),
                *(1.6, 'co_contraction'),
            )
            assert watch.latest('stiffness') == pytest.approx(33.0, rel=1e-3)
        assert watch.peer.set_one('pam_control', controller='pid').successful
        watch.lead(lambda: watch.refer(begin), 4.0)
        assert watch.latest('error') == pytest.approx(0.0, abs=kind.still)
        if kind is PAIR:
            assert watch.latest('stiffness') == pytest.approx(33.0, rel=0.05)


@of_a_load
@pytest.mark.at_any_pace
def test_a_reference_out_of_a_changed_reach_follows_the_load_with_a_line_in_the_log(watch, kind):
    with (
        Program('pam_sim', parameters=kind.lockstep),
        Program('pam_control', parameters=kind.following) as control,
    ):
        begin = watch.begin()

        def set_highest(pressure):
            changed = watch.peer.set_one('pam_control', limits__pressure_high=pressure)
            assert changed.successful, changed.reason

        watch.lead(lambda: set_highest(200e3), 3.0)
        lowest = watch.latest('reference')
        assert lowest < begin - kind.way
        assert abs(watch.latest('error')) < kind.still
        words = f'reference {begin:.6g} m is out of reach with the changed parameters'
        assert control.output.count('with the changed parameters') == 1
        assert words in control.output
        status = watch.status(lambda s: words in s.message, 'the warning')
        assert status.level == DiagnosticStatus.WARN

        sent = len(watch.terms)
        set_highest(5e6)
        watch.peer.more(watch.terms, 800)
        _, seen = columns(watch.terms[sent:], watch.names)
        np.testing.assert_array_equal(seen['reference'], lowest)
        assert np.max(np.abs(seen['error'])) < kind.close
        assert control.output.count('with the changed parameters') == 1
