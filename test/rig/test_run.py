# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulation over given stamps, against closed forms that know each command's very moment."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import one_muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.rest import rest
from pam_ros.rig.run import simulate, simulate_held
from support import paper

# A force source of 1 N/Pa and a mass of 2 kg: y'' = p/2 has parabolas for solutions, exactly.
SOURCE = Muscle(
    a1=0.0, a2=0.0, a3=0.0, a4=0.0, a5=1.0, a6=0.0,
    pressure_unit='Pa', zeta=0.0, p_min=-1e3, p_max=1e3, force_max=1e3,
)  # fmt: skip
FREE = Mass(mass=2.0, mount='horizontal')


def parabolas(t, command_t, command, y, v, delay=0.0):
    """Return y and v of the free mass at the stamps t, piece by piece."""
    edges = np.asarray(command_t)[1:] + delay
    found, now, i = [], t[0], 0
    while i < len(edges) and edges[i] < t[0]:
        i += 1
    for stamp in t:
        while i < len(edges) and edges[i] < stamp:
            h, a = edges[i] - now, command[i] / 2.0
            y, v, now, i = y + h * v + 0.5 * a * h * h, v + a * h, edges[i], i + 1
        h, a = stamp - now, command[i] / 2.0
        y, v, now = y + h * v + 0.5 * a * h * h, v + a * h, stamp
        found.append((y, v))
    return np.array(found).T


# In whole microseconds: a command within 1 ns of a sample may act beside it.
stamp = st.integers(0, 100_000).map(lambda n: n * 1e-6)
stamps = st.lists(stamp, min_size=1, max_size=12).map(sorted)


@settings(deadline=None)
@given(stamps, stamps, st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.004, 0.0137]))
def test_commands_act_at_their_very_stamps(t, command_t, seed, delay):
    command = np.random.default_rng(seed).uniform(-100.0, 100.0, len(command_t))
    model = one_muscle(SOURCE, FREE, {'dead_time': {'delay': delay}})
    found = simulate(model, t, command_t, command, position=0.3, velocity=-0.1)
    y, v = parabolas(t, command_t, command, 0.3, -0.1, delay)
    np.testing.assert_allclose(found.position, y, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(found.velocity, v, rtol=0.0, atol=1e-12)


def test_a_sample_is_the_state_before_the_command_of_its_stamp():
    t = [0.0, 0.1, 0.2]
    found = simulate(one_muscle(SOURCE, FREE), t, [0.0, 0.1], [0.0, 40.0], position=0.0)
    np.testing.assert_allclose(found.position, [0.0, 0.0, 0.1], atol=1e-15)
    np.testing.assert_array_equal(found.pressure, [0.0, 0.0, 40.0])
    np.testing.assert_array_equal(found.force, [0.0, 0.0, 40.0])


def test_viscous_friction_follows_its_exponential():
    """2 y'' = p - c y' with c = 5: v = p/c (1 - exp(-c t / m)); the step divides nothing."""
    model = one_muscle(SOURCE, FREE, {'viscous_friction': {'coefficient': 5.0}})
    t = np.array([0.0, 0.0123, 0.5, 0.50031, 2.0])
    found = simulate(model, t, [0.0], [30.0], position=0.0)
    rate, end = 5.0 / 2.0, 30.0 / 5.0
    np.testing.assert_allclose(found.velocity, end * (1.0 - np.exp(-rate * t)), atol=1e-11)
    y = end * (t - (1.0 - np.exp(-rate * t)) / rate)
    np.testing.assert_allclose(found.position, y, atol=1e-11)


def test_it_starts_at_rest_under_the_command_in_force():
    """Commands before the first sample: the last of them is in force, and a lag has followed."""
    lag = {'pressure_lag': {'fill': 0.1, 'vent': 0.1}}
    for effects in ({}, lag):
        model = one_muscle(effects=effects)
        found = simulate(model, [5.0, 5.5], [1.0, 2.0, 6.0], [1e5, 3e5, 6e5])
        np.testing.assert_allclose(found.pressure, 3e5)
        np.testing.assert_allclose(found.position, rest(model, 3e5), atol=1e-12)


def test_a_late_command_is_not_yet_in_force_at_the_start():
    model = one_muscle(effects={'dead_time': {'delay': 0.3}})
    found = simulate(model, [2.2, 2.3, 2.4], [1.0, 2.0], [1e5, 3e5])
    np.testing.assert_array_equal(found.pressure, [1e5, 1e5, 3e5])


def test_force_is_the_pull_less_the_damping():
    t = np.linspace(0.0, 0.3, 31)
    found = simulate(one_muscle(), t, [0.0], [4e5], position=0.05, velocity=0.2)
    for i in range(len(t)):
        kappa = 100.0 * found.position[i] / paper.L0
        c = paper.damping(4.0, kappa, 20.0, 0.15)
        expected = paper.force(4.0, kappa) - c * found.velocity[i]
        assert found.force[i] == pytest.approx(expected, abs=1e-8)


def test_a_step_that_is_too_long_is_refused_with_a_sentence():
    with pytest.raises(ParameterError) as error:
        simulate(one_muscle(), [0.0, 1.0], [0.0], [0.0], step=0.02)
    assert str(error.value) == (
        'a physics step of 20 ms does not resolve a mass of 20 kg on this muscle: give at least '
        '148 steps a second, or more mass'
    )


def test_a_held_rig_gives_the_force_of_the_law():
    """Length and pressure prescribed: equation (1) less (4) times the velocity."""
    t = np.linspace(0.0, 2.0, 201)
    p = 3e5 + 1e5 * np.sin(3.0 * t)
    y = 0.05 + 0.02 * np.sin(2.0 * t)
    found = simulate_held(one_muscle(), t, p, y)
    v = np.gradient(y, t)
    for i in range(len(t)):
        kappa = 100.0 * y[i] / paper.L0
        c = paper.damping(p[i] / 1e5, kappa, 20.0, 0.15)
        expected = paper.force(p[i] / 1e5, kappa) - c * v[i]
        assert found.force[i] == pytest.approx(expected, abs=1e-8)
    np.testing.assert_array_equal(found.position, y)
    np.testing.assert_array_equal(found.velocity, v)
    np.testing.assert_array_equal(found.pressure, p)


def test_a_held_rig_takes_a_given_velocity():
    t, p, y = [0.0, 0.1], [2e5, 2e5], [0.02, 0.02]
    still = simulate_held(one_muscle(), t, p, y)
    moving = simulate_held(one_muscle(), t, p, y, velocity=[0.0, 0.5])
    c = paper.damping(2.0, 5.0, 20.0, 0.15)
    np.testing.assert_allclose(moving.force - still.force, [0.0, -0.5 * c], atol=1e-9)
