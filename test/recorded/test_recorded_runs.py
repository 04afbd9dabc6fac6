# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs are those that version 0.1.0 made, to the bit.

``runs.npz`` holds what it simulated of the cases in ``cases.py``; see ``platform.py`` for other
platforms.
"""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import CoulombFriction, ViscousFriction
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import statics
from pam_ros.rig.acting import acting_commands, delays_of
from pam_ros.rig.bind import bind
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.start import start_state
from pam_ros.rig.step_limit import longest_step
from pam_ros.rig.transmissions import Pulley, Straight
from recorded import cases
from recorded.former import effects_of_0_1_0
from recorded.platform import compare

# Plain Python is compared with what is compiled elsewhere.
pytestmark = pytest.mark.needs_numba
RIGS = cases.single_muscle_joint()
BY_RIG = pytest.mark.parametrize('name', RIGS)


def model(name):
    rig = RIGS[name]
    return single_muscle_joint(
        Muscle(**rig['muscle']), Mass(**rig['load']), effects_of_0_1_0(rig['effects'])
    )


def without_drag(joint):
    """Return *joint* without friction on it, which 0.1.0 left out of the force of held runs."""
    dragged = {effect.name for effect in joint.library if effect.equations.drag is not None}
    return replace(joint, effects=[e for e in joint.effects if e.name not in dragged])


def stepped(joints, muscles, seed=3):
    """Step a rig under commands, some of all muscles and some of one; return rows of all."""
    rig = Simulation(joints, cases.STEP)
    random = np.random.default_rng(seed)
    rows = []
    for k in range(60):
        if k % 3 == 0:
            rig.command(random.uniform(0.5e5, 5.5e5, muscles))
        elif k % 3 == 1:
            rig.command_one(int(random.integers(muscles)), float(random.uniform(0.5e5, 5.5e5)))
        rig.advance(int(random.integers(1, 60)))
        rows.append(
            np.concatenate(
                [
                    rig.position,
                    rig.velocity,
                    rig.pressure,
                    rig.contraction,
                    np.ravel(rig.muscle_outputs(), order='F'),
                    np.ravel(rig.joint_outputs(), order='F'),
                ]
            )
        )
    return np.array(rows)


def columns(run):
    return np.array([run.position, run.velocity, run.pressure, run.force])


@BY_RIG
def test_one_muscle_is_stepped_as_ever(name):
    compare(f'stepped/{name}', stepped([model(name)], 1))


def test_several_muscles_with_their_loads_are_stepped_as_ever():
    joints = [model('plain'), model('all'), model('dmsp_10')]
    compare('stepped/three', stepped(joints, 3))


@BY_RIG
def test_one_muscle_runs_over_stamps_as_ever(name):
    at, u = cases.commands()
    run = simulate(model(name), cases.stamps(), at, u, position=0.05, velocity=0.01)
    compare(f'free/{name}', columns(run))


def test_a_drive_without_a_muscle_runs_as_ever():
    effects = [ViscousFriction(coefficient=200.0), CoulombFriction(level=20.0)]
    drive = single_muscle_joint(Muscle(**cases.DRIVE), Mass(95.0, 'horizontal'), effects)
    at, u = cases.commands()
    compare('free/drive', columns(simulate(drive, cases.stamps(), at, u * 1e-5 - 3, position=0.0)))


def test_the_law_of_dahl_runs_as_ever_but_for_roundings():
    at, u = cases.commands()
    dahl = single_muscle_joint(Muscle(), Mass(20.0), effects_of_0_1_0(cases.DAHL))
    run = simulate(dahl, cases.stamps(), at, u, position=0.05, velocity=0.01)
    compare('free/dahl', columns(run), to_the_bit=False)


@BY_RIG
def test_a_held_muscle_pulls_as_ever(name):
    t = cases.stamps()
    y, v, p = cases.motion(t)
    compare(f'held/{name}', columns(simulate_held(without_drag(model(name)), t, p, y, v)))


@BY_RIG
def test_accelerations_along_a_motion_are_as_ever(name):
    joint = model(name)
    at, u = cases.commands()
    t = cases.stamps()
    y, v, _ = cases.motion(t)
    q = joint.parameters()
    x = start_state(joint.layout, q, u[:1], y[0], v[0])
    out = np.empty((t.size - 1, 2))
    acts = [at + delay for delay in delays_of(joint.layout, q)]
    at, u = acting_commands(acts, u[:, None])
    kernel = bind(joint.layout, joint.active)
    kernel.simulate_along(x, joint.layout.scratch(), q, t, y, v, at, u, out)
    compare(f'along/{name}', out)


@BY_RIG
def test_rest_step_and_weight_of_one_muscle_are_as_ever(name):
    joint = model(name)
    weight = float(statics.weight(joint, 0.0))
    found = equilibrium(joint, 3e5), longest_step(joint), joint.moved_mass, weight
    compare(f'rest/{name}', np.array(found))


# Joints of two muscles ---------------------------------------------------------------------------


def pair(in_muscles, on_joint):
    actuator = Actuator(Muscle(), effects_of_0_1_0(in_muscles), 0.1)
    return Joint((actuator, actuator), Arm(), Pulley(), effects_of_0_1_0(on_joint))


def parallel(in_muscles, on_joint):
    effects = effects_of_0_1_0(in_muscles)
    actuators = (Actuator(Muscle(), effects, 0.05), Actuator(Muscle(l0=0.38), effects))
    return Joint(actuators, Mass(mass=40.0), Straight(), effects_of_0_1_0(on_joint))


JOINTS = {
    'pair all': pair(cases.MUSCLE_EFFECTS, cases.TURNED_EFFECTS),
    'parallel all': parallel(cases.MUSCLE_EFFECTS, cases.JOINT_EFFECTS),
}


@pytest.mark.parametrize('name', JOINTS)
def test_joints_of_two_muscles_move_as_ever(name):
    compare(f'joint/{name}', stepped([JOINTS[name]], 2))


@pytest.mark.parametrize(
    ('name', 'joint'), [('pair all', JOINTS['pair all']), ('parallel', parallel({}, {}))]
)
def test_rest_and_step_of_two_muscles_are_as_ever(name, joint):
    found = equilibrium(joint, (3e5, 2e5)), longest_step(joint), joint.moved_mass, joint.inertia
    compare(f'joint rest/{name}', np.array([*found, *statics.span(joint)]))
