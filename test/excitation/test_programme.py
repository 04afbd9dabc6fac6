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
    sides=st.sampled_from([(1,), (1, -1), (1, 1), (1, -1, 1)]),
)
def test_no_programme_exceeds_its_limits(low, span, rate_of_change, duration, rate, seed, sides):
    given_limits = Excitation(
        pressure_min=low,
        pressure_max=low + span,
        pressure_rate=rate_of_change,
        duration=duration,
        rate=rate,
        frequency_max=min(8.0, rate / 10.0),
        seed=seed,
    )
    made = programme(given_limits, sides)
    assert made.pressure.min() == 0.0
    assert made.pressure.max() <= (low + span) * (1 + 1e-12)
    assert made.pressure.shape[1] == len(sides)
    assert np.abs(np.diff(made.pressure, axis=0)).max() <= rate_of_change / rate * (1 + 1e-9)
    assert not made.pressure[0].any()
    assert not made.pressure[-1].any()
    assert made.segments[0].start == 0
    assert made.segments[-1].stop == len(made.pressure)
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
        np.percentile(np.abs(np.diff(parts[name], axis=0)), 80)
        for name in ('slow_triangle', 'fast_triangle')
    )
    assert fast / slow == pytest.approx(4.0, rel=0.05)


def test_the_first_steps_come_again_just_so():
    made = programme(Excitation())
    parts = {s.name: made.pressure[s.start : s.stop] for s in made.segments}
    ramp = 300  # commands: 1.5 s
    again = parts['steps_again'][ramp:]
    np.testing.assert_allclose(again, parts['steps'][ramp : ramp + len(again)])
    assert len(again) > 1500


@pytest.mark.parametrize('seed', range(6) if HAVE_NUMBA else [0])
def test_the_default_keeps_the_papers_rig_within_the_default_window(seed):
    """With a fifth of the room to spare, on either side."""
    chosen, model = Excitation(seed=seed), single_muscle_joint()
    made = programme(chosen)
    moved = simulate(model, made.t, made.pressure).position / model.muscle.l0
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
        part = one.pressure[one.segments[k].start + 300 : one.segments[k].stop, 0]
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
    write_csv(made, tmp_path / 'plan.csv', ['pam'])
    table = np.genfromtxt(tmp_path / 'plan.csv', delimiter=',', names=True)
    np.testing.assert_array_equal(table['t_s'], made.t)
    np.testing.assert_array_equal(table['pressure_command_Pa'], made.pressure[:, 0])
    assert len(list(tmp_path.iterdir())) == 1


def test_the_csv_of_several_muscles_is_one_that_is_read_as_theirs(tmp_path):
    made = programme(Excitation(duration=30.0), (1, -1))
    write_csv(made, tmp_path / 'plan.csv', ['flexor', 'extensor'])
    with (tmp_path / 'plan.csv').open() as stream:
        names = stream.readline().strip().split(',')
    assert names == ['t_s', 'flexor.pressure_command_Pa', 'extensor.pressure_command_Pa']
    table = np.loadtxt(tmp_path / 'plan.csv', delimiter=',', skiprows=1)
    np.testing.assert_array_equal(table, np.column_stack((made.t, made.pressure)))


# Several muscles -------------------------------------------------------------------------------


def part(made, name):
    """Return the commands of a segment after its ramp, (n, muscles)."""
    (one,) = (s for s in made.segments if s.name == name)
    return made.pressure[one.start + round(RAMP * made.rate) : one.stop]


@pytest.mark.parametrize('sides', [(1, -1), (1, 1)])
def test_only_one_of_two_muscles_steps_at_a_time(sides):
    steps = part(programme(Excitation(pressure_rate=1e9), sides), 'steps')
    changes = np.diff(steps, axis=0) != 0.0
    assert changes.sum(axis=0).min() >= 11
    assert not changes.all(axis=1).any()


@pytest.mark.parametrize('sides', [(1, -1), (1, 1)])
def test_the_steps_of_two_muscles_move_the_joint_nearly_as_far_as_the_triangle(sides):
    made = programme(Excitation(), sides)
    moved = {name: np.ptp(part(made, name) @ sides) for name in ('steps', 'slow_triangle')}
    assert moved['steps'] > 0.9 * moved['slow_triangle']


@pytest.mark.parametrize('sides', [(1, -1), (1, 1)])
def test_two_muscles_have_independent_commands_in_steps_and_multisine(sides):
    """So that what is in one muscle can be distinguished from what is in the other."""
    made = programme(Excitation(), sides)
    assert abs(np.corrcoef(part(made, 'multisine').T)[0, 1]) < 1e-9
    along, across = (np.std(part(made, 'steps') @ way) for way in (sides, (1, -sides[1])))
    assert across > 0.25 * along


def test_the_chirps_of_opposite_muscles_move_the_joint_at_one_mean_pressure():
    one, other = part(programme(Excitation(), (1, -1)), 'chirps').T
    mean = 0.5 * (one + other)
    levels = np.array([0.25, 0.5, 0.75]) * 400e3 + 50e3
    for level in levels:
        assert np.count_nonzero(np.abs(mean - level) < 1.0) > 0.2 * mean.size
    assert np.abs(one - other).max() == pytest.approx(0.08 * 400e3, rel=0.1)


def test_one_muscle_has_the_same_commands_as_the_first_of_two():
    alone, first = programme(Excitation()), programme(Excitation(), (1, -1))
    for name in ('steps', 'slow_triangle', 'fast_triangle'):
        np.testing.assert_array_equal(part(alone, name)[:, 0], part(first, name)[:, 0])


def test_a_csv_that_cannot_be_written(tmp_path):
    with pytest.raises(PamError, match=r'plan\.csv cannot be written'):
        write_csv(programme(Excitation(duration=30.0)), tmp_path / 'nowhere' / 'plan.csv', ['pam'])
