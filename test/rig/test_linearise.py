# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Linear models: equations (2) and (4), and the response to small steps, by scipy."""

import numpy as np
import pytest
from scipy.signal import StateSpace, lsim

from pam_ros.effects import (
    CoulombFriction,
    Creep,
    DeadTime,
    EndStop,
    Leak,
    LengthOffset,
    Payload,
    PeriodicDisturbance,
    PressureLag,
    PressureOffset,
    Slack,
    ViscousFriction,
)
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.linearise import linearise
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from pam_ros.rig.transmissions import Pulley
from support import bench
from support.joint_models import lever

T = np.linspace(0.0, 1.5, 301)
LAG = PressureLag(fill=0.05, vent=0.05)


def test_one_muscle_is_that_of_the_equations_of_the_paper():
    p, mass = 3e5, bench.MASS
    model = linearise(bench.hanging(), p)
    y = bench.rest(p)
    assert model.position == pytest.approx(y, rel=1e-9)
    dy, dp = 1e-6, 10.0
    k = (bench.pull(p, y - dy) - bench.pull(p, y + dy)) / (2.0 * dy)
    gain = (bench.pull(p + dp, y) - bench.pull(p - dp, y)) / (2.0 * dp)
    damping = 2.0 * bench.ZETA * np.sqrt(k * mass)
    np.testing.assert_allclose(
        model.A, [[0.0, 1.0], [-k / mass, -damping / mass]], rtol=1e-6, atol=1e-9
    )
    np.testing.assert_allclose(model.B, [[0.0], [gain / mass]], rtol=1e-6)
    np.testing.assert_array_equal(model.C, [[1.0, 0.0]])
    np.testing.assert_array_equal(model.D, [[0.0]])
    assert model.states == ('position', 'velocity')
    assert model.left_out == ()


def elbow(*effects):
    return antagonistic_joint(radius=0.04, load=Arm(mass=1.0, arm=0.25), effects=effects)


JOINTS = {
    'one muscle': (single_muscle_joint(), [3e5]),
    'payload and friction': (
        single_muscle_joint(effects=[Payload(mass=5.0), ViscousFriction(coefficient=60.0)]),
        [3e5],
    ),
    'offsets': (
        single_muscle_joint(
            effects=[PressureOffset(offset=2e4, gain=0.1), LengthOffset(offset=0.01)]
        ),
        [3e5],
    ),
    'lag behind an offset': (
        single_muscle_joint(effects=[PressureOffset(gain=0.1), LAG]),
        [3e5],
    ),
    'on a stop': (single_muscle_joint(effects=[EndStop(upper=0.1, stiffness=1e4)]), [3e5]),
    'without gravity': (single_muscle_joint(load=Mass(5.0, 'horizontal')), [1e5]),
    'pair': (elbow(), [3e5, 2e5]),
    'pair with lags': (elbow(LAG, Slack(share=1.0)), [3e5, 2e5]),
    'one of two is slow': (
        Joint(
            (Actuator(Muscle(), [LAG], 0.1), Actuator(Muscle(), [], 0.1)),
            Arm(mass=1.0, arm=0.25),
            Pulley(radius=0.04),
        ),
        [3e5, 2e5],
    ),
    'lever': (lever(), [3e5, 2e5]),
}


@pytest.mark.needs_numba
@pytest.mark.parametrize(
    ('name', 'muscle'), [(name, i) for name, (_, p) in JOINTS.items() for i in range(len(p))]
)
def test_a_small_step_of_one_pressure_moves_the_joint_as_the_linear_model_says(name, muscle):
    joint, pressure = JOINTS[name]
    model = linearise(joint, pressure)
    step = np.zeros(len(pressure))
    step[muscle] = 20.0
    _, y, _ = lsim(StateSpace(*model), np.tile(step, (T.size, 1)), T)
    run = simulate(
        joint, T, [pressure, pressure + step], [0.0, 1e-9], position=model.position, step=2.5e-4
    )
    moved = run.position - model.position
    assert np.ptp(moved) > 1e-7
    np.testing.assert_allclose(moved, np.ravel(y), atol=2e-3 * np.max(np.abs(moved)))


def test_effects_with_a_memory_are_left_out_and_named():
    effects = [
        *(DeadTime(delay=0.01), LAG, Leak(rate=0.1), Creep(force=0.05)),
        *(CoulombFriction(level=8.0), PeriodicDisturbance(force_sin=3.0), Payload(mass=2.0)),
    ]
    model = linearise(single_muscle_joint(effects=effects), 3e5)
    alone = linearise(single_muscle_joint(effects=[LAG, Payload(mass=2.0)]), 3e5)
    np.testing.assert_array_equal(model.A, alone.A)
    assert set(model.left_out) == {
        *('dead_time', 'leak', 'creep', 'coulomb_friction', 'periodic_disturbance'),
    }
    assert alone.left_out == ()


def test_a_lag_has_the_mean_of_its_time_constants():
    model = linearise(single_muscle_joint(effects=[PressureLag(fill=0.04, vent=0.08)]), 3e5)
    assert model.states == ('position', 'velocity', 'pressure_1')
    assert model.A[2, 2] == pytest.approx(-1.0 / 0.06)
    assert model.B[2, 0] == pytest.approx(1.0 / 0.06)


def test_a_known_force_has_no_spring():
    force = Muscle(0.0, 0.0, 0.0, 0.0, 35.0, 0.0, zeta=0.0, pressure_unit='Pa', p_max=10.0)
    model = linearise(single_muscle_joint(force, Mass(5.0, 'horizontal')), 0.0)
    np.testing.assert_allclose(model.A, [[0.0, 1.0], [0.0, 0.0]], atol=1e-9)
    np.testing.assert_allclose(model.B, [[0.0], [7.0]])


@pytest.mark.parametrize(
    ('joint', 'pressure', 'sentence'),
    [
        ('dmsp_20', 3e5, 'joint = .* give a Joint'),
        (single_muscle_joint(), [3e5, 2e5], 'pressure'),
        (single_muscle_joint(), np.nan, 'pressure = nan'),
        (single_muscle_joint(effects=[Payload(mass=1.0, onset=2.0)]), 3e5, 'onset'),
    ],
)
def test_what_has_no_linear_model_is_refused(joint, pressure, sentence):
    with pytest.raises(ParameterError, match=sentence):
        linearise(joint, pressure)
