# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Signals on stamps of their own become one recording."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.assemble import assemble
from pam_ros.recording.series import Series

T = np.arange(1000) * 0.01


def signal(name, value, t=T):
    return Series(name, np.asarray(t, float), np.broadcast_to(np.asarray(value, float), len(t)))


def free(**others):
    series = {
        'position': signal('y', 0.05 + 0.03 * np.sin(T)),
        'pressure_command': signal('u', [1e5, 2e5], [0.0, 5.0]),
        **others,
    }
    return {name: one for name, one in series.items() if one is not None}


def held(**others):
    series = {
        'contraction': signal('k', 0.0905),
        'pressure': signal('p', 2e5 + 1e5 * np.cos(T)),
        'force': signal('f', 100.0 + 50.0 * np.cos(T)),
        **others,
    }
    return {name: one for name, one in series.items() if one is not None}


def test_a_free_load():
    one = assemble('log', free(), ['a note'])
    assert one.kind == 'free'
    assert one.warnings == ('a note',)
    assert one.gaps == ()
    np.testing.assert_array_equal(one.t, T)
    np.testing.assert_allclose(one.command_t, [0.0, 5.0])
    np.testing.assert_array_equal(one.command, [1e5, 2e5])
    assert one.force is None
    assert one.pressure is None


def test_a_held_length_is_found_by_its_standing_still():
    one = assemble('log', held(), [], l0=0.398)
    assert one.kind == 'held'
    assert one.command is None
    np.testing.assert_allclose(one.position, 0.0905 * 0.398)
    np.testing.assert_array_equal(one.force, held()['force'].value)


def test_noise_of_the_position_does_not_make_a_held_length_move():
    rng = np.random.default_rng(5)
    noisy = signal('y', 0.036 + 2e-5 * rng.normal(size=T.size))
    assert assemble('log', held(contraction=None, position=noisy), []).kind == 'held'


def test_a_load_that_moves_is_free_though_its_force_is_measured():
    assert assemble('log', free(force=signal('f', 196.0 + np.sin(T))), []).kind == 'free'


def test_a_length_that_is_moved_is_prescribed_if_the_user_states_it():
    series = free(force=signal('f', 196.0 + np.sin(T)))
    one = assemble('log', series, [], kind='held')
    assert one.kind == 'held'
    assert one.command is not None


def test_commands_and_pressures_alone_are_a_pressure_path():
    series = free(position=None, pressure=signal('p', 2e5 + 1e5 * np.cos(T)))
    one = assemble('log', series, [])
    assert one.kind == 'pressure'
    assert one.position is None
    np.testing.assert_array_equal(one.pressure, series['pressure'].value)
    assert one.warnings == (
        'neither a position nor a force was recorded: only the pressure path is identified',
    )
    # A recording with a position is one if its user states it.
    whole = assemble('log', free(pressure=series['pressure']), [], kind='pressure')
    assert whole.kind == 'pressure'
    assert whole.warnings == ()


def test_a_pressure_path_needs_a_pressure():
    with pytest.raises(RecordingError, match='log has no pressure: both are needed'):
        assemble('log', free(), [], kind='pressure')


def test_the_first_sample_is_time_zero():
    late = {name: Series(one.source, one.t + 1.7e9, one.value) for name, one in free().items()}
    one = assemble('log', late, [])
    assert one.t[0] == 0.0
    assert one.origin == 1.7e9
    np.testing.assert_allclose(one.t, T, atol=1e-6)
    np.testing.assert_allclose(one.command_t, [0.0, 5.0], atol=1e-6)


def test_samples_before_the_first_command_are_left_out():
    one = assemble('log', free(pressure_command=signal('u', [1e5, 2e5], [0.995, 5.0])), [])
    assert one.origin == pytest.approx(1.0)
    assert one.t.size == 900
    np.testing.assert_allclose(one.command_t, [-0.005, 4.0])
    assert one.warnings == ('the first 0.995 s have no command yet and are left out',)


def test_of_earlier_commands_the_last_is_kept():
    one = assemble('log', free(pressure_command=signal('u', [1, 2, 3, 4], [-9, -3, 2, 4])), [])
    np.testing.assert_allclose(one.command_t, [-3.0, 2.0, 4.0])


def test_other_outputs_are_linear_between_their_samples():
    t = np.arange(-0.5, 10.5, 0.17)
    one = assemble('log', free(force=signal('f', 3.0 * t + 7.0, t)), [])
    np.testing.assert_allclose(one.force, 3.0 * T + 7.0, atol=1e-12)


def test_the_stamps_of_a_held_length_are_those_of_the_force():
    slow = np.arange(-0.1, 10.1, 0.04)
    one = assemble('log', held(pressure=signal('p', 1e5 + 1e4 * slow, slow)), [], l0=0.4)
    np.testing.assert_array_equal(one.t, T)
    np.testing.assert_allclose(one.pressure, 1e5 + 1e4 * T)


def test_only_what_all_needed_signals_cover_is_used():
    late = T[50:]
    one = assemble('log', held(pressure=signal('p', 1e5 + late, late)), [], l0=0.4)
    assert one.t.size == 950


def test_an_output_that_covers_too_little_is_left_out_and_noted():
    early = T[:500]
    one = assemble('log', free(force=signal('cell', np.sin(early), early)), [])
    assert one.force is None
    assert one.t.size == 1000
    assert one.warnings == ('cell is not used: it covers 51 % of the samples',)


def test_time_that_goes_backwards_is_refused():
    back = T.copy()
    back[500:] -= 1.0
    with pytest.raises(RecordingError, match='log: time of f goes backwards'):
        assemble('log', free(force=signal('f', 1.0, back)), [])


def test_a_clock_too_coarse_for_what_is_needed_is_refused():
    coarse = signal('y', np.sin(T), np.floor(T * 50) / 50)
    with pytest.raises(RecordingError, match='500 of 1000 samples of y share their time'):
        assemble('log', free(position=coarse), [])


def test_a_clock_too_coarse_for_what_is_not_needed():
    coarse = signal('cell', np.sin(T), np.floor(T * 50) / 50)
    one = assemble('log', free(force=coarse), [])
    assert one.force is None
    assert one.warnings == (
        '500 of 1000 samples of cell share their time with the one before: it is not used',
    )


def test_states_that_were_published_again_while_time_stood_still_are_one():
    """A simulator that is paused, or waits for its controller, repeats its last state."""
    t = np.insert(T, 0, np.full(200, T[0]))
    one = assemble('log', free(position=signal('y', np.sin(t), t)), [])
    assert one.warnings == ()
    np.testing.assert_array_equal(one.position, np.sin(T))


def test_of_commands_at_one_time_the_last_holds():
    command = signal('u', [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.0, 0.0, 1.0, 1.0, 1.0, 2.0])
    one = assemble('log', free(pressure_command=command), [])
    assert one.command.tolist() == [2.0, 5.0, 6.0]
    assert one.warnings == ('3 of 6 samples of u share their time with another: the last is kept',)


def test_a_gap_is_recorded():
    keep = (T < 3.0) | (T >= 4.5)
    one = assemble('log', free(position=signal('y', np.sin(T[keep]), T[keep])), [])
    assert one.gaps == ((pytest.approx(2.99), pytest.approx(4.5)),)
    assert [part.t.size for part in one.segments()] == [300, 550]


def test_where_another_signal_is_missing_is_a_gap_as_well():
    keep = (T < 3.0) | (T >= 3.5)
    one = assemble('log', free(force=signal('f', np.sin(T[keep]), T[keep])), [])
    assert one.gaps == ((pytest.approx(2.99), pytest.approx(3.5)),)
    np.testing.assert_array_equal(one.t, T[keep])


def test_a_stream_of_commands_that_pauses_is_noted():
    stream = np.r_[0.0:4.0:0.01, 6.0:10.0:0.01]
    one = assemble('log', free(pressure_command=signal('u', 1e5 * stream, stream)), [])
    assert len(one.warnings) == 1
    assert 'commands came every 10 ms but pause 1 time(s)' in one.warnings[0]
    assert 'the longest at 3.99 s for 2.01 s' in one.warnings[0]


def test_commands_at_each_change_are_no_stream():
    assert assemble('log', free(), []).warnings == ()


@pytest.mark.parametrize(
    ('series', 'kind', 'l0', 'words'),
    [
        (free(pressure_command=None), None, None, ['neither pressure_command nor pressure']),
        (free(position=None), None, None, ['no position']),
        (held(), None, None, ['k is a contraction', 'l0']),
        (held(contraction=None), None, 0.4, ['no position', 'force was measured']),
        (free(), 'held', None, ['no force']),
        (free(), 'stuck', None, ["kind = 'stuck'", 'free, held']),
        (free(pressure_command=signal('u', [1.0], [99.0])), None, None, ['not overlap in time']),
        (
            free(pressure_command=None, pressure=signal('p', T, T + 20.0)),
            None,
            None,
            ['not overlap in time'],
        ),
    ],
)
def test_a_missing_signal_is_named(series, kind, l0, words):
    with pytest.raises(RecordingError) as caught:
        assemble('log', series, [], kind, l0)
    assert 'log' in str(caught.value) or 'kind' in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_a_position_is_taken_before_a_contraction():
    one = assemble('log', free(contraction=signal('k', 0.1)), [])
    np.testing.assert_array_equal(one.position, free()['position'].value)
    assert one.warnings == ('k is not used: the position was measured as well',)
