# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The observer against the linear theory that its docstring states."""

import math

import numpy as np
import pytest

from pam_ros.control.model import ControlModel
from pam_ros.control.observer import Observer
from pam_ros.rig.equilibrium import equilibrium
from pam_ros.rig.loads import Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from support.bench import cart

DT = 2e-3


def test_a_constant_force_is_found_and_leaves_no_bias():
    joint = single_muscle_joint(load=Mass(mass=20.0))
    rig, model = Simulation([joint]), ControlModel(joint)
    rig.reset([300e3], [equilibrium(joint, 300e3)], [0.0])
    observer = Observer(model)
    observer.start(rig.position[0], 0.0)
    # The controller believes in 10 kPa more than there are: a force of -10 kPa dF/dp.
    for _ in range(3000):
        observer.predict(DT, (310e3,))
        rig.advance(2)
        observer.correct(rig.position[0], DT, 126.0, 4.0)
    y = rig.position[0]
    expected = model.effort((300e3,), y) - model.effort((310e3,), y)
    assert observer.disturbance == pytest.approx(expected, rel=1e-6)
    assert observer.position == pytest.approx(rig.position[0], abs=1e-9)
    assert observer.velocity == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(('fast', 'slow'), [(126.0, 4.0), (60.0, 60.0), (250.0, 14.0)])
def test_the_poles_are_where_they_shall_be(fast, slow):
    model = ControlModel(cart())

    def one_step(state):
        observer = Observer(model)
        observer.position, observer.velocity, observer.disturbance = state
        observer.predict(DT, (0.0,))
        observer.correct(0.0, DT, fast, slow)
        return np.array([observer.position, observer.velocity, observer.disturbance])

    matrix = np.column_stack([one_step(column) for column in np.eye(3)])
    found = np.sort(np.linalg.eigvals(matrix).real)
    expected = np.sort([math.exp(-fast * DT), math.exp(-fast * DT), math.exp(-slow * DT)])
    np.testing.assert_allclose(found, expected, atol=2e-5)
