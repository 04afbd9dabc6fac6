# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is refused in a recording, and what is warned of."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.bounds import Bounds
from pam_ros.recording.quality import check
from pam_ros.recording.recording import Recording

T = np.arange(4000) * 0.005
KNOWN = Bounds(l0=0.4, p_max=(6e5,))
RNG = np.random.default_rng(11)


def recording(**changes):
    """Return a good one: 20 s at 200 Hz, a smooth command, noise on what is measured."""
    command = 3e5 + 2e5 * np.sin(1.3 * T) * np.sin(0.21 * T)
    one = Recording(
        name='log',
        t=T,
        command_t=T,
        command=command,
        position=2e-7 * command + 1e-5 * RNG.normal(size=T.size),
        velocity=None,
        force=196.0 + RNG.normal(size=T.size),
        pressure=command + 500.0 * RNG.normal(size=T.size),
        kind='free',
    )
    return replace(one, **changes)


def held(**changes):
    one = recording(kind='held', position=np.full(T.size, 0.04), command=None, command_t=None)
    return replace(one, **changes)


def test_a_good_recording_has_no_warnings():
    assert check(recording(), KNOWN) == ()
    assert check(held(), KNOWN) == ()


def test_an_isometric_muscle_may_be_sampled_slowly_and_the_unit_is_requested():
    (warning,) = check(held(t=np.arange(T.size) * 1.0), KNOWN)
    assert warning == 'samples are 1 s apart: is the time in another unit?'


def constant(value):
    return {'command': np.full(T.size, value)}


@pytest.mark.parametrize(
    ('one', 'p_max', 'words'),
    [
        (recording().part(0, 80), None, ['80 usable samples', '100']),
        (recording(t=T * 1e3), None, ['5 s apart', 't_ms']),
        (recording(t=T * 1e-6), None, ['5e-09 s apart']),
        (recording(t=np.arange(T.size) * 1.0), None, ['1 s apart', '5e-05 to 0.25 s', 't_ms']),
        (recording(t=T * 2e-3), None, ['1e-05 s apart']),
        (held(t=np.arange(T.size) * 2.5), None, ['2.5 s apart', '5e-05 to 2 s']),
        (recording(position=recording().position * 1e3), None, ['position reaches', '10 m']),
        (
            recording(command=recording().command * 1e3),
            None,
            ['pressure_command reaches', '1e+07'],
        ),
        (recording(command=recording().command * 1e-5), 6e5, ['stays below 4.9', 'bar']),
        (recording(force=recording().force * 1e5), None, ['force reaches']),
        (recording(**constant(2e5)), None, ['pressure_command is constant at 200000 Pa']),
        (held(pressure=3e5 + 900.0 * RNG.normal(size=T.size)), None, ['pressure is constant at']),
        (recording(position=np.full(T.size, 0.03)), None, ['position is constant while']),
        (held(force=np.full(T.size, 7.0)), None, ['force is constant while pressure changes']),
    ],
)
def test_what_is_refused(one, p_max, words):
    with pytest.raises(RecordingError) as caught:
        check(one, Bounds() if p_max is None else Bounds(p_max=(p_max,)))
    assert str(caught.value).startswith('log')
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize('position', [-1.0, -0.09, 0.41])
def test_a_position_that_is_not_one_of_the_muscle(position):
    one = recording(position=np.append(recording().position[1:], position))
    words = (
        rf'position = {position:g} m at 19\.995 s .* l0 = 0\.4 m: positions are -0\.08 to 0\.4 m'
    )
    with pytest.raises(RecordingError, match=words):
        check(one, Bounds(l0=0.4))
    check(one)


def test_a_moving_length_makes_up_for_a_constant_pressure():
    moved = held(position=0.04 + 0.02 * np.sin(T), pressure=np.full(T.size, 3e5))
    assert check(moved) == ()


def test_a_small_signal_about_a_pressure_is_not_constant():
    small = held(pressure=3e5 + 900.0 * np.sin(T) + 100.0 * RNG.normal(size=T.size))
    assert any('covers only' in warning for warning in check(small))


def only(one, **known):
    """Return the one warning that there is."""
    (warning,) = check(one, Bounds(**known))
    return warning


def test_gaps_are_counted_and_measured():
    gaps = ((1.0, 1.3), (5.0, 7.0))
    assert '2 gap(s) without samples, 2.3 s in all, the longest 2 s at 5 s' in only(
        recording(gaps=gaps)
    )


def test_a_clipped_sensor():
    clipped = np.maximum(held().pressure * 1e-3 - 200.0, -18.6)
    warning = only(held(force=clipped))
    assert 'force stays at its lowest value, -18.6 N' in warning


def test_a_muscle_that_is_vented_does_not_look_like_a_clipped_sensor():
    """Where the command rests at its own extreme, so does an ideal pressure."""
    command = np.clip(recording().command, 2.2e5, 4.5e5)
    assert check(recording(command=command, pressure=command)) == ()


def test_a_coarse_sensor():
    coarse = np.round(recording().position / 2e-3) * 2e-3
    assert any(
        'position takes only' in warning and '0.002 m apart' in warning
        for warning in check(recording(position=coarse))
    )


def test_units_are_compared_with_the_properties_of_the_muscle():
    assert 'position reaches' in only(recording(), l0=0.1)
    assert 'above p_max = 300000 Pa' in only(recording(), p_max=(3e5,))


def test_an_absolute_pressure():
    vented = recording().command - recording().command.min()
    one = recording(command=vented, pressure=vented + 101325.0)
    assert any('is it absolute?' in warning for warning in check(one))


@pytest.mark.parametrize(
    ('changes', 'words'),
    [
        (constant(0.0) | {'command': 2e5 + 1e5 * (T > 9.0)}, ['only 2 levels', 'reverses 0']),
        ({'command': 3e5 + 2e4 * np.sin(3.0 * T)}, ['covers only 12 %']),
        ({'command': 1e5 + 2e4 * T}, ['reverses 0 time(s)']),
        (
            {'command': 6e5 * np.clip(np.sin(T) * 3.0, 0.0, 1.0) * (T > 10.0)},
            ['at its lowest value in 7'],
        ),
    ],
)
def test_poor_excitation(changes, words):
    warnings = check(recording(pressure=None, **changes))
    for word in words:
        assert any(word in warning for warning in warnings)


def test_a_short_recording():
    warnings = check(recording().part(0, 1500))
    assert any('only 7.5 s long' in warning for warning in warnings)


def test_a_load_that_hardly_moves_may_be_in_another_unit():
    """Metres called mm: 0.1 mm of 400 mm, where the pressure changes by two thirds of p_max."""
    small = recording(position=1e-3 * recording().position)
    words = ['% of l0 = 0.4 m', 'changes by 65 % of p_max', 'position_m']
    warning = only(small, l0=0.4, p_max=(6e5,))
    assert all(word in warning for word in words), warning
    quiet = recording(command=3e5 + 2e4 * np.sin(T), position=1e-3 * recording().position)
    assert not any('another unit' in one for one in check(quiet, KNOWN))
    assert check(recording(), KNOWN) == check(held(), KNOWN) == ()
    turned = replace(small, unit='rad')
    assert '% of its reach' in only(turned, p_max=(6e5,), reach=(-1.0, 1.0))


def test_a_free_load_that_is_hardly_resolved():
    """Milliseconds of a logger at 10 kHz that are taken for seconds."""
    slow = recording(t=T * 20.0, command_t=T * 20.0)
    assert any('0.1 s apart' in one and 'another unit' in one for one in check(slow))
    assert check(held(t=T * 20.0, pressure=recording().pressure)) == ()


def test_a_force_that_is_always_the_same():
    warning = only(recording(force=np.zeros(T.size)))
    assert warning == 'force is 0 N in every sample: is the force cell connected?'


def test_a_position_with_the_opposite_sign():
    turned = recording(position=0.12 - recording().position)
    warning = only(turned)
    assert warning.startswith('position falls where pressure_command rises')
    assert "--column 'NAME=position_mm*-1+OFFSET'" in warning
    assert check(recording(position=0.05 + 1e-3 * np.sin(40.0 * T))) == ()  # of no direction
