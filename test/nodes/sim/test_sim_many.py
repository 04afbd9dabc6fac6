# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Several muscles and joints of two in one ``pam_sim``, over DDS."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, Float64MultiArray
from std_srvs.srv import SetBool, Trigger

from pam_ros.effects import PressureLag, ViscousFriction
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm as ArmLoad
from pam_ros.rig.loads import Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.transmissions import Pulley
from support.ends import check_refusals
from support.harness import Program

pytestmark = [pytest.mark.at_any_pace, pytest.mark.usefixtures('domain')]

AMBIENT = 101325.0
PERIODS = 60
STILL = {'time_mode': 'lockstep', 'command_timeout': 0.0}


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


class Arm:
    """Answers each new state with pressures for all muscles, and keeps what was said."""

    def __init__(self, peer):
        self.peer, self.seen = peer, 0
        self.states = peer.collect(JointState, 'joint_states')
        names = ('pressures', 'forces', 'stiffnesses', 'dampings')
        self.arrays = {name: peer.collect(Float64MultiArray, name) for name in names}

    def after(self, time, pressures):
        """Return the state after *time*; if the one before is published again, answer it again."""
        is_repeated = len(self.states) > self.seen and stamp(self.states[-1]) == time
        self.seen = len(self.states)
        if is_repeated:
            self.peer.publish(Float64MultiArray(data=pressures), 'pressure_commands')
        return next((m for m in self.states if stamp(m) > time), None)

    def run(self, pressures, periods=PERIODS):
        """Return the states of so many periods of constant pressures, and the one after."""
        received, found = 0, []
        for _ in range(periods + 1):
            state = self.peer.until(lambda t=received: self.after(t, pressures), 'the next state')
            received, self.seen = stamp(state), len(self.states)
            found.append(state)
            if len(found) <= periods:
                self.peer.publish(Float64MultiArray(data=pressures), 'pressure_commands')
        return found

    def last(self, name):
        messages = self.arrays[name]
        self.peer.until(lambda: messages, f'{name}')
        return list(messages[-1].data)

    def comes_to(self, name, values):
        """Wait until the last message holds *values*, to the bit: topics come in no order."""
        wanted = values.tolist()
        self.peer.until(lambda: self.last(name) == wanted, f'{name} {wanted}')


def simulated(models, pressures, periods=PERIODS):
    """Return a rig after the same run."""
    rig = Simulation(models, 1e-3)
    rig.reset(0.0, [equilibrium(joint, 0.0) for joint in models], 0.0)
    rig.command(pressures)
    for _ in range(periods):
        rig.advance(2)
    return rig


def is_as(arm, states, rig):
    """Assert that the last state and arrays are those of *rig*, to the bit."""
    assert list(states[-1].position) == rig.position.tolist()
    assert list(states[-1].velocity) == rig.velocity.tolist()
    assert list(states[-1].effort) == rig.joint_outputs().effort.tolist()
    force, stiffness, damping, _ = rig.muscle_outputs()
    arm.comes_to('pressures', rig.pressure + AMBIENT)
    arm.comes_to('forces', force)
    arm.comes_to('stiffnesses', stiffness)
    arm.comes_to('dampings', damping)


def test_each_muscle_has_its_own_parameters_and_the_common_ones_otherwise(peer):
    names = ['left', 'mid', 'right']
    arm = Arm(peer)
    given = {
        **STILL,
        'muscles': names,
        'mass': 15.0,
        'left.mass': 7.0,
        'mid.a1': -4.0,
        'mid.mount': 'horizontal',
        'right.effects.viscous_friction.coefficient': 30.0,
    }
    pressures = [3e5, 2e5, 4e5]
    with Program('pam_sim', parameters=given):
        states = arm.run(pressures)
        models = [
            single_muscle_joint(load=Mass(mass=7.0)),
            single_muscle_joint(Muscle(a1=-4.0), Mass(mass=15.0, mount='horizontal')),
            single_muscle_joint(load=Mass(mass=15.0), effects=[ViscousFriction(coefficient=30.0)]),
        ]
        is_as(arm, states, simulated(models, pressures))
        assert states[-1].name == names
        (dim,) = arm.arrays['forces'][-1].layout.dim
        assert (dim.label, dim.size) == ('left,mid,right', 3)
        # A name's own values stay its own; the others follow.
        assert peer.set_one('pam_sim', mass=12.0).successful
        assert peer.set_one('pam_sim', left__mass=8.0).successful
        refused = peer.set_one('pam_sim', left__mass=-1.0)
        assert not refused.successful
        assert 'left.mass' in refused.reason


def test_a_muscle_of_a_name_comes_from_its_own_file(peer):
    arm = Arm(peer)
    given = {**STILL, 'muscles': ['a', 'b'], 'b.muscle': 'dmsp_10', 'b.mass': 5.0}
    with Program('pam_sim', parameters=given):
        arm.run([0.0, 0.0], 1)
        assert peer.get('pam_sim', 'b.l0', 'l0', 'b.mass', 'mass') == [0.25, 0.4, 5.0, 20.0]


def test_an_antagonistic_pair_is_an_angle_in_rad(peer):
    arm = Arm(peer)
    given = {
        **STILL,
        'joint': 'antagonistic',
        'radius': 0.05,
        'mass': 0.8,
        'effects.viscous_friction.coefficient': 0.3,  # of the pivot
        'pam_2.effects.pressure_lag.fill': 0.02,
    }
    pressures = [4e5, 2.5e5]
    with Program('pam_sim', parameters=given):
        states = arm.run(pressures)
        lag = [PressureLag(fill=0.02)]
        pair = Joint(
            (Actuator(contraction=0.1), Actuator(effects=lag, contraction=0.1)),
            ArmLoad(mass=0.8),
            Pulley(radius=0.05),
            [ViscousFriction(coefficient=0.3)],
        )
        is_as(arm, states, simulated([pair], pressures))
    assert states[-1].name == ['pam']
    force = arm.last('forces')
    assert states[-1].effort[0] == pytest.approx(0.05 * (force[0] - force[1]), rel=1e-12)
    assert states[-1].position[0] > 0.05


def test_a_mass_on_two_muscles(peer):
    arm = Arm(peer)
    given = {**STILL, 'joint': 'parallel', 'muscles': ['a', 'b'], 'mass': 40.0}
    with Program('pam_sim', parameters=given):
        states = arm.run([3e5, 2e5])
        rig = simulated([Joint((Actuator(), Actuator()), Mass(mass=40.0))], [3e5, 2e5])
        is_as(arm, states, rig)
    assert states[-1].name == ['pam']


def test_several_pairs_have_names_and_starts_of_their_own(peer):
    arm = Arm(peer)
    given = {
        **STILL,
        'joint': 'antagonistic',
        'muscles': ['s1', 's2', 'e1', 'e2'],
        'joint_names': ['shoulder', 'elbow'],
        'initial.pressure': 2e5,
        'elbow.initial.at_rest': False,
        'elbow.initial.position': 0.3,
        'shoulder.arm': 0.3,
    }
    with Program('pam_sim', parameters=given):
        first, *_ = arm.run([2e5] * 4, 1)
    assert first.name == ['shoulder', 'elbow']
    assert first.position[0] == pytest.approx(0.0, abs=1e-9)
    assert first.position[1] == 0.3


def test_topics_of_each_muscle_are_those_of_one_alone(peer):
    arm = Arm(peer)
    given = {**STILL, 'muscles': ['left', 'right'], 'muscle_topics': True}
    own = peer.collect(JointState, 'right/joint_states')
    pressure = peer.collect(FluidPressure, 'right/pressure')
    values = {n: peer.collect(Float64, f'right/{n}') for n in ('force', 'stiffness', 'damping')}
    with Program('pam_sim', parameters=given):
        states = arm.run([1e5, 3e5], 20)
        peer.until(lambda: own and stamp(own[-1]) == stamp(states[-1]), 'its state')
        peer.until(
            lambda: pressure and pressure[-1].fluid_pressure == 3e5 + AMBIENT, 'its pressure'
        )
        for messages in values.values():
            peer.until(lambda m=messages: m, 'its floats')
    assert own[-1].name == ['right']
    assert own[-1].position[0] == states[-1].position[1]
    assert own[-1].effort[0] == states[-1].effort[1]


def test_bad_values_leave_their_muscle_as_it_is_and_are_named(peer):
    arm = Arm(peer)
    diagnostics = peer.collect(DiagnosticArray, '/diagnostics')
    with Program('pam_sim', parameters={**STILL, 'muscles': ['a', 'b']}) as sim:
        arm.run([2e5, 2e5], 2)
        peer.publish(Float64MultiArray(data=[math.nan, 9e5]), 'pressure_commands')

        def counted():
            values = {v.key: v.value for m in diagnostics[-1:] for s in m.status for v in s.values}
            return (values.get('refused'), values.get('clamped')) == ('1', '1')

        peer.until(counted, 'both counted')
        peer.publish(Float64MultiArray(data=[math.nan, 9e5]), 'pressure_commands')
        peer.until(lambda: arm.last('pressures') == [2e5 + AMBIENT, 6e5 + AMBIENT], 'limits')
        assert 'b: pressure command 900000 Pa is outside' in sim.output


def test_silence_of_one_vents_it_alone(peer):
    given = {'muscles': ['a', 'b'], 'muscle_topics': True, 'command_timeout': 0.5}
    pressures = peer.collect(Float64MultiArray, 'pressures')
    diagnostics = peer.collect(DiagnosticArray, '/diagnostics')
    with Program('pam_sim', parameters=given):
        peer.more(pressures)

        def b_is_heard():
            peer.publish(Float64(data=3e5), 'b/pressure_command')
            peer.work(0.02)
            return pressures[-1].data[1] == 3e5 + AMBIENT

        assert peer.until(b_is_heard, 'b to be heard')

        def only_b_is_vented():
            peer.publish(Float64(data=2e5), 'a/pressure_command')
            peer.work(0.02)
            return list(pressures[-1].data) == [2e5 + AMBIENT, AMBIENT]

        assert peer.until(only_b_is_vented, 'b to vent')

        def b_is_named():
            # While a is still received: if both were missing, both would be named.
            peer.publish(Float64(data=2e5), 'a/pressure_command')
            peer.work(0.02)
            return any('for b ' in s.message for m in diagnostics for s in m.status)

        assert peer.until(b_is_named, 'its name')


def test_pause_step_and_reset_are_for_all_of_them(peer):
    arm = Arm(peer)
    given = {**STILL, 'muscles': ['a', 'b'], 'step_periods': 5}
    with Program('pam_sim', parameters=given):
        before = arm.run([2e5, 3e5], 3)[-1]
        assert peer.call(SetBool, 'pam_sim/pause', data=True).success
        assert peer.call(Trigger, 'pam_sim/step').success
        peer.until(lambda: stamp(arm.states[-1]) == stamp(before) + 5 * 2_000_000, 'five periods')
        assert peer.call(Trigger, 'pam_sim/reset').success
        at_rest = equilibrium(single_muscle_joint(), 0.0)
        peer.until(lambda: list(arm.states[-1].position) == [at_rest] * 2, 'the start')


REFUSED = [
    (['-p', 'muscles:=[a, a]'], ['muscles', 'a is named twice']),
    (['-p', 'muscles:=[mass, b]'], ['mass is the name of a parameter']),
    (['-p', 'muscles:=["a b", c]'], ["'a b' is not a valid name"]),
    (['-p', 'muscles:=[a]', '-p', 'joint:=parallel'], ['1 names', 'parallel', '2 for each']),
    (['-p', 'muscles:=[a, b]', '-p', 'a.mas:=3.0'], ['a.mas', 'a.mass']),
    (['-p', 'muscles:=[a, b]', '-p', 'a.colour:=3.0'], ['a.colour']),
    (['-p', 'muscles:=[a, b]', '-p', 'b.mass:=-3.0'], ['b.mass = -3']),
    (['-p', 'muscles:=[a, b]', '-p', 'b.muscle:=dmsp_99'], ['dmsp_99']),
    (['-p', 'joint:=knee'], ['knee', 'antagonistic']),
    (['-p', 'time_mode:=fast'], ['fast', 'lockstep']),
    (['-p', 'speed_factor:=0.05'], ['speed_factor = 0.05', '0.1 or more']),
    (['-p', 'joint:=antagonistic', '-p', 'radius:=0.0'], ['radius', '0.0001 to 1 m']),
]


def test_what_makes_no_scene_ends_it_with_a_sentence():
    check_refusals('pam_sim', REFUSED)
