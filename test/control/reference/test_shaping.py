# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""References from targets: bounds after a step, no lag behind a smooth stream."""

import math

import numpy as np
import pytest

from pam_ros.control.reference.shaping import STREAM, Shape, Shaper
from pam_ros.errors import ParameterError

DT = 2e-3
SHAPE = Shape(max_velocity=0.1, max_acceleration=0.5, max_jerk=6.0)


def run(target, seconds, every=DT, late=0.0, shape=SHAPE, seed=0):
    """Return times and references for a target that comes every so many s, some *late* s late."""
    rng = np.random.default_rng(seed)
    shaper, out = Shaper(shape), []
    count = 0
    waiting = []
    for n in range(round(seconds / DT)):
        t = n * DT
        while count * every <= t + 1e-9:
            waiting.append((count * every + abs(rng.normal()) * late, target(count * every)))
            count += 1
        for arrival, value in [one for one in waiting if one[0] <= t + 1e-9]:
            shaper.take(value, t - arrival)
            waiting.remove((arrival, value))
        out.append((t, *shaper.follow(DT)))
    return np.array(out).T


def test_a_step_is_approached_within_the_bounds_and_reached():
    _, y, v, a, j = run(lambda t: 0.02 if t >= 0.1 else 0.0, 1.5)
    assert y[-1] == 0.02
    assert np.max(np.abs(v)) <= SHAPE.max_velocity
    assert np.max(np.abs(a)) <= SHAPE.max_acceleration + 1e-9
    assert np.max(np.abs(j)) <= SHAPE.max_jerk + 1e-9
    assert np.max(y) <= 0.02 + 1e-12  # no overshoot
    np.testing.assert_allclose(np.gradient(y, DT)[1:-1], v[1:-1], atol=2e-3)


def test_a_step_during_an_approach_joins_smoothly():
    _, y, v, a, _ = run(lambda t: 0.02 if t < 0.2 else -0.03, 2.0)
    assert y[-1] == -0.03
    assert np.max(np.abs(np.diff(v))) <= SHAPE.max_acceleration * DT + 1e-9
    assert np.max(np.abs(np.diff(a))) <= SHAPE.max_jerk * DT + 1e-9


@pytest.mark.parametrize(
    ('every', 'late', 'error'),
    [(0.002, 0.0, 2e-6), (0.01, 0.0, 3e-6), (0.02, 0.0, 8e-6), (0.01, 5e-4, 100e-6)],
)
def test_a_smooth_stream_is_followed_without_lag(every, late, error):
    amplitude, w = 0.01, math.pi

    def sine(t):
        return amplitude * math.sin(w * t)

    t, y, v, *_ = run(sine, 8.0, every, late)
    # A follow() ends one period later than it begins.
    t, late_part = t + DT, t > 4.0
    assert np.max(np.abs(y - amplitude * np.sin(w * t))[late_part]) < error
    assert (
        np.max(np.abs(v - amplitude * w * np.cos(w * t))[late_part])
        < (0.02 + 300.0 * late) * amplitude * w
    )
    lag = np.mean((y - amplitude * np.sin(w * t))[late_part] * np.cos(w * t)[late_part])
    assert abs(lag) * 2.0 / (amplitude * w) < 1e-3  # s


def test_a_stream_that_is_faster_than_the_bounds_is_followed_all_the_same():
    t, y, *_ = run(lambda t: 0.1 * math.sin(3.0 * t), 6.0, 0.005)
    t, late = t + DT, t > 4.0
    assert np.max(np.abs(y - 0.1 * np.sin(3.0 * t))[late]) < 3e-4


def test_a_stream_that_stops_does_not_run_on():
    shaper = Shaper(SHAPE)
    for n in range(500):
        if n < 200:
            shaper.take(0.05 * n * DT, 0.0)
        reference = shaper.follow(DT)
    assert reference.position == pytest.approx(0.05 * 199 * DT, abs=1e-12)
    assert reference.velocity == 0.0


def test_a_word_after_a_pause_is_a_step_however_small():
    shaper = Shaper(SHAPE)
    shaper.take(0.0)
    for _ in range(round(2.0 * STREAM.pause / DT)):
        shaper.follow(DT)
    shaper.take(1e-4)
    speeds = [abs(shaper.follow(DT).velocity) for _ in range(500)]
    assert shaper.reference == (1e-4, 0.0, 0.0, 0.0)
    assert max(speeds) < 0.01


def test_two_words_at_once_leave_the_second():
    shaper = Shaper(SHAPE)
    shaper.take(0.01)
    shaper.take(-0.01)
    for _ in range(1000):
        shaper.follow(DT)
    assert shaper.reference.position == -0.01


def test_a_stop_comes_to_rest_without_going_back():
    shaper = Shaper(SHAPE)
    shaper.take(0.05)
    for _ in range(150):
        shaper.follow(DT)
    assert shaper.reference.velocity > 0.05
    shaper.stop()
    path = [shaper.follow(DT).position for _ in range(600)]
    assert np.all(np.diff(path) >= -1e-12)
    assert shaper.reference.velocity == 0.0
    assert path[-1] < 0.05


def test_a_joint_that_turns_has_bounds_of_its_own():
    assert Shape.revolute().is_revolute
    assert Shape.revolute().bounds == (2.0, 15.0, 300.0)
    assert Shape.revolute(max_velocity=1.5).max_velocity == 1.5
    # 50 rad/s can be asked for, 50 m/s can not.
    assert Shape.revolute(max_velocity=50.0).bounds.velocity == 50.0
    with pytest.raises(ParameterError, match=r'max_velocity = 50.0 .* at most 10 m/s'):
        Shape(max_velocity=50.0)
    with pytest.raises(ParameterError, match=r'max_velocity = 500.0 .* at most 100 rad/s'):
        Shape.revolute(max_velocity=500.0)
