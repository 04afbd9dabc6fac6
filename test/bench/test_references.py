# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Desired positions over time: known values, smooth motions, and descriptions in YAML files."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from pam_ros.bench.references import REFERENCES, Chirp, Sine, Trajectory, reference_of
from pam_ros.errors import ParameterError

CHIRP = {'amplitude': 0.01, 'frequency_low': 0.1, 'frequency_high': 10.0, 'sweep_time': 40.0}


@pytest.mark.parametrize(
    ('values', 'times', 'positions'),
    [
        ({'kind': 'hold'}, [0.0, 9.0], [0.0, 0.0]),
        ({'kind': 'step', 'size': -0.02}, [0.0, 0.999, 1.0, 99.0], [0.0, 0.0, -0.02, -0.02]),
        # The rounding of a time does not delay a jump by a period.
        ({'kind': 'step', 'size': 1, 'time': 0.7}, [0.69, np.nextafter(0.7, 0.0)], [0.0, 1.0]),
        (
            {'kind': 'staircase', 'sizes': [0.01, -0.01, 0.02]},
            [0.0, 0.99, 1.0, 3.99, 4.0, 6.99, 7.0, 100.0],
            [0.0, 0.0, 0.01, 0.01, -0.01, -0.01, 0.02, 0.02],
        ),
        # The full amplitude from the second period on: its crest, trough and end.
        (
            {'kind': 'sine', 'amplitude': 0.02, 'frequency': 0.5, 'time': 2.0},
            [0.0, 2.0, 4.5, 5.5, 1002.0],
            [0.0, 0.0, 0.02, -0.02, 0.0],
        ),
        # Half way at half time; at a quarter 53/512 of it: 10/64 - 15/256 + 6/1024.
        (
            {'kind': 'minimum_jerk', 'size': 0.512, 'travel_time': 4.0},
            [0.5, 1.0, 2.0, 3.0, 5.0, 9.0],
            [0.0, 0.0, 0.053, 0.256, 0.512, 0.512],
        ),
        ({'kind': 'chirp', **CHIRP}, [0.0, 1.0, 41.0, 99.0], [0.0, 0.0, 0.0, 0.0]),
        # Alone, a piece between points of rest is 3 s^2 - 2 s^3.
        (
            {'kind': 'trajectory', 'times': [2, 4, 6], 'positions': [0.02, -0.01, -0.01]},
            [0.0, 0.5, 2.0, 3.0, 4.0, 5.0, 9.0],
            [0.0, 0.003125, 0.02, 0.005, -0.01, -0.01, -0.01],
        ),
        (
            {'kind': 'trajectory', 'times': [0, 1, 3], 'positions': [0, 0, -0.02]},
            [0.0, 1.0, 1.5, 2.0, 3.0, 9.0],
            [0.0, 0.0, -0.003125, -0.01, -0.02, -0.02],
        ),
    ],
)
def test_known_positions(values, times, positions):
    reference = reference_of(values, 'test')
    assert reference.at(np.array(times)) == pytest.approx(positions, abs=1e-12)
    assert reference.at(np.array([times])).shape == (1, len(times))


def test_each_octave_of_a_chirp_lasts_equally_long():
    """Count the zeros: the local frequency after a share s of the sweep is 0.1 Hz * 100^s."""
    t = np.arange(0.0, 42.0, 1e-4)
    x = Chirp(**CHIRP, time=1.0).at(t)
    zeros = t[1:][x[1:] * x[:-1] < 0.0]
    zeros = zeros[(zeros > 12.0) & (zeros < 40.0)]
    middle = 0.5 * (zeros[1:] + zeros[:-1])
    assert 0.5 / np.diff(zeros) == pytest.approx(0.1 * 100.0 ** ((middle - 1.0) / 40.0), rel=0.02)
    assert np.abs(x).max() == pytest.approx(0.01, rel=1e-3)


def test_a_trajectory_stays_between_its_points():
    """A cubic spline through these points would exceed both levels."""
    path = Trajectory(times=(1.0, 1.2, 4.0), positions=(0.0, 0.1, 0.1))
    x = path.at(np.linspace(0.0, 6.0, 6001))
    assert np.all(np.diff(x) >= 0.0)
    assert (x[1000], x[1200], x[-1]) == pytest.approx((0.0, 0.1, 0.1), abs=1e-12)


positions_of = st.floats(-0.1, 0.1)
times_of = st.floats(0.0, 3.0)


@st.composite
def smooth_references(draw):
    kind = draw(st.sampled_from(['sine', 'chirp', 'minimum_jerk', 'trajectory']))
    if kind == 'trajectory':
        count = draw(st.integers(1, 6))
        times = np.cumsum(draw(st.lists(st.floats(0.2, 2.0), min_size=count, max_size=count)))
        positions = draw(st.lists(positions_of, min_size=count, max_size=count))
        return {'kind': kind, 'times': list(times), 'positions': positions}
    size = 'size' if kind == 'minimum_jerk' else 'amplitude'
    values = {'kind': kind, size: draw(positions_of), 'time': draw(times_of)}
    if kind == 'sine':
        values['frequency'] = draw(st.floats(0.05, 2.0))
    elif kind == 'chirp':
        low, high = sorted(draw(st.lists(st.floats(0.2, 2.0), min_size=2, max_size=2)))
        assume(low < high)
        values |= {'frequency_low': low, 'frequency_high': high, 'sweep_time': 10.0}
    else:
        values['travel_time'] = draw(st.floats(0.2, 5.0))
    return values


@given(smooth_references())
def test_smooth_references_begin_at_zero_and_have_a_continuous_velocity(values):
    """The velocity changes less and less from sample to sample as samples get closer."""
    reference = reference_of(values, 'test')
    changes = []
    for period in (1e-3, 1e-4):
        x = reference.at(np.arange(-0.01, 12.0, period))
        assert np.all(x[: round(0.01 / period)] == 0.0)
        changes.append(np.abs(np.diff(x, 2)).max(initial=0.0) / period)
    assert changes[1] <= 0.11 * changes[0] + 1e-10


@pytest.mark.parametrize(
    ('values', 'sentence'),
    [
        ([1], '[1] is not a mapping: give {kind: ...}, one of hold, step, '),
        ({'size': 1.0}, 'kind is missing: give one of hold, step, '),
        ({'kind': 'ramp'}, "kind = 'ramp' is not allowed: give one of hold, step, "),
        ({'kind': ['step']}, "kind = ['step'] is not allowed: give one of hold, "),
        ({'kind': 'hold', 'size': 1}, 'size = 1 is not allowed: give no other key for the kind '),
        ({'kind': 'step', 'siz': 1}, 'siz = 1 is not allowed: give one of size, time for the '),
        ({'kind': 'step', 'size': 1, None: 2}, 'None = 2 is not allowed: give one of size, time'),
        ({'kind': 'step'}, 'size is missing: give -10 to 10 m (height of the step'),
        ({'kind': 'step', 'size': 11}, 'size = 11 is not allowed: give -10 to 10 m'),
        ({'kind': 'step', 'size': 'a'}, "size = 'a' is not allowed: give a number, -10 to 10 m"),
        ({'kind': 'step', 'size': True}, 'size = True is not allowed: give a number, -10 to 10 m'),
        ({'kind': 'step', 'size': None}, 'size = None is not allowed: give a number, -10 to 10 m'),
        ({'kind': 'step', 'size': np.nan}, 'size = nan is not allowed: give -10 to 10 m'),
        ({'kind': 'step', 'size': [1]}, 'size = [1] is not allowed: give a number, -10 to 10 m'),
        ({'kind': 'step', 'size': 1, 'time': 0}, 'time = 0 is not allowed: give 0.1 to 3600 s'),
        ({'kind': 'staircase'}, 'sizes is missing: give a list, each -10 to 10 m (levels '),
        ({'kind': 'staircase', 'sizes': []}, 'sizes = [] is not allowed: give a list of numbers,'),
        ({'kind': 'staircase', 'sizes': 0.1}, 'sizes = 0.1 is not allowed: give a list of '),
        ({'kind': 'staircase', 'sizes': [0, 'b']}, "sizes[1] = 'b' is not allowed: give a number"),
        ({'kind': 'staircase', 'sizes': [np.inf]}, 'sizes[0] = inf is not allowed: give -10 to '),
        ({'kind': 'sine', 'amplitude': 1, 'frequency': 0}, 'frequency = 0 is not allowed: give '),
        (
            {'kind': 'chirp', **CHIRP, 'frequency_high': 0.1},
            'frequency_high = 0.1 is not allowed: give a frequency above frequency_low = 0.1 Hz',
        ),
        (  # the mean frequency of the sweep is 9.9 Hz / ln 100
            {'kind': 'chirp', **CHIRP, 'sweep_time': 0.5},
            'sweep_time = 0.5 is not allowed: give at least 0.9303 s, in which the sweep has two ',
        ),
        (
            {'kind': 'trajectory', 'times': [1, 2], 'positions': [0]},
            'positions = [0.0] is not allowed: give as many as times: 2, not 1',
        ),
        (
            {'kind': 'trajectory', 'times': [0, 2, 2], 'positions': [0, 1, 2]},
            'times[2] = 2.0 is not allowed: give ascending times: at least 0.001 s after times[1]',
        ),
        (
            {'kind': 'trajectory', 'times': [5e-4], 'positions': [0]},
            'times[0] = 0.0005 is not allowed: give ascending times: at least 0.001 s after the ',
        ),
        (
            {'kind': 'trajectory', 'times': [0, 1], 'positions': [0.1, 0.2]},
            'positions[0] = 0.1 is not allowed: give 0 at time 0, where the rig starts',
        ),
    ],
)
def test_bad_descriptions(values, sentence):
    with pytest.raises(ParameterError) as error:
        reference_of(values, 'step.yaml: reference')
    assert str(error.value).startswith(f'step.yaml: reference: {sentence}')
    assert '\n' not in str(error.value)


def test_a_reference_in_python_is_checked_and_compared_by_value():
    assert Sine(amplitude=1, frequency=2) == reference_of(
        {'kind': 'sine', 'amplitude': 1.0, 'frequency': 2.0, 'time': 1}, 'test'
    )
    with pytest.raises(ParameterError, match=r'^amplitude = nan is not allowed'):
        Sine(amplitude=float('nan'), frequency=1.0)
    assert list(REFERENCES) == [
        *('hold', 'step', 'staircase', 'sine', 'chirp', 'minimum_jerk', 'trajectory')
    ]
