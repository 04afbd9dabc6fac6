# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_control`` of every kind of joint, of several, by names and files; what it refuses."""

import math

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray

from pam_ros.control.signals import term_names
from support.control_watch import LOSE_NO_TERMS, Simulation, Watch
from support.ends import check_refusals
from support.harness import Program

START = {'mass': 20.0, 'initial.pressure': 300e3}
FOLLOWING = {'use_sim_time': True, 'state_rate': 500.0, **LOSE_NO_TERMS}


@pytest.fixture
def watch(peer):
    return Watch(peer)


@pytest.mark.at_any_pace
def test_a_wrong_joint_name_is_named_and_nothing_is_commanded(watch):
    rig = Simulation(watch.peer)
    with Program('pam_control', parameters={'joint_name': 'elbow'}) as control:

        def is_said():
            return 'no joint elbow (joint_name), but pam' in control.output

        rig.tell_until(is_said, 'the warning')
        status = watch.status(lambda s: 'no joint elbow' in s.message, 'the diagnostics')
        assert status.level == DiagnosticStatus.ERROR
        assert not watch.commands


@pytest.mark.at_any_pace
def test_a_position_that_is_no_number_is_not_used(watch):
    rig = Simulation(watch.peer)
    with Program('pam_control'):
        rig.tell_until(lambda: watch.commands, 'control')
        rig.tell_until(
            lambda: any('position nan' in s.message for a in watch.arrays for s in a.status),
            'the diagnostics',
            math.nan,
        )
        assert all(math.isfinite(message.data) for message in watch.commands)


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
        watch.lead(lambda: watch.refer(begin + way), 2.0)
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
def test_one_file_is_for_both_programs(peer, tmp_path):
    watch = Watch(peer, term_names(2), Float64MultiArray, 'pressure_commands')
    file = tmp_path / 'elbow.yaml'
    file.write_text(ONE_FILE)
    given = ('--params-file', str(file))
    with Program('pam_sim', *given) as sim, Program('pam_control', *given) as control:
        begin = watch.begin()
        watch.lead(lambda: watch.refer(begin + 0.1), 1.6)
        assert watch.latest('position') == pytest.approx(begin + 0.1, abs=1e-4)
        (dim,) = watch.commands[-1].layout.dim
        assert dim.label == 'flexor,extensor'
        assert watch.peer.get('pam_control', 'extensor.l0', 'radius') == [0.2, 0.05]
        assert 'does not exist here' not in sim.output
        # What is the simulator's alone is said to be so.
        (warning,) = (line for line in control.output.splitlines() if '[WARN]' in line)
        assert 'extensor.initial.pressure does not exist here' in warning


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

        assert peer.until(are_there, 'both')


def test_two_in_namespaces_do_not_disturb_each_other(peer):
    left = peer.collect(JointState, '/left/pam_control/state')
    right = peer.collect(JointState, '/right/pam_control/state')
    spaces = [('-r', f'__ns:=/{name}') for name in ('left', 'right')]
    programs = [
        Program(name, *space, parameters=START if name == 'pam_sim' else None)
        for space in spaces
        for name in ('pam_sim', 'pam_control')
    ]
    with programs[0], programs[1], programs[2], programs[3]:
        peer.more(left)
        peer.more(right)
        begin = right[-1].position[0]
        peer.publish(Float64(data=begin + 0.005), '/left/position_reference')
        peer.until(lambda: left[-1].position[0] > begin + 0.004, 'motion on the left')
        assert right[-1].position[0] == pytest.approx(begin, abs=1e-9)


REFUSED = [
    (['mass:=-3.0'], ['mass = -3.0', 'above 0']),
    (['rat:=100.0'], ['rat ', 'rate']),
    (['on_timeout:=explode'], ['on_timeout', 'vent', 'hold']),
    (['muscle:=dmsp_99'], ['dmsp_99', 'dmsp_20_400n']),
    (['gains.bandwidth:=100.0'], ['fast_bandwidth', 'bandwidth = 100']),
    (['rate:=20.0'], ['velocity_bandwidth', '20 Hz']),
    (['mass:=1e4'], ['mass']),
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
]


@pytest.mark.at_any_pace
@pytest.mark.usefixtures('domain')
def test_bad_arguments_end_it_with_a_sentence():
    refused = [
        ([part for value in values for part in ('-p', value)], named) for values, named in REFUSED
    ]
    check_refusals('pam_control', [*refused, (['--nonsense'], ['nonsense'])])
