# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings become runs: where they start, what drives them."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.identification.data.segment import segments_of, windows
from pam_ros.recording.recording import Recording

RATE = 100.0


def free(seconds=40.0, name='free'):
    """Return a load on a parabola, under a staircase that changes between the samples."""
    t = np.arange(round(seconds * RATE)) / RATE
    stamps = np.arange(0.0, seconds, 0.5) + 0.003
    stamps[0] = 0.0
    y = 0.01 + 0.02 * t - 0.0003 * t**2
    command = 1e5 + 1e4 * np.arange(stamps.size)
    return Recording(name, t, stamps, command, y)


def held(**changes):
    """Return a muscle whose length follows a sine while its pressure falls."""
    t = np.arange(2000) / RATE
    y = 0.02 + 0.004 * np.sin(2 * np.pi * 0.2 * t)
    given = {
        'command_t': None,
        'command': None,
        'position': y,
        'force': 500.0 + 10.0 * t,
        'pressure': 3e5 - 1e3 * t,
    }
    return replace(
        Recording('held', t, None, None, y, None, None, None, 'held'), **given | changes
    )


def test_a_free_run_is_what_was_recorded():
    recording = free()
    (segment,) = segments_of([recording])
    assert segment.kind == 'free'
    assert segment.quantity == 'position'
    assert segment.fit.all()
    np.testing.assert_array_equal(segment.t, recording.t)
    np.testing.assert_array_equal(segment.target, recording.position)
    np.testing.assert_array_equal(segment.drive_t, recording.command_t)
    np.testing.assert_array_equal(segment.drive[:, 0], recording.command)


def test_a_free_run_starts_where_and_as_fast_as_was_measured():
    (segment,) = segments_of([free()])
    assert segment.y0 == pytest.approx(0.01, abs=1e-12)
    assert segment.v0 == pytest.approx(0.02, abs=1e-10)
    assert segment.first_pressures == [1e5]


def test_a_gap_starts_a_new_run_under_the_command_that_holds_there():
    whole = free()
    keep = (whole.t < 10.0) | (whole.t > 12.2)
    gap = (float(whole.t[whole.t < 10.0][-1]), float(whole.t[whole.t > 12.2][0]))
    recording = replace(whole, t=whole.t[keep], position=whole.position[keep], gaps=(gap,))
    first, second = segments_of([recording])
    assert (first.t[0], first.t[-1]) == (0.0, gap[0])
    assert (second.t[0], second.t[-1]) == (gap[1], whole.t[-1])
    assert second.y0 == pytest.approx(0.01 + 0.02 * gap[1] - 0.0003 * gap[1] ** 2, abs=1e-12)
    assert second.v0 == pytest.approx(0.02 - 0.0006 * gap[1], abs=1e-10)
    # 12.21 s lies behind the step at 12.003 s, the 24th.
    assert second.first_pressures == [1e5 + 24e4]


def test_a_held_run_follows_the_length_and_its_velocity():
    (segment,) = segments_of([held()])
    assert segment.quantity == 'force'
    np.testing.assert_array_equal(segment.target, 500.0 + 10.0 * segment.t)
    np.testing.assert_allclose(segment.pressure, 3e5 - 1e3 * segment.t, rtol=1e-12)
    truth = 0.004 * 2 * np.pi * 0.2 * np.cos(2 * np.pi * 0.2 * segment.t)
    inside = slice(20, -20)
    np.testing.assert_allclose(segment.velocity[inside], truth[inside], atol=2e-5)
    assert segment.first_pressures[0] == pytest.approx(3e5, rel=1e-12)


def test_the_noise_of_a_slow_pressure_is_taken_away():
    noise = 200.0 * np.random.default_rng(1).standard_normal(2000)
    slow = held().pressure
    (segment,) = segments_of([held(pressure=slow + noise)])
    assert np.std(segment.pressure - slow) < 0.5 * np.std(noise)


def test_a_pressure_that_jumps_stays_as_it_was_measured():
    noise = 200.0 * np.random.default_rng(1).standard_normal(2000)
    jumps = np.where(held().t % 4.0 < 2.0, 1e5, 3e5) + noise
    (segment,) = segments_of([held(pressure=jumps)])
    np.testing.assert_array_equal(segment.pressure, jumps)


@pytest.mark.parametrize('short', [4.0, 0.4, 0.1], ids=str)
def test_levels_of_a_pressure_are_not_the_noise_of_a_resolution(short):
    """Without noise all levels are multiples of one step; a short pulse is no noise either."""
    t = held().t
    for levels in ((3e5, 4e5), (0.0, 5e3, 3e5)):
        pressure = np.full(t.size, levels[0])
        for n, level in enumerate(levels[1:]):
            begin = 2.0 + 5.0 * n
            pressure[(t >= begin) & (t < begin + short)] = level
        (segment,) = segments_of([held(pressure=pressure)])
        np.testing.assert_array_equal(segment.pressure, pressure)


def test_noise_of_a_length_that_moves_hardly_reaches_it_and_its_velocity():
    true = held().position
    noise = 1e-5 * np.random.default_rng(0).standard_normal(2000)
    (segment,) = segments_of([held(position=true + noise)])
    assert np.std(segment.position - true) < 0.5 * np.std(noise)
    speed = 0.004 * 2 * np.pi * 0.2 * np.cos(2 * np.pi * 0.2 * segment.t)
    plain = np.gradient(true + noise, segment.t) - speed
    assert np.std(segment.velocity - speed) < 0.3 * np.std(plain)
    assert not segments_of([held(position=np.full(2000, 0.02))])[0].velocity.any()


def test_a_held_run_without_measured_pressure_takes_the_command():
    stamps = np.array([0.0, 3.005, 7.0])  # the last is that of a sample, which comes first
    recording = held(pressure=None, command_t=stamps, command=np.array([1e5, 2e5, 3e5]))
    (segment,) = segments_of([recording])
    assert segment.pressure[segment.t == 3.0] == 1e5
    assert segment.pressure[np.isclose(segment.t, 3.01)] == 2e5
    assert segment.pressure[segment.t == 7.0] == 2e5
    assert segment.pressure[np.isclose(segment.t, 7.01)] == 3e5
    assert segment.pressure[0] == 1e5


def test_stubs_are_left_out():
    whole = free(10.0)
    gaps = ((float(whole.t[-4]), float(whole.t[-3])),)
    parts = segments_of([replace(whole, gaps=gaps)])
    assert [part.t.size for part in parts] == [whole.t.size - 3]


def test_kinds_do_not_mix():
    with pytest.raises(RecordingError, match='ramp is free, held is held'):
        segments_of([free(name='ramp'), held()])


@pytest.mark.parametrize(
    ('recording', 'words'),
    [
        (replace(free(), position=None), 'free: no position'),
        (held(force=None), 'held: no force was recorded'),
    ],
)
def test_what_cannot_be_compared_is_refused(recording, words):
    with pytest.raises(RecordingError, match=words):
        segments_of([recording])


def test_each_window_starts_from_the_measurement():
    (segment,) = segments_of([free()])
    parts = windows(segment, 2.0)
    assert len(parts) == 20
    for part in parts:
        assert part.t[-1] - part.t[0] == pytest.approx(2.0, abs=0.021)
        assert part.y0 == pytest.approx(0.01 + 0.02 * part.t[0] - 0.0003 * part.t[0] ** 2)
        assert part.v0 == pytest.approx(0.02 - 0.0006 * part.t[0], abs=1e-9)
        np.testing.assert_array_equal(part.drive, segment.drive)
    np.testing.assert_array_equal(np.unique(np.concatenate([p.t for p in parts])), segment.t)


def test_a_short_run_is_one_window():
    (segment,) = segments_of([free(2.5)])
    (part,) = windows(segment, 2.0)
    np.testing.assert_array_equal(part.t, segment.t)
