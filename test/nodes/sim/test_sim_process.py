# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim`` as a process: names, neighbours, signals, exit codes, bad arguments."""

import signal
from time import sleep

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from support.ends import check_refusals
from support.harness import FreshProgram, has_loaded

pytestmark = [pytest.mark.at_any_pace, pytest.mark.usefixtures('domain')]


@pytest.mark.parametrize(
    ('kind', 'times'),
    [
        *[(signal.SIGINT, 1), (signal.SIGINT, 3), (signal.SIGTERM, 1)],
        *[(signal.SIGHUP, 1), (signal.SIGQUIT, 1)],
    ],
)
def test_a_signal_ends_it_cleanly(peer, kind, times):
    states = peer.collect(JointState, 'joint_states')
    with FreshProgram('pam_sim') as sim:
        peer.more(states)
        sim.interrupt(kind, times)
        assert sim.wait() == 0
        assert 'Traceback' not in sim.output


# Each has a peer of its own: a state of another simulator that waits in its queue would be taken
# for one of the new simulator, which does not listen to signals before it has begun.
@pytest.mark.parametrize('turn', range(3))
def test_signals_that_come_until_it_has_ended_do_not_change_how_it_ends(peer, turn):
    states = peer.collect(JointState, 'joint_states')
    with FreshProgram('pam_sim') as sim:
        peer.more(states)
        while sim.is_running:
            sim.interrupt()
            sleep(2e-3)
        assert sim.wait() == 0, sim.output


def test_a_signal_during_the_start_ends_it_cleanly():
    with FreshProgram('pam_sim') as sim:
        while not has_loaded(sim, 'numpy'):  # it is still importing
            assert sim.is_running
        sim.interrupt()
        assert sim.wait() == 0
        assert 'Traceback' not in sim.output


@pytest.mark.needs_numba
def test_a_signal_while_kernels_are_compiled_ends_it_before_they_are(tmp_path, monkeypatch):
    monkeypatch.setenv('NUMBA_CACHE_DIR', str(tmp_path))
    with FreshProgram('pam_sim') as sim:
        while 'this start takes longer' not in sim.output:
            assert sim.is_running
        assert sim.stop() == 0
        assert 'simulates' not in sim.output


REFUSED = [
    (['-p', 'mass:=-3.0'], ['mass = -3.0', 'above 0']),
    (['-p', 'mass:=heavy'], ['mass', 'heavy', 'above 0']),
    (['-p', 'mas:=20.0'], ['mas ', 'mass']),
    (['-p', 'sensor.latancy:=0.1'], ['sensor.latancy', 'sensor.latency']),
    (['-p', 'mount:=sideways'], ['mount', 'vertical', 'horizontal']),
    (['-p', 'muscle:=dmsp_99'], ['dmsp_99', 'dmsp_20_400n']),
    (['-p', 'a1:=[1.0, 2.0]'], ['a1', 'a finite number']),
    (['-p', 'publish_rate:=5000.0'], ['publish_rate', 'physics_rate']),
    (['-p', 'a3:=5.0'], ['stiffness']),
    (['-p', 'effects.nosuch.level:=3.0'], ['effects.nosuch', 'dead_time']),
    (['-p', 'effects.creep.zzz:=1.0'], ['effects.creep.zzz', 'give one of force']),
    (['-p', 'initial.creep.strain:=1.0'], ['initial.creep.strain', 'initial.pressure']),
    (['-p', 'effects.payload.mass:=-20.0'], ['effects.payload.mass = -20 kg', '-16 kg']),
    (['mass:=3.0'], ['mass:=3.0 is not a ROS argument', '-p before a parameter']),
    (
        ['-p', 'qos_overrides./joint_states.publisher.reliability:=sure'],
        ['reliability', 'sure'],
    ),
    (['-p', 'qos_overrides./joint_states.publisher.depth:=deep'], ['depth']),
    (['-p', 'mass'], ['mass']),
    (['--nonsense'], ['nonsense']),
    (['--', '-p', 'mass:=3'], ['-p mass:=3: parameters and remappings follow --ros-args']),
    (['-r', '__node:=1st'], ['1st']),
    (['--params-file', 'nowhere.yaml'], ['nowhere.yaml']),
]
BAD_FILES = [
    ('/**:\n  ros__parameters:\n    mass: -1.0\n', ['mass = -1.0']),
    ('/**:\n  ros__parameters:\n    mass: [1, a]\n', ['bad.yaml']),
    ('pam_sim:\n  mass: 20\n', ['bad.yaml']),
    ('/**: [\n', ['bad.yaml']),
    ('t,pressure_command_Pa\n0.0,1e5\n', ['bad.yaml is not a parameter file']),
    ('pam_sim:\n  ros__parameters:\n    damping_ratio: 1\n    zetta: 0.1\n', ['zeta']),
]


def test_bad_arguments_end_it_with_a_sentence():
    check_refusals('pam_sim', REFUSED)


def test_a_bad_parameter_file_ends_it_with_a_sentence(tmp_path):
    refused = []
    for i, (content, named) in enumerate(BAD_FILES):
        file = tmp_path / f'{i}_bad.yaml'
        file.write_text(content)
        refused.append((['--params-file', str(file)], named))
    check_refusals('pam_sim', refused)


def test_parameters_of_others_are_warned_of_and_passed_over(peer):
    states = peer.collect(JointState, 'joint_states')
    with FreshProgram('pam_sim', parameters={'robot_name': 'arm'}) as sim:
        peer.more(states)
        assert 'parameter robot_name does not exist here' in sim.output


def test_a_parameter_file_of_other_nodes_is_warned_of(peer, tmp_path):
    states = peer.collect(JointState, 'joint_states')
    file = tmp_path / 'others.yaml'
    file.write_text('pam_sim: {ros__parameters: {mass: 5.0}}\n')
    with FreshProgram('pam_sim', '-r', '__node:=plant', '--params-file', str(file)) as sim:
        peer.more(states)
        assert 'others.yaml has no parameters for /plant and is not used' in sim.output
        assert 'those that it has are for /pam_sim' in sim.output
    with FreshProgram('pam_sim', '--params-file', str(file)) as sim:
        peer.more(states)
        assert 'others.yaml' not in sim.output


def test_two_in_namespaces_and_remapped_do_not_disturb_each_other(peer):
    left = peer.collect(JointState, '/left/joint_states')
    right = peer.collect(JointState, '/right/load/state')
    pressure = peer.collect(FluidPressure, '/right/pressure')
    diagnostics = peer.collect(DiagnosticArray, '/diagnostics')
    a = FreshProgram('pam_sim', '-r', '__ns:=/left', parameters={'joint_name': 'one'})
    b = FreshProgram(
        'pam_sim',
        *('-r', '__ns:=/right', '-r', '__node:=plant', '-r', 'joint_states:=load/state'),
        *('-r', 'pressure_command:=valve'),
        parameters={'mass': 10.0, 'joint_name': 'two', 'command_timeout': 0.0},
    )
    with a, b:
        peer.more(left)
        peer.more(right)
        at_rest = left[-1].position[0]
        peer.publish(Float64(data=3e5), '/right/valve')
        peer.until(lambda: right[-1].position[0] > 0.05, 'motion on the right')
        assert left[-1].position[0] == pytest.approx(at_rest, abs=1e-12)
        assert peer.call(Trigger, '/right/plant/reset').success
        peer.until(lambda: pressure and pressure[-1].fluid_pressure == 101325.0, 'reset')
        assert peer.get('/left/pam_sim', 'mass') == [20.0]
        assert peer.get('/right/plant', 'mass') == [10.0]
        names = {'left/pam_sim: timing', 'right/plant: timing'}
        peer.until(lambda: names <= {s.name for m in diagnostics for s in m.status}, 'both names')
    assert {m.name[0] for m in left} == {'one'}
    assert {m.name[0] for m in right} == {'two'}


def test_quality_of_service_is_the_users_choice(peer):
    def quality(topic):
        peer.until(lambda: peer.node.get_publishers_info_by_topic(topic), topic)
        return peer.node.get_publishers_info_by_topic(topic)[0].qos_profile

    given = {'qos_overrides./joint_states.publisher.reliability': 'best_effort'}
    with FreshProgram('pam_sim', parameters=given):
        assert quality('/joint_states').reliability == ReliabilityPolicy.BEST_EFFORT
        for topic in ('/pressure', '/force', '/stiffness', '/damping'):
            assert quality(topic).reliability == ReliabilityPolicy.RELIABLE
            assert quality(topic).durability == DurabilityPolicy.VOLATILE


def test_joint_states_are_complete(peer):
    states = peer.collect(JointState, 'joint_states')
    with FreshProgram('pam_sim', parameters={'frame_id': 'rig'}):
        peer.more(states)
    message = states[-1]
    assert message.header.frame_id == 'rig'
    assert [
        len(x) for x in (message.name, message.position, message.velocity, message.effort)
    ] == [1] * 4
