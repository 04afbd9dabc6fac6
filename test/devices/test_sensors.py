# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Sensors against closed forms: a known motion, late, noisy, in steps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.devices.sensors import FORCE, POSITION, PRESSURE, VELOCITY, Feedback, Sensors
from pam_ros.errors import ParameterError

H = 2e-3  # s between samples, as at 500 Hz
OMEGA = 28.0  # rad/s, the paper's pendulum


def sample(t):
    """Return the state of two muscles that swing 50 mm and 20 mm, with a ramp of pressure."""
    amplitude = np.array([0.05, 0.02])
    phase = OMEGA * t
    return np.array(
        [
            amplitude * np.sin(phase),
            amplitude * OMEGA * np.cos(phase),
            [1e5 + 1e4 * t, 2e5],
            [300.0 - 5.0 * t, 100.0],
            -amplitude * OMEGA**2 * np.sin(phase),
        ]
    )


def test_ideal_sensors_say_the_state_and_keep_their_hands_off_it():
    feedback = Feedback(Sensors(), 2)
    assert feedback.is_ideal
    state = sample(0.123)
    reading = feedback.read(0.123, state)
    np.testing.assert_array_equal(reading, state[:4])
    reading[:] = 0.0
    np.testing.assert_array_equal(state, sample(0.123))


@pytest.mark.parametrize('latency', [H, 2.5 * H, 0.00123, 0.05, 0.3])
def test_latency_gives_the_state_of_then(latency):
    feedback = Feedback(Sensors(latency=latency), 2)
    times = H * np.arange(600)
    readings = [feedback.read(t, sample(t)) for t in times]
    for t, reading in zip(times, readings, strict=True):
        then = sample(max(t - latency, 0.0))
        # Error of a cubic Hermite polynomial: h^4 / 384 of the fourth derivative.
        bound = 1.01 * H**4 / 384 * 0.05 * OMEGA**4
        assert bound < 2e-9
        assert np.max(np.abs(reading[POSITION] - then[POSITION])) < bound + 1e-15
        assert np.max(np.abs(reading[VELOCITY] - then[VELOCITY])) < OMEGA * bound + 1e-13
        np.testing.assert_allclose(reading[PRESSURE], then[PRESSURE], rtol=1e-12)
        np.testing.assert_allclose(reading[FORCE], then[FORCE], rtol=1e-12)


def test_latency_holds_the_first_state_until_there_is_an_older_one():
    feedback = Feedback(Sensors(latency=0.1))
    first = sample(1.0)[:, :1]
    for t in (1.0, 1.05, 1.1):
        reading = feedback.read(t, first if t == 1.0 else sample(t)[:, :1])
        np.testing.assert_array_equal(reading, first[:4])


def test_latency_while_time_stands_still_remembers_one_sample():
    feedback = Feedback(Sensors(latency=H))
    for t in (0.0, H):
        feedback.read(t, sample(t)[:, :1])
    readings = [feedback.read(2 * H, sample(2 * H)[:, :1]) for _ in range(1000)]
    assert len(feedback._past) == 2
    for reading in readings:
        np.testing.assert_allclose(reading, sample(H)[:4, :1], rtol=1e-12)


def test_noise_has_the_configured_deviation_and_is_white():
    wanted = {'position': 20e-6, 'velocity': 1e-3, 'pressure': 400.0, 'force': 2.7}
    sensors = Sensors(**{f'{name}_noise': value for name, value in wanted.items()}, seed=5)
    feedback = Feedback(sensors, 2)
    n = 20_000
    state = sample(0.0)
    noise = np.array([feedback.read(i * H, state) - state[:4] for i in range(n)])
    flat = noise.reshape(n, 8)
    deviation = flat.std(axis=0)
    np.testing.assert_allclose(
        deviation, np.repeat([*wanted.values()], 2), rtol=5 / np.sqrt(2 * n)
    )
    assert np.all(np.abs(flat.mean(axis=0)) < 5 * deviation / np.sqrt(n))
    unit = flat / deviation
    others = np.corrcoef(unit.T) - np.eye(8)
    assert np.max(np.abs(others)) < 5 / np.sqrt(n)
    assert np.max(np.abs(np.mean(unit[1:] * unit[:-1], axis=0))) < 5 / np.sqrt(n)


def run(sensors, n=50):
    feedback = Feedback(sensors, 2)
    return np.array([feedback.read(i * H, sample(i * H)) for i in range(n)])


def test_same_seed_same_bits_other_seed_other_noise():
    sensors = Sensors(position_noise=1e-5, seed=3)
    np.testing.assert_array_equal(run(sensors), run(sensors))
    other = run(Sensors(position_noise=1e-5, seed=4))
    assert np.all(run(sensors)[:, POSITION] != other[:, POSITION])


def test_the_noise_of_one_sensor_does_not_depend_on_anothers():
    alone = run(Sensors(force_noise=2.0))
    beside = run(Sensors(force_noise=2.0, position_noise=1e-5, pressure_noise=100.0))
    np.testing.assert_array_equal(alone[:, FORCE], beside[:, FORCE])


@given(st.floats(1e-6, 0.01), st.floats(-0.1, 0.1))
def test_resolution_gives_the_nearest_step(step, position):
    feedback = Feedback(Sensors(position_resolution=step))
    state = np.array([[position], [0.0], [0.0], [0.0], [0.0]])
    (reading,) = feedback.read(0.0, state)[POSITION]
    assert abs(reading - position) <= 0.5 * step * (1 + 1e-9)
    assert reading / step == pytest.approx(round(reading / step), abs=1e-9)


def test_each_sensor_has_its_own_resolution():
    feedback = Feedback(
        Sensors(position_resolution=0.001, pressure_resolution=100, force_resolution=0.5)
    )
    state = np.array([[0.01234], [0.123456], [123456.0], [77.3], [0.0]])
    np.testing.assert_allclose(
        feedback.read(0.0, state)[:, 0], [0.012, 0.123456, 123500.0, 77.5], rtol=1e-12
    )


def test_offset_moves_the_position_before_it_is_resolved():
    feedback = Feedback(Sensors(position_offset=0.0004, position_resolution=0.001))
    state = np.zeros((5, 1))
    state[POSITION] = 0.0102
    assert feedback.read(0.0, state)[POSITION, 0] == pytest.approx(0.011, abs=1e-15)


def test_change_keeps_the_past_and_the_noise_going_unless_the_seed_changes():
    feedback = Feedback(Sensors(latency=5 * H, position_noise=1e-5, seed=1), 2)
    for i in range(20):
        feedback.read(i * H, sample(i * H))
    feedback.change(Sensors(latency=3 * H, seed=1))
    reading = feedback.read(20 * H, sample(20 * H))
    np.testing.assert_allclose(reading[POSITION], sample(17 * H)[POSITION], rtol=1e-9)
    feedback.change(Sensors(force_noise=1.0, seed=9))
    fresh = Feedback(Sensors(force_noise=1.0, seed=9), 2)
    np.testing.assert_array_equal(feedback.read(1.0, sample(1.0)), fresh.read(1.0, sample(1.0)))


@pytest.mark.parametrize(
    'bad', [{'latency': -0.01}, {'latency': 2.0}, {'position_noise': np.nan}, {'seed': 1.5}]
)
def test_impossible_sensors_are_refused(bad):
    (name,) = bad
    with pytest.raises(ParameterError, match=f'^{name} = '):
        Sensors(**bad)
