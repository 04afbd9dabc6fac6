# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A rig refuses a step that does not resolve its motion; what it accepts stays finite."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.equilibrium import rest_position
from pam_ros.rig.loads import Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.step_limit import longest_step


def state(rig):
    return np.concatenate([rig.position, rig.velocity, rig.pressure, *rig.muscle_outputs()])


@pytest.mark.parametrize(
    ('step', 'sentence'),
    [
        (0.0, 'a physics step of 0 s is not allowed: give more than 0'),
        (-1e-3, 'a physics step of -0.001 s is not allowed: give more than 0'),
        (float('nan'), 'step = nan is not allowed: give a finite number'),
        (0.02, 'a physics step of 20 ms does not resolve a mass of 20 kg on this muscle: give at'),
    ],
)
def test_a_step_that_resolves_nothing_is_refused(step, sentence):
    with pytest.raises(ParameterError) as error:
        Simulation([single_muscle_joint()], step)
    assert str(error.value).startswith(sentence)


constants = st.tuples(
    st.floats(-8.0, 4.0),
    st.floats(100.0, 500.0),
    st.floats(-0.6, -0.1),
    st.floats(-14.0, -2.0),
    st.floats(80.0, 500.0),
    st.floats(-500.0, 100.0),
)


@settings(deadline=None, max_examples=150)
@given(
    constants,
    st.floats(0.1, 5.0),
    st.floats(0.03, 3.0),
    st.floats(0.01, 100.0),
    st.sampled_from(['vertical', 'horizontal']),
    st.lists(st.tuples(st.floats(0.0, 6e5), st.integers(1, 300)), min_size=1, max_size=6),
    st.floats(0.0, 6e5),
)
def test_no_rig_that_is_accepted_gives_nan(a, zeta, l0, mass, mount, commands, start):
    names = ('a1', 'a2', 'a3', 'a4', 'a5', 'a6')
    try:
        muscle = Muscle(**dict(zip(names, a, strict=True)), zeta=zeta, l0=l0)
        model = single_muscle_joint(muscle, Mass(mass=mass, mount=mount))
    except ParameterError:
        return
    rig = Simulation([model], longest_step(model))
    rig.reset([start], [rest_position(model, start)], [0.0])
    for p, steps in commands:
        rig.command(p)
        rig.advance(steps)
        assert np.all(np.isfinite(state(rig)))
        assert abs(rig.position[0]) < l0


@settings(deadline=None, max_examples=50)
@given(st.floats(0.0, 6e5), st.floats(0.0, 6e5), st.floats(0.01, 100.0), st.floats(0.03, 3.0))
def test_nor_does_one_without_damping_after_a_step(p0, p1, mass, l0):
    try:
        model = single_muscle_joint(Muscle(zeta=0.0, l0=l0), Mass(mass=mass))
    except ParameterError:
        return
    rig = Simulation([model], longest_step(model))
    rig.reset([p0], [rest_position(model, p0)], [0.0])
    rig.command(p1)
    rig.advance(2000)
    assert np.all(np.isfinite(state(rig)))
    assert abs(rig.position[0]) < l0
