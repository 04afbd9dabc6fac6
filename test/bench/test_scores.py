# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Scores of trials whose values are known from closed forms, and trials without them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.bench.scores import SCORES, score, scores_of
from pam_ros.bench.trial import Trial

PERIOD = 0.002
T = np.arange(5001) * PERIOD  # 10 s
LOW, HIGH = 0.0, 6e5


def trial(reference=0.0, position=0.0, pressure=1e5, changes=(), **more):
    """Return a trial at the times T: of one muscle, unless *pressure* has two columns."""
    full = np.broadcast_to(np.asarray(pressure, dtype=float).T, (*np.shape(pressure)[1:], T.size))
    rows = np.atleast_2d(full).T
    given_ = {
        't': T,
        'reference': np.zeros(T.size) + reference,
        'position': np.zeros(T.size) + position,
        'pressure': rows,
        'limits': np.repeat([[LOW], [HIGH]], rows.shape[1], axis=1),
        'answer': np.full(T.size, 1e-3),
        'changes': np.array(changes, dtype=float),
    }
    return Trial(**{**given_, **more})


def step(response, size=0.02, **more):
    """Return the trial of a step of *size* at 1 s with the *response* of unit size."""
    after = np.maximum(T - 1.0, 0.0)
    return trial(size * (T >= 1.0), size * response(after), **more)


def decay(t0, size):
    """Return an error that appears at *t0* and falls with a time constant of 1 s."""
    return np.where(t0 - 1e-9 < T, size * np.exp(-np.maximum(T - t0, 0.0)), 0.0)


# Errors ------------------------------------------------------------------------------------------


def test_the_errors_of_a_sine_from_its_first_motion_on():
    """Eight whole periods of a sine that nothing follows, after an offset that does not count."""
    sine = np.where(T > 2.0, 0.03 * np.sin(2.0 * np.pi * (T - 2.0)), 0.0)
    found = scores_of(trial(sine, np.where(T < 1.9, 0.5, 0.0)))
    assert found['rms_error'] == pytest.approx(0.03 / math.sqrt(2.0), rel=1e-3)
    assert found['worst_error'] == pytest.approx(0.03, rel=1e-9)
    assert found['error_at_rest'] is found['settling_time'] is found['overshoot'] is None
    assert found['chatter'] is None


@pytest.mark.parametrize(
    ('reference', 'changes', 'begin'),
    [(0.0, (), 1.0), (0.0, (0.5,), 0.5), (T >= 4.0, (6.0,), 4.0), (T >= 6.0, (4.0,), 4.0)],
)
def test_where_the_errors_begin(reference, changes, begin):
    """The position is off by 0.1 in one sample: the last that does not count, or the first."""
    sample = round(begin / PERIOD)
    for offset, worst in ((-1, 0.0), (0, 0.1)):
        off = np.zeros(T.size)
        off[sample + offset] = 0.1
        found = scores_of(trial(reference, np.zeros(T.size) + reference + off, changes=changes))
        assert found['worst_error'] == pytest.approx(worst, abs=1e-12)


@pytest.mark.parametrize(
    ('moved', 'changed', 'value'),
    [(6.0, 6.0, 0.003), (6.002, 1.0, None), (1.0, 6.002, None), (1.0, 1.0, 0.003)],
)
def test_rest_takes_four_seconds_and_its_error_is_that_of_the_last_two(moved, changed, value):
    reference = 0.02 * (moved - 1e-9 < T)
    error = np.where(T < 8.0 - 1e-9, 0.5, 0.001)
    error[4600] = -0.003
    found = scores_of(trial(reference, reference - error, changes=(changed,)))
    assert found['error_at_rest'] == (None if value is None else pytest.approx(value))
    assert (found['chatter'] is None) == (value is None)


# Responses ---------------------------------------------------------------------------------------


@pytest.mark.parametrize('size', [0.02, -0.3])
@pytest.mark.parametrize('zeta', [0.2, 0.5, 0.7])
def test_the_overshoot_of_a_second_order_response(size, zeta):
    wn, root = 5.0, math.sqrt(1.0 - zeta**2)

    def response(t):
        wave = np.cos(wn * root * t) + zeta / root * np.sin(wn * root * t)
        return 1.0 - np.exp(-zeta * wn * t) * wave

    found = scores_of(step(response, size))
    assert found['overshoot'] == pytest.approx(100.0 * math.exp(-math.pi * zeta / root), rel=1e-3)


@pytest.mark.parametrize(
    ('response', 'time'),
    [
        (lambda t: 1.0 - np.exp(-2.0 * t), math.log(50.0) / 2.0),
        # (1 + x) exp(-x) = 0.02 at x = 5.8339
        (lambda t: 1.0 - (1.0 + 3.0 * t) * np.exp(-3.0 * t), 5.8339 / 3.0),
        (lambda t: 0.97 * np.sign(t), 9.0),  # never: the time to the end
        (np.ones_like, 0.0),
    ],
)
def test_the_settling_time_of_known_responses(response, time):
    found = scores_of(step(response))
    assert found['settling_time'] == pytest.approx(time, abs=1.5 * PERIOD)
    assert found['overshoot'] == pytest.approx(0.0, abs=1e-9)


def test_the_worst_of_several_jumps_counts_each_up_to_the_next_jump_or_change():
    """A jump of 1 at 1 s never settles, one of -4 at 4 s overshoots until the load changes."""
    reference = np.select([T < 1.0, T < 4.0], [0.0, 1.0], -3.0)
    position = np.select([T < 1.0, T < 4.0, T < 4.5], [0.0, 0.5, -3.4], -3.0)
    kicked = np.where(T > 7.0, -9.0, position)
    found = scores_of(trial(reference, kicked, changes=(7.0,)))
    assert found['settling_time'] == pytest.approx(3.0)
    assert found['overshoot'] == pytest.approx(10.0)
    assert scores_of(trial(reference, position))['recovery'] is None


def test_a_reference_that_moves_between_its_jumps_has_no_response():
    drift = 0.02 * (T >= 1.0) + np.maximum(T - 5.0, 0.0) * 1e-7
    found = scores_of(trial(drift, drift))
    assert found['settling_time'] is found['overshoot'] is None


@pytest.mark.parametrize(
    ('changes', 'noise', 'is_revolute', 'time'),
    [
        ((2.0,), 0.0, False, math.log(0.01 / 1e-4)),
        ((0.0,), 0.0, False, 2.0 + math.log(0.01 / 1e-4)),  # no error before it
        ((2.0,), 0.0, True, math.log(0.01 / 1e-3)),
        ((2.0,), 4e-4, False, math.log(0.01 / 2e-3)),
        ((2.0, 3.0), 0.0, False, 1.0),  # not before the second one, whose band is then wide
        ((2.0, 9.5), 0.0, False, math.log(0.01 / 1e-4)),
        ((2.0, 2.0, -3.0, 50.0), 0.0, False, math.log(0.01 / 1e-4)),
    ],
)
def test_recovery_from_changes(changes, noise, is_revolute, time):
    """An error of 0.01 that falls with a time constant of 1 s, after a small constant error."""
    error = decay(2.0, 0.01) + noise * (T < 2.0 - 1e-9)
    found = scores_of(trial(0.0, -error, changes=changes, is_revolute=is_revolute))
    assert found['recovery'] == pytest.approx(time, abs=1.5 * PERIOD)


def test_recovery_ends_at_a_motion_and_needs_rest_around_the_change():
    kick = decay(2.0, 0.1)
    for jump, time in ((2.5, None), (1.5, None), (4.0, 2.0)):
        reference = jump - 1e-9 < T
        found = scores_of(trial(reference, reference - kick, changes=(2.0,)))
        assert found['recovery'] == (None if time is None else pytest.approx(time))


# Outages -----------------------------------------------------------------------------------------

OUTAGE = np.array([[4.0, 5.0]])


def test_what_happens_during_an_outage_does_not_count():
    """An error of 1 mm before, of 500 mm during an outage, and of 3 mm after it."""
    out = (T > 4.0 - 1e-9) & (T < 5.0 - 1e-9)
    error = np.where(out, 0.5, np.where(T < 4.5, 1e-3, 3e-3))
    sine = 0.01 * np.sin(2.0 * np.pi * np.maximum(T - 1.0, 0.0))
    pressure = np.where(out, 0.0, np.where(T < 4.5, 1e5, 3e5))
    found = scores_of(trial(sine, sine - error, pressure, outages=OUTAGE))
    assert found['rms_error'] == pytest.approx(math.sqrt((3 * 1e-6 + 5 * 9e-6) / 8), rel=1e-3)
    assert found['worst_error'] == pytest.approx(3e-3)
    assert found['pressure_variation'] == pytest.approx(200.0 / 8.0, rel=1e-3)
    assert found['recovery'] is None  # the reference moves
    held = scores_of(trial(0.0, -error, pressure, outages=OUTAGE))
    assert held['worst_error'] == pytest.approx(3e-3)  # from the return on
    assert held['pressure_variation'] == pytest.approx(200.0 / 5.0, rel=1e-3)
    wild = scores_of(trial(pressure=np.where(out, 9e5, 1e5), outages=OUTAGE))
    assert wild['limit_violations'] == pytest.approx(10.0, rel=1e-2)


@pytest.mark.parametrize('changes', [(), (4.5,), (5.0,)])
def test_a_recovery_begins_at_the_return(changes):
    """A change of the rig during the outage belongs to it; the band is that before the outage."""
    error = decay(5.0, 0.01) + np.where((T > 4.0) & (T < 5.0 - 1e-9), 0.3, 0.0)
    found = scores_of(trial(position=error, outages=OUTAGE, changes=changes))
    assert found['recovery'] == pytest.approx(math.log(100.0), abs=PERIOD)
    again = np.array([[4.0, 5.0], [7.0, np.inf]])
    assert scores_of(trial(position=error, outages=again))['recovery'] == pytest.approx(2.0)


def test_a_jump_ends_with_an_outage_and_has_no_meaning_in_one():
    response = step(lambda t: -np.expm1(-t), outages=OUTAGE)
    assert scores_of(response)['settling_time'] == pytest.approx(3.0)
    hidden = replace(response, outages=np.array([[0.5, 2.0]]))
    assert scores_of(hidden)['settling_time'] is None


@pytest.mark.parametrize(
    ('outage', 'has_rest'), [((4.0, 5.9), True), ((4.0, 7.0), False), ((4.0, np.inf), False)]
)
def test_a_rest_has_no_outage(outage, has_rest):
    found = scores_of(trial(outages=np.array([outage])))
    assert (found['error_at_rest'] == 0.0) is has_rest
    assert (found['chatter'] is not None) is has_rest


def test_a_rig_that_stops_at_once_has_no_errors():
    found = scores_of(trial(outages=np.array([[0.5, np.inf]])))
    assert found['rms_error'] is found['worst_error'] is found['pressure_variation'] is None
    assert found['limit_violations'] == 0.0


def test_states_without_an_answer_have_no_computing_time():
    answer = np.where(np.arange(T.size) % 3, 2e-3, np.nan)
    found = scores_of(trial(answer=answer))
    assert found['computing_time'] == pytest.approx(2.0)
    assert found['computing_time_worst'] == pytest.approx(2.0)
    assert scores_of(trial(answer=np.full(T.size, np.nan)))['computing_time'] is None


# Pressures ---------------------------------------------------------------------------------------


def test_the_variation_and_the_filling_of_two_muscles():
    """From 0.998 s on, the last command before the step: up and down once, and up above p_max."""
    first = np.select([T < 1.0, T < 5.0], [1e5, 3e5], 2e5)
    second = np.where(T < 3.0, 5e5, 9e5)
    found = scores_of(step(np.sign, pressure=np.column_stack([first, second])))
    duration = 10.0 - 0.998
    assert found['pressure_variation'] == pytest.approx((300.0 + 400.0) / 2.0 / duration)
    assert found['filling'] == pytest.approx((200.0 + 100.0) / duration)
    assert found['limit_violations'] == pytest.approx(100.0 * np.mean(T >= 3.0) / 2.0)


def test_a_command_that_is_not_finite_holds_the_one_before_and_is_a_violation():
    pressure = np.where(T < 5.0, 1e5, 3e5)
    pressure[[0, 1000, 2500, 5000]] = [np.nan, np.inf, -np.inf, np.nan]
    found = scores_of(trial(pressure=pressure))
    assert found['pressure_variation'] == pytest.approx(200.0 / (10.0 - 0.998))
    assert found['limit_violations'] == pytest.approx(100.0 * 4 / T.size)
    assert found['chatter'] is None


def test_chatter_is_what_is_left_of_the_worst_muscle_without_its_drift():
    ripple = np.where(np.arange(T.size) % 2, 500.0, -500.0)
    found = scores_of(trial(pressure=np.column_stack([1e5 + 3e3 * T, 2e5 - 5e3 * T + ripple])))
    assert found['chatter'] == pytest.approx(1.0, rel=1e-3)


@pytest.mark.parametrize(
    ('pressure', 'share'),
    [(LOW, 0.0), (HIGH, 0.0), (np.float32(6e5 + 0.05), 0.0), (LOW - 1.0, 100.0)],
)
def test_limits_are_allowed_and_so_is_single_precision(pressure, share):
    assert scores_of(trial(pressure=pressure))['limit_violations'] == share


# All ---------------------------------------------------------------------------------------------


def test_the_computing_time_is_all_that_depends_on_the_machine():
    answer = np.where(np.arange(T.size) % 50 == 0, 20e-3, 2e-3)  # 2 % are slow
    found = scores_of(trial(answer=answer))
    assert (found['computing_time'], found['computing_time_worst']) == pytest.approx((2.0, 20.0))
    of_machine = {one.name for one in SCORES if one.is_of_machine}
    assert of_machine == {'computing_time', 'computing_time_worst'}


def test_scores_are_described_and_registered_once():
    assert list(scores_of(trial())) == [one.name for one in SCORES]
    assert all(one.text.endswith('.') and one.unit for one in SCORES)
    rms = next(one for one in SCORES if one.name == 'rms_error')
    assert (rms.unit_for(revolute=False), rms.unit_for(revolute=True)) == ('m', 'rad')
    with pytest.raises(ValueError, match='rms_error'):
        score('rms_error', unit='position', text='Again.')


@pytest.mark.filterwarnings('error')
@pytest.mark.parametrize('count', [0, 1, 2, 3, 400, 1500])
@pytest.mark.parametrize('value', [0.0, 1e308, -1e308, np.nan, np.inf])
@pytest.mark.parametrize('changes', [(), (0.0, 2.0)])
def test_every_score_is_finite_or_none_for_short_and_absurd_trials(count, value, changes):
    alternating = np.where(np.arange(T.size) % 2, value, -value)
    whole = trial(T > 1.5, alternating, alternating, changes=changes, answer=alternating)
    names = ('t', 'reference', 'position', 'pressure', 'answer')
    found = scores_of(replace(whole, **{name: getattr(whole, name)[:count] for name in names}))
    assert all(one is None or math.isfinite(one) for one in found.values())
    assert count >= 2 or set(found.values()) == {None}


@given(
    st.lists(st.sampled_from([-0.02, 0.0, 0.03]), min_size=1, max_size=4),
    st.lists(st.floats(0.0, 10.0), max_size=3),
    st.floats(-1.0, 1.0),
    st.sampled_from([0.5, -1.0, 2.0]),
    st.integers(0, 99),
)
def test_scores_do_not_depend_on_the_origin_or_on_the_direction(levels, changes, by, factor, seed):
    """Shift the positions, or scale them: what is relative stays, and errors are scaled."""
    rng = np.random.default_rng(seed)
    reference = np.array([0.0, *levels])[np.minimum((T / 2.0).astype(int), len(levels))]
    position = reference - 0.01 * np.exp(-(T % 2.0)) * np.sin(9.0 * T) * rng.random()
    pressure = 1e5 * rng.random((T.size, 2))
    names = {one.name for one in SCORES if one.unit == 'position'}
    base = scores_of(trial(reference, position, pressure, changes))
    moved = scores_of(trial(reference + by, position + by, pressure, changes))
    scaled = scores_of(trial(factor * reference, factor * position, pressure, changes))
    for name, value in base.items():
        if value is None:
            assert moved[name] is scaled[name] is None
            continue
        size = abs(factor) if name in names else 1.0
        assert moved[name] == pytest.approx(value, rel=1e-6, abs=1e-9 + PERIOD * (name[0] in 'sr'))
        if name != 'recovery':  # its smallest band is absolute
            assert scaled[name] == pytest.approx(size * value, rel=1e-6, abs=1e-9)
