# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whole programmes: their limits, their length, what they leave behind."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.errors import PamError
from pam_ros.excitation.programme import RAMP, limit_rate, plan, programme, write_csv
from pam_ros.excitation.settings import Excitation
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import single_muscle_joint


@settings(max_examples=25, deadline=None)
@given(
    low=st.floats(0.0, 2e5),
    span=st.floats(1e3, 6e5),
    rate_of_change=st.floats(2e4, 1e7),
    duration=st.floats(30.0, 150.0),
    rate=st.floats(20.0, 500.0),
    seed=st.integers(0, 1000),
)
def test_no_programme_exceeds_its_limits(low, span, rate_of_change, duration, rate, seed):
    given_limits = Excitation(
        pressure_min=low,
        pressure_max=low + span,
        pressure_rate=rate_of_change,
        duration=duration,
        rate=rate,
        frequency_max=min(8.0, rate / 10.0),
        seed=seed,
    )
    made = programme(given_limits)
    assert made.pressure.min() == 0.0
    assert made.pressure.max() <= (low + span) * (1 + 1e-12)
    assert np.abs(np.diff(made.pressure)).max() <= rate_of_change / rate * (1 + 1e-9)
    assert made.pressure[0] == 0.0
    assert made.pressure[-1] == 0.0
    assert made.segments[0].start == 0
    assert made.segments[-1].stop == made.pressure.size
    for before, after in zip(made.segments[:-1], made.segments[1:], strict=True):
        assert before.stop == after.start


def test_the_default_takes_its_stated_duration():
    made = programme(Excitation())
    assert made.duration == pytest.approx(85.0, abs=0.5)
    assert made.pressure.max() == pytest.approx(450e3)
    assert [segment.name for segment in made.segments] == [
        'vented',
        'steps',
        'slow_triangle',
        'fast_triangle',
        'multisine',
        'chirps',
        'steps_again',
        'ramp out, vented',
    ]


def test_the_fast_triangle_is_four_times_as_fast():
    made = programme(Excitation())
    parts = {s.name: made.pressure[s.start : s.stop] for s in made.segments}
    slow, fast = (
        np.percentile(np.abs(np.diff(parts[name])), 80)
        for name in ('slow_triangle', 'fast_triangle')
    )
    assert fast / slow == pytest.approx(4.0, rel=0.05)


def test_the_first_steps_come_again_just_so():
    made = programme(Excitation())
    parts = {s.name: made.pressure[s.start : s.stop] for s in made.segments}
    ramp = 300  # commands: 1.5 s
    again = parts['steps_again'][ramp:]
    np.testing.assert_allclose(again, parts['steps'][ramp : ramp + again.size])
    assert again.size > 1500


@pytest.mark.parametrize('seed', range(6) if HAVE_NUMBA else [0])
def test_the_default_keeps_the_papers_rig_within_the_default_window(seed):
    """With a fifth of the room to spare, on either side."""
    chosen, model = Excitation(seed=seed), single_muscle_joint()
    made = programme(chosen)
    moved = simulate(model, made.t, made.t, made.pressure).position / model.muscle.l0
    assert moved.min() > 0.8 * chosen.contraction_min
    assert moved.max() < 0.97 * chosen.contraction_max
    # It goes nearly everywhere, too.
    assert moved.min() < 0.0
    assert moved.max() > 0.85 * chosen.contraction_max


@pytest.mark.parametrize('duration', [30.0, 85.0, 1200.0])
@pytest.mark.parametrize(
    'names', [('chirps', 'steps'), ('steps_again',), ('fast_triangle', 'multisine')]
)
def test_chosen_segments_share_the_duration_in_their_order(names, duration):
    all_six, made = (
        programme(Excitation()),
        programme(Excitation(segments=names, duration=duration)),
    )
    assert [s.name for s in made.segments] == ['vented', *names, 'ramp out, vented']
    assert made.duration == pytest.approx(duration, rel=0.01)

    def lengths(one):
        return {s.name: s.stop - s.start - round(RAMP * one.rate) for s in one.segments}

    usual, longer = lengths(all_six), lengths(made)
    first, last = names[0], names[-1]
    assert longer[last] / longer[first] == pytest.approx(usual[last] / usual[first], rel=0.01)


def test_the_longest_hold_of_the_steps_alone_is_a_part_of_their_duration():
    """3 of 17 parts: the two long holds count three times among thirteen."""
    made = programme(Excitation(segments=('steps',), duration=1200.0))
    at_top = np.count_nonzero(made.pressure == made.pressure.max()) / made.rate
    assert at_top == pytest.approx(3.0 / 17.0 * 1195.0, rel=0.01)


def test_repeated_steps_alone_have_the_levels_of_the_first_steps():
    both = programme(Excitation(segments=('steps', 'steps_again'), seed=2))
    alone = programme(Excitation(segments=('steps_again',), seed=2))

    def levels(one, k):
        part = one.pressure[one.segments[k].start + 300 : one.segments[k].stop]
        return part[1:][np.diff(part) == 0.0]

    found = np.unique(levels(both, 2))
    np.testing.assert_array_equal(np.unique(levels(alone, 1)), found)
    assert found.size == 5


def test_the_same_settings_give_the_same_bits():
    one, other = programme(Excitation(seed=3)), programme(Excitation(seed=3))
    assert one.pressure.tobytes() == other.pressure.tobytes()
    assert one.segments == other.segments
    assert programme(Excitation(seed=4)).pressure.tobytes() != one.pressure.tobytes()


def test_a_command_holds_until_the_next():
    made = programme(Excitation(rate=100.0))
    k = 1234
    assert made.at(k / 100.0) == made.pressure[k]
    assert made.at(k / 100.0 + 0.0099) == made.pressure[k]
    assert made.at(-1.0) == made.at(1e6) == 0.0
    assert made.segment_at(0.5).name == 'vented'
    assert made.segment_at(1e6).name == 'ramp out, vented'


def test_a_rate_limit_catches_up():
    wanted = np.array([0.0, 5.0, 5.0, 5.0, -1.0, 0.0, 0.0])
    np.testing.assert_allclose(limit_rate(wanted, 2.0), [0.0, 2.0, 4.0, 5.0, 3.0, 1.0, 0.0])


def test_the_plan_has_times_levels_and_speeds():
    chosen = Excitation(seed=7)
    text = plan(programme(chosen), chosen)
    lines = text.splitlines()
    assert len(lines) == 10
    assert lines[2].startswith('steps ')
    assert '450 kPa' in lines[2]
    assert 'hysteresis' in lines[3]
    assert lines[-1].startswith('total 8')
    assert '1500 kPa/s' in lines[-1]
    assert 'seed 7' in lines[-1]


def test_the_csv_holds_the_commands(tmp_path):
    made = programme(Excitation(duration=30.0))
    write_csv(made, tmp_path / 'plan.csv')
    table = np.genfromtxt(tmp_path / 'plan.csv', delimiter=',', names=True)
    np.testing.assert_array_equal(table['t_s'], made.t)
    np.testing.assert_array_equal(table['pressure_command_Pa'], made.pressure)
    assert len(list(tmp_path.iterdir())) == 1


def test_a_csv_that_cannot_be_written(tmp_path):
    with pytest.raises(PamError, match=r'plan\.csv cannot be written'):
        write_csv(programme(Excitation(duration=30.0)), tmp_path / 'nowhere' / 'plan.csv')
