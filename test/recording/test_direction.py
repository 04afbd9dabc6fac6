# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A position that counts against the actuator's pull is found by the work of its cycles."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.recording.direction import (
    with_contraction_positive,
    with_tension_positive,
    work_of_cycles,
)
from pam_ros.recording.recording import Recording

T = np.arange(4000) / 100.0
STROKE = 0.03  # m, to and fro in 8 s: five tops, four cycles from one to the next
Y = STROKE * np.abs((T + 1.0) % 8.0 / 4.0 - 1.0)
UP = np.sign(np.gradient(Y))  # 1 where the position rises
NOISE = 0.2 * np.random.default_rng(0).standard_normal((2, T.size))


def held(force, position=Y, pressure=3e5, **changes):
    """Return a recording of an actuator that is moved to and fro."""
    pressure = np.full(T.size, pressure) if np.isscalar(pressure) else pressure
    given = {'velocity': np.gradient(position, T), 'kind': 'held'} | changes
    return Recording(
        'moved.csv', T, None, None, position, given['velocity'], force, pressure, given['kind']
    )


def test_the_work_of_a_cycle_is_the_area_of_its_loop():
    """A friction of 5 N takes 2 x 5 N x 30 mm."""
    work = work_of_cycles(Y, 150.0 - 5.0 * UP)
    assert len(work) == 4
    np.testing.assert_allclose(work, -2.0 * 5.0 * STROKE, rtol=0.02)


def test_a_position_against_the_pull_is_reversed_with_a_note():
    recording = held(150.0 + 5.0 * UP + NOISE[0], Y + 2e-5 * NOISE[1])
    turned = with_contraction_positive(recording)
    np.testing.assert_array_equal(turned.position, -recording.position)
    np.testing.assert_array_equal(turned.velocity, -recording.velocity)
    np.testing.assert_array_equal(turned.force, recording.force)
    (warning,) = turned.warnings
    assert 'delivers 0.3 J in each cycle' in warning
    assert 'its sign is changed' in warning
    assert with_contraction_positive(turned) is turned


def test_the_cycles_of_each_gapless_stretch_count():
    whole = held(150.0 + 5.0 * UP)
    keep = (T < 20.0) | (T > 21.0)
    values = {name: getattr(whole, name)[keep] for name in ('t', 'position', 'velocity', 'force')}
    gap = (float(T[T < 20.0][-1]), float(T[T > 21.0][0]))
    broken = replace(whole, pressure=whole.pressure[keep], gaps=(gap,), **values)
    np.testing.assert_array_equal(with_contraction_positive(broken).position, -broken.position)


@pytest.mark.parametrize(
    'recording',
    [
        held(150.0 - 5.0 * UP),
        held(150.0 + 1e3 * Y + NOISE[0]),
        held(150.0 + 5.0 * UP, kind='free'),
        held(150.0 + 5.0 * UP, np.full(T.size, 0.02)),
        held(150.0 + 5.0 * UP, 0.03 * np.abs((T + 1.0) / 20.0 - 1.0)),
        # A valve that works: the pressure is higher on the way up.
        held(150.0 + 15.0 * UP, pressure=3e5 + 3e4 * UP),
    ],
    ids=['friction', 'spring', 'free', 'at rest', 'one turn', 'driven'],
)
def test_others_are_as_they_were_recorded(recording):
    assert with_contraction_positive(recording) is recording


PRESSURE = 3e5 + 2e5 * np.sin(1.3 * T)
PULL = 2e-3 * PRESSURE - 4e3 * Y - 5.0 * UP + NOISE[0]  # N; more at a higher pressure


def test_tension_that_counts_negative_is_reversed_with_a_note():
    recording = held(-PULL, pressure=PRESSURE)
    turned = with_tension_positive(recording)
    np.testing.assert_array_equal(turned.force, PULL)
    np.testing.assert_array_equal(turned.position, recording.position)
    (warning,) = turned.warnings
    assert 'tension is counted negative, and the sign of the force is changed' in warning
    assert with_tension_positive(turned) is turned


def test_a_positive_force_that_falls_with_the_pressure_is_asked_about():
    recording = held(2000.0 - PULL, pressure=PRESSURE)
    asked = with_tension_positive(recording)
    assert asked.force is recording.force
    (warning,) = asked.warnings
    assert warning.endswith(
        'is the sign of the force or of the pressure wrong, or are both of different muscles?'
    )


@pytest.mark.parametrize(
    'recording',
    [
        held(PULL, pressure=PRESSURE),
        held(PULL - 3000.0, pressure=PRESSURE),  # another zero
        held(-PULL),  # of a constant pressure: nothing shows its sign
        held(-PULL, pressure=PRESSURE, kind='free'),
        held(-5.0 * UP + 20.0 * NOISE[0], pressure=PRESSURE),
    ],
)
def test_other_forces_keep_their_signs(recording):
    assert with_tension_positive(recording) is recording
