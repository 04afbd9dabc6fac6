# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` with an antagonistic pair: angle and stiffness, safety, refusals, files."""

import math
import signal

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pam_ros.control.signals import term_names
from pam_ros.rig import statics
from support.control_watch import LOSE_NO_TERMS, Rig, Watch, columns
from support.harness import Program
from support.pair_loop import declared

PAIR_TERMS = term_names(2)
PAIR = {'joint': 'antagonistic'}
RIG = {**PAIR, 'time_mode': 'lockstep', 'initial.pressure': 250e3}
FOLLOWING = {**PAIR, 'use_sim_time': True, 'state_rate': 500.0, **LOSE_NO_TERMS}
DEGREE = math.radians(1.0)


@pytest.fixture
def watch(peer):
    return Watch(peer, PAIR_TERMS, Float64MultiArray, 'pressure_commands')


def stiffen(watch, value):
    watch.peer.publish(Float64(data=value), 'co_contraction_reference')


def sine(joint, swing, end=8.0):
    """Return a 0.5 Hz sine around 0 as a trajectory that begins and ends softly."""
    points = []
    for t in np.linspace(0.02, end, round(end / 0.02)):
        share = min(t, end - t, 1.0)
        at = swing * math.sin(0.5 * math.pi * share) ** 2 * math.sin(math.pi * t)
        time = Duration(sec=int(t), nanosec=int(t % 1.0 * 1e9))
        points.append(JointTrajectoryPoint(positions=[at], time_from_start=time))
    return JointTrajectory(joint_names=[joint], points=points)


@pytest.mark.at_any_pace
def test_angle_and_stiffness_are_led_in_lockstep(watch):
    # A third more load than is declared, and a sensor with noise.
    rig = {**RIG, 'mass': 1.3, 'sensor.position_noise': 0.02 * DEGREE}
    with Program('pam_sim', parameters=rig), Program('pam_control', parameters=FOLLOWING):
        begin = watch.begin()
        assert list(watch.terms[0].name) == list(PAIR_TERMS)
        assert watch.latest('error') == pytest.approx(0.0, abs=0.1 * DEGREE)
        assert begin == pytest.approx(0.0, abs=0.1 * DEGREE)
        wave = sine('pam', 15.0 * DEGREE)
        heard = watch.lead(lambda: watch.peer.publish(wave, 'joint_trajectory'), 8.2)
        t, seen = columns(heard, PAIR_TERMS)
        np.testing.assert_allclose(np.diff(t), 2e-3, atol=1e-8)
        begun = t[np.argmax(np.abs(seen['reference']) > 1.0 * DEGREE)]
        swung = (t > begun + 2.0) & (t < begun + 6.0)
        assert np.ptp(seen['reference'][swung]) == pytest.approx(30.0 * DEGREE, rel=0.01)
        assert np.sqrt(np.mean(seen['error'][swung] ** 2)) < 0.2 * DEGREE

        watch.lead(lambda: watch.refer(10.0 * DEGREE), 2.0)
        for wanted in (18.0, 38.0):
            heard = watch.lead(lambda wanted=wanted: stiffen(watch, wanted), 2.0, 'co_contraction')
            _, seen = columns(heard, PAIR_TERMS)
            assert np.max(np.abs(seen['error'])) < 0.1 * DEGREE  # the angle holds meanwhile
            assert seen['co_contraction'][-1] == pytest.approx(wanted)
            # By the closed form, at the pressures that are commanded.
            p = seen['pressure_1'][-1], seen['pressure_2'][-1]
            found = statics.stiffness(declared(), p, seen['position'][-1])
            assert found == pytest.approx(wanted, rel=1e-3)
            (dim,) = watch.commands[-1].layout.dim
            assert dim.label == 'pam_1,pam_2'


def test_a_set_point_is_reached_in_real_time(watch):
    with (
        Program('pam_sim', parameters={**PAIR, 'initial.pressure': 250e3}),
        Program('pam_control', parameters=PAIR) as control,
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


@pytest.mark.parametrize('action', ['vent', 'hold'])
def test_silence_of_the_joint_is_answered_safely(watch, action):
    rig = Rig(watch.peer)
    given = {**PAIR, 'on_timeout': action, 'state_timeout': 0.2}
    with Program('pam_control', parameters=given):
        rig.tell_until(lambda: len(watch.terms) > 10, 'control', 0.1)
        status = watch.status(lambda s: 'stay away' in s.message, 'the time-out')
        assert status.level == DiagnosticStatus.ERROR
        commanded = tuple(watch.steady_command())
        assert commanded == (0.0, 0.0) if action == 'vent' else min(commanded) > 1e5
        # When the joint is seen again, it goes on from there.
        before = len(watch.terms)
        rig.tell_until(lambda: len(watch.terms) > before, 'control again', -0.2)
        assert watch.terms[before].position[0] == pytest.approx(-0.2)


@pytest.mark.at_any_pace
def test_what_is_out_of_reach_is_refused_with_the_range(watch):
    with Program('pam_sim', parameters=RIG), Program('pam_control', parameters=FOLLOWING):
        begin = watch.begin()
        stiffness = watch.rests('co_contraction')
        for tell, bad, words in (
            (watch.refer, 2.0, ('reference 2 rad', 'out of reach', '-1.169 to 1.169 rad')),
            (watch.refer, math.nan, ('reference nan',)),
            (
                lambda k: stiffen(watch, k),
                90.0,
                ('co-contraction 90 N m/rad', ' to 46.12 N m/rad'),
            ),
            (lambda k: stiffen(watch, k), math.nan, ('co-contraction nan',)),
        ):
            tell(bad)
            status = watch.status(
                lambda s, words=words: all(word in s.message for word in words), str(words)
            )
            assert status.level == DiagnosticStatus.WARN
        watch.peer.publish(sine('elbow', 0.1), 'joint_trajectory')
        watch.status(lambda s: 'elbow' in s.message and 'pam' in s.message, 'the wrong name')
        watch.peer.publish(sine('pam', 2.0), 'joint_trajectory')
        watch.status(lambda s: 'reference' in s.message and 'rad' in s.message, 'the wide one')
        assert watch.latest('reference') == begin
        assert watch.latest('co_contraction') == pytest.approx(stiffness, abs=1e-6)
        (values,) = (
            {v.key: v.value for v in s.values}
            for s in watch.arrays[-1].status
            if s.name == 'pam_control: control'
        )
        assert float(values['highest reference (rad)']) == pytest.approx(1.169)
        assert float(values['highest co-contraction (N m/rad)']) == pytest.approx(46.12, abs=0.01)


def test_disabled_it_commands_nothing(watch):
    rig = Rig(watch.peer)
    with Program('pam_control', parameters={**PAIR, 'start_enabled': False}):
        rig.tell_until(lambda: watch.arrays, 'the diagnostics')
        assert not watch.commands
        stiffen(watch, 20.0)
        watch.status(lambda s: 'not taken: disabled' in s.message, 'the refusal')
        assert watch.peer.call(SetBool, 'pam_control/enable', data=True).success
        rig.tell_until(lambda: watch.commands, 'commands', 0.055)
        assert watch.begin() == pytest.approx(0.055)


@pytest.mark.at_any_pace
def test_parameters_change_while_it_runs_or_are_refused_as_a_whole(watch):
    with Program('pam_sim', parameters=RIG), Program('pam_control', parameters=FOLLOWING):
        watch.begin()
        (about,) = watch.peer.describe('pam_control', 'co_contraction')
        assert 'N m/rad' in about.description
        bad = watch.peer.set_one('pam_control', co_contraction=900.0)
        assert not bad.successful
        assert 'co-contraction 900 N m/rad is out of reach' in bad.reason
        assert watch.peer.set_one('pam_control', gains__bandwidth=20.0).successful
        watch.lead(
            lambda: watch.peer.set_one('pam_control', co_contraction=33.0), 1.6, 'co_contraction'
        )
        assert watch.latest('stiffness') == pytest.approx(33.0, rel=1e-3)
        sent = len(watch.terms)
        assert watch.peer.set_one('pam_control', mass=1.2).successful  # another model: a new law
        watch.peer.more(watch.terms, 800)
        _, seen = columns(watch.terms[sent:], PAIR_TERMS)
        assert np.max(np.abs(seen['error'])) < 0.1 * DEGREE
        sent = len(watch.terms)
        assert watch.peer.set_one('pam_control', controller='pid').successful
        watch.lead(lambda: watch.refer(5.0 * DEGREE), 3.0)
        _, seen = columns(watch.terms[sent:], PAIR_TERMS)
        assert watch.latest('error') == pytest.approx(0.0, abs=0.1 * DEGREE)
        assert watch.latest('stiffness') == pytest.approx(33.0, rel=0.05)
        assert np.ptp(seen['position']) > 4.0 * DEGREE


@pytest.mark.at_any_pace
@pytest.mark.parametrize(
    ('kind', 'muscles', 'way', 'close'),
    [('parallel', 2, 0.01, 1e-4), ('lever', 2, 0.2, 2e-3), ('crank', 1, 0.1, 2e-3)],
)
def test_every_kind_of_joint_is_moved_to_a_position(peer, kind, muscles, way, close):
    watch = Watch(peer, term_names(muscles), Float64MultiArray, 'pressure_commands')
    rig = {'joint': kind, 'time_mode': 'lockstep', 'initial.pressure': 250e3}
    following = {**FOLLOWING, 'joint': kind}
    with Program('pam_sim', parameters=rig), Program('pam_control', parameters=following):
        begin = watch.begin()
        assert list(watch.terms[0].name) == list(term_names(muscles))
        watch.lead(lambda: watch.refer(begin + way), 3.0)
        assert watch.latest('position') == pytest.approx(begin + way, abs=close)
        assert len(watch.commands[-1].data) == muscles


ONE_FILE = """
/**:
  ros__parameters:
    joint: antagonistic
    muscles: [flexor, extensor]
    joint_names: [elbow]
    radius: 0.05
    mass: 0.8
    extensor: {muscle: dmsp_20_200n, initial: {pressure: 200000.0}}
    effects:
      viscous_friction: {coefficient: 0.1}
/**/pam_sim:
  ros__parameters: {time_mode: lockstep, initial: {pressure: 200000.0}}
/**/pam_control:
  ros__parameters: {use_sim_time: true, state_rate: 500.0}
"""


@pytest.mark.at_any_pace
def test_one_file_is_for_both_programs(watch, tmp_path):
    file = tmp_path / 'elbow.yaml'
    file.write_text(ONE_FILE)
    given = ('--params-file', str(file))
    with Program('pam_sim', *given) as sim, Program('pam_control', *given) as control:
        begin = watch.begin()
        watch.lead(lambda: watch.refer(begin + 0.1), 1.6)
        assert watch.latest('position') == pytest.approx(begin + 0.1, abs=0.01 * DEGREE)
        (dim,) = watch.commands[-1].layout.dim
        assert dim.label == 'flexor,extensor'
        assert watch.peer.get('pam_control', 'extensor.l0', 'radius') == [0.2, 0.05]
        assert 'not known here' not in sim.output
        # What is the simulator's alone is said to be so.
        (warning,) = control.output.splitlines()
        assert 'extensor.initial.pressure is not known here' in warning


@pytest.mark.at_any_pace
def test_of_several_joints_each_has_a_controller(peer):
    shared = {
        'joint': 'antagonistic',
        'muscles': ['s1', 's2', 'e1', 'e2'],
        'joint_names': ['shoulder', 'elbow'],
        'muscle_topics': True,
        'elbow.mass': 0.5,
    }
    names = ('shoulder', 'elbow')
    terms = {name: peer.collect(JointState, f'{name}_control/state') for name in names}
    sim = Program(
        'pam_sim', parameters={**shared, 'time_mode': 'lockstep', 'initial.pressure': 2e5}
    )
    controls = [
        Program(
            'pam_control',
            *('-r', f'__node:={name}_control', '-r', f'position_reference:={name}/reference'),
            parameters={**shared, 'joint_name': name, 'use_sim_time': True},
        )
        for name in names
    ]
    with sim, controls[0], controls[1]:
        for name in names:
            peer.more(terms[name], 3)
        peer.publish(Float64(data=0.15), 'shoulder/reference')
        peer.publish(Float64(data=-0.15), 'elbow/reference')

        def are_there():
            found = [terms[name][-1].position[1] for name in names]
            return np.allclose(found, (0.15, -0.15), atol=1e-3)

        peer.until(are_there, 'both')


@pytest.mark.at_any_pace
@pytest.mark.usefixtures('domain')
@pytest.mark.parametrize(
    ('arguments', 'named'),
    [
        (['joint:=knee'], ['joint', 'knee', 'load, parallel, antagonistic, lever, crank']),
        (['joint:=antagonistic', 'co_contraction:=900.0'], ['co-contraction 900', 'N m/rad']),
        (['joint:=antagonistic', 'muscles:=[a, b, c]'], ['3 names', 'give 2']),
        (['joint:=antagonistic', 'muscles:=[a, b, c, d]'], ['joint_name = pam', 'pam_1, pam_2']),
        (
            ['joint:=antagonistic', 'muscles:=[a, b, c, d]', 'joint_names:=[k, pam]'],
            ['pressure_commands', 'muscle_topics'],
        ),
        (['joint:=antagonistic', 'raduis:=0.1'], ['raduis', 'radius']),
        (['joint:=antagonistic', 'gains.disturbance_bound:=900.0'], ['900 N m', 'overcome']),
        (['joint:=antagonistic', 'mass:=-1.0'], ['mass = -1']),
    ],
)
def test_bad_arguments_end_it_with_a_sentence(arguments, named):
    given = [part for argument in arguments for part in ('-p', argument)]
    with Program('pam_control', *given) as control:
        assert control.wait() == 2
        sentence = control.output.splitlines()[-1]
        assert sentence.startswith('pam_control: ')
        for word in named:
            assert word in sentence
        assert 'Traceback' not in control.output
