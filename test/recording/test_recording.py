# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A recording: its parts between gaps, and what drives it."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.errors import ParameterError, RecordingError
from pam_ros.recording.recording import Recording


def recording(t, command_t=None, command=None, **signals):
    t = np.asarray(t, float)
    values = {'position': np.cos(t), 'velocity': None, 'force': None, 'pressure': None, **signals}
    return Recording(
        name='made',
        t=t,
        command_t=None if command_t is None else np.asarray(command_t, float),
        command=None if command is None else np.asarray(command, float),
        kind='free',
        **values,
    )


def test_what_is_not_given_was_not_recorded_and_the_load_is_free():
    one = Recording('made', [0.0, 0.1], [0.0], [3e5], [0.01, 0.02])
    assert (one.velocity, one.force, one.pressure, one.kind) == (None, None, None, 'free')
    held = Recording('held', [0.0, 0.1], position=[0.1, 0.1], pressure=[1e5, 2e5], kind='held')
    assert held.command_t is held.command is held.force is None


def test_period_and_duration():
    one = recording([0.0, 0.1, 0.2, 0.3, 5.0])
    assert one.period == pytest.approx(0.1)
    assert one.duration == 5.0


def test_segments_are_the_parts_between_the_gaps():
    t = np.r_[0.0:1.0:0.1, 3.0:4.0:0.1, 6.0:6.5:0.1]
    gaps = ((t[9], t[10]), (t[19], t[20]))
    commanded = recording(t, [-1.0, 0.5, 2.0, 3.05, 6.2], [0.0, 1.0, 2.0, 3.0, 4.0])
    whole = replace(commanded, gaps=gaps)
    parts = whole.segments()
    assert [part.t.size for part in parts] == [10, 10, 5]
    np.testing.assert_array_equal(np.concatenate([part.t for part in parts]), t)
    np.testing.assert_array_equal(
        np.concatenate([part.position for part in parts]), whole.position
    )
    # Each part begins with the command that holds at its first sample.
    assert [part.command.tolist() for part in parts] == [[0.0, 1.0], [2.0, 3.0], [3.0, 4.0]]
    assert all(part.gaps == () for part in parts)


def test_a_recording_without_gaps_is_its_own_segment():
    one = recording(np.arange(5.0), [0.0], [1.0])
    (part,) = one.segments()
    np.testing.assert_array_equal(part.t, one.t)
    np.testing.assert_array_equal(part.command, one.command)


def test_a_part_keeps_the_gaps_inside():
    t = np.r_[0.0:1.0:0.1, 3.0:4.0:0.1]
    gaps = ((t[9], t[10]),)
    whole = replace(recording(t), gaps=gaps)
    assert whole.part(5, 15).gaps == gaps
    assert whole.part(0, 10).gaps == ()


def test_the_command_drives_as_it_was_recorded():
    one = recording(np.arange(5.0), [-2.0, 1.5], [1e5, 2e5], pressure=np.zeros(5))
    t, p = one.drive(1e-3)
    np.testing.assert_array_equal(t, [-2.0, 1.5])
    np.testing.assert_array_equal(p, [1e5, 2e5])


def test_a_measured_pressure_drives_without_delay():
    """Held for short stretches at their means, it has the integral of the straight lines."""
    rng = np.random.default_rng(2)
    t = np.cumsum(rng.uniform(0.005, 0.015, 200))
    p = np.cumsum(rng.normal(size=200))
    one = recording(t, pressure=p)
    stamps, held = one.drive(1e-3)
    widths = np.diff(np.append(stamps, t[-1]))
    assert widths.max() <= 1e-3 + 1e-12
    assert widths.min() > 0.0
    assert set(t[:-1]) <= set(stamps)
    at_samples = np.searchsorted(stamps, t[:-1])
    integral = np.add.reduceat(held * widths, at_samples)
    np.testing.assert_allclose(integral, 0.5 * (p[1:] + p[:-1]) * np.diff(t), atol=1e-12)
    # Where samples are close enough, each interval is held at its mean.
    stamps, held = one.drive(0.02)
    np.testing.assert_array_equal(stamps, t[:-1])
    np.testing.assert_allclose(held, 0.5 * (p[1:] + p[:-1]), atol=1e-12)


def test_nothing_drives():
    with pytest.raises(RecordingError, match='neither pressure_command nor pressure'):
        recording(np.arange(5.0)).drive(1e-3)


def test_the_first_command_acts_at_the_first_sample():
    with pytest.raises(
        RecordingError, match=r'made: command_t\[0\] = 0.5 s is after t\[0\] = 0.0'
    ):
        recording(np.arange(5.0), [0.5], [1e5])


@pytest.mark.parametrize(
    'gaps', [[(2.0, 1.0)], [(1.0, 1.0)], [(2.0, 3.0), (0.0, 1.0)], [(0.0, 2.0), (1.0, 3.0)]]
)
def test_gaps_are_in_the_order_of_time(gaps):
    with pytest.raises(RecordingError, match=r'gaps = .* give from and to of each'):
        replace(recording(np.arange(5.0)), gaps=gaps)
    replace(recording(np.arange(5.0)), gaps=[(0.0, 1.0), (1.0, 3.0)])


def test_a_part_without_samples_and_a_step_of_nothing():
    one = recording(np.arange(5.0), pressure=np.zeros(5))
    with pytest.raises(ParameterError, match=r'start, stop = \(5, 5\) is not allowed'):
        one.part(5, 5)
    with pytest.raises(ParameterError, match=r'step = 0\.0 is not allowed'):
        one.drive(0.0)


def test_masked_samples_are_left_out_and_a_long_stretch_is_a_gap():
    t = np.arange(200) * 0.01
    position, pressure = np.cos(t), np.full((200, 2), 1e5)
    position[50], pressure[60, 1] = -99.0, -1.0
    one = Recording(
        'made',
        t,
        np.ma.array(t, mask=t == t[1]),
        np.ma.array(pressure, mask=pressure < 0.0),
        position=np.ma.array(position, mask=(position < -9.0) | ((t > 1.0) & (t < 1.4))),
        pressure=np.ma.array(pressure, mask=pressure < 0.0),
        muscles=('flexor', 'extensor'),
    )
    kept = (t <= 1.0) | (t >= 1.4)
    kept[[50, 60]] = False
    np.testing.assert_array_equal(one.t, t[kept])
    np.testing.assert_array_equal(one.position, np.cos(t)[kept])
    assert one.pressure.shape == (kept.sum(), 2)
    assert one.command.shape == (198, 2)
    assert one.gaps == (pytest.approx((1.0, 1.4)),)


def test_masked_arrays_of_another_length_are_refused():
    with pytest.raises(RecordingError, match=r'position\[1\] is masked: give a number'):
        Recording('made', [0.0, 0.1], position=np.ma.array([0.0, 0.1, 0.2], mask=[0, 1, 0]))
