# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which samples fits see, which choices see, and which judge."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.identification.data.division import BLOCKS
from pam_ros.identification.data.parts import like, parts_in_time, parts_in_turn, parts_of, run_of
from support import bench_truth

FREE = bench_truth.free(duration=20.0)


def counts(part):
    return [int(np.count_nonzero(mask)) for mask in (part.fit, part.choose, part.judge)]


def test_every_sample_is_in_one_part_in_the_order_of_time():
    (part,) = parts_of([FREE], 0.55, 0.75)
    masks = np.stack([part.fit, part.choose, part.judge])
    np.testing.assert_array_equal(masks.sum(axis=0), 1)
    order = masks.argmax(axis=0)
    assert np.all(np.diff(order) >= 0)
    shares = np.array(counts(part)) / FREE.t.size
    np.testing.assert_allclose(shares, [0.55, 0.20, 0.25], atol=2.0 / FREE.t.size)


def test_each_recording_is_divided_by_itself():
    later = replace(FREE, name='b', t=FREE.t + 100.0, command_t=FREE.command_t + 100.0)
    first, second = parts_of([FREE, later], 0.5, 0.75)
    assert counts(first) == counts(second)
    np.testing.assert_allclose(second.division.ends, first.division.ends + 100.0)


def roles(recordings, fit=0.55, choose=0.75):
    """Return for each recording which shares of it are fitted, decide and judge."""
    parts = {part.segment.t[0]: part for part in parts_of(recordings, fit, choose)}
    found = [parts[recording.t[0]] for recording in recordings]
    return [(np.array(counts(part)) / part.segment.t.size).round(2).tolist() for part in found]


def several(*durations):
    """Return recordings of these durations in s, one after the other."""
    found, begin = [], 0.0
    for duration in durations:
        keep, sent = FREE.t <= duration, FREE.command_t <= duration
        found.append(
            replace(
                FREE,
                name=f'{len(found)}',
                t=FREE.t[keep] + begin,
                position=FREE.position[keep],
                command_t=FREE.command_t[sent] + begin,
                command=FREE.command[sent],
            )
        )
        begin += 100.0
    return found


def test_whole_recordings_decide_where_there_are_enough():
    """At most the share of the time that decides: 0.27 of what does not judge."""
    fitted, deciding = [0.75, 0.0, 0.25], [0.0, 0.75, 0.25]
    assert roles(several(20.0, 20.0, 20.0, 20.0)) == [fitted, fitted, deciding, fitted]
    assert roles(several(*[20.0] * 8)).count(deciding) == 2
    all_of_it = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    assert roles(several(*[20.0] * 4), 0.55 / 0.75, 1.0) == [all_of_it[k] for k in (0, 0, 1, 0)]


def test_where_they_are_few_each_is_divided():
    assert roles(several(20.0, 20.0, 20.0)) == [[0.55, 0.20, 0.25]] * 3


def test_a_long_recording_does_not_decide_over_short_ones():
    long, short = 20.0, 5.0
    shares = roles(several(short, short, long, short), 0.55 / 0.75, 1.0)
    assert shares == [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]


def test_recordings_at_a_prescribed_length_are_always_divided():
    held = bench_truth.held(duration=40.0)
    four = [replace(held, name=f'{k}', t=held.t + 100.0 * k) for k in range(4)]
    assert all(0.0 not in shares for shares in roles(four))


def test_gaps_divide_a_recording_but_not_its_parts():
    t = FREE.t
    keep = (t < 4.0) | (t > 5.0)
    gap = replace(
        FREE, t=t[keep], position=FREE.position[keep], gaps=((float(t[t < 4.0][-1]), 5.01),)
    )
    parts = parts_of([gap], 0.5, 0.75)
    assert len(parts) == 2
    np.testing.assert_array_equal(parts[0].division.ends, parts[1].division.ends)
    assert counts(parts[0])[1:] == [0, 0]
    # A stretch of which nothing is fitted comes last, so that fitted runs keep their numbers.
    last = parts_in_time(gap, 0.2, 0.75)[-1]
    assert counts(last)[0] == 0


@pytest.mark.parametrize(
    ('fit', 'choose', 'shares'), [(0.55, 0.75, (11, 5, 4)), (0.7, 1.0, (14, 6, 0))]
)
def test_at_a_prescribed_length_the_parts_are_blocks_in_turn(fit, choose, shares):
    """Each of them sees the pressure rise and fall, of which there is one in these recordings."""
    held = bench_truth.held(duration=40.0)
    (part,) = parts_of([held], fit, choose)
    masks = np.stack([part.fit, part.choose, part.judge])
    np.testing.assert_array_equal(masks.sum(axis=0), 1)
    blocks = masks.argmax(axis=0)[:: held.t.size // BLOCKS][:BLOCKS]
    assert tuple(np.bincount(blocks, minlength=3)) == shares
    for role in range(2):
        middle = 0.5 * part.segment.t[-1]
        seen = part.segment.t[masks[role]]
        assert np.any(seen < middle)
        assert np.any(seen > middle)


def test_a_run_ends_with_what_is_fitted_of_it():
    held = bench_truth.held(duration=20.0)
    (part,) = parts_of([held], 0.5, 0.75)
    keep = part.choose & (part.segment.t < 12.0)
    run = run_of(part.segment, keep)
    np.testing.assert_array_equal(run.t[run.fit], part.segment.t[keep])
    assert run.fit[-1]
    for name in ('t', 'target', 'pressure', 'position', 'velocity'):
        np.testing.assert_array_equal(
            getattr(run, name), getattr(part.segment, name)[: run.t.size]
        )
    (part,) = parts_of([FREE], 0.5, 0.75)
    np.testing.assert_array_equal(part.to_fit.t, part.segment.t[part.fit])
    assert part.to_fit.fit.all()
    np.testing.assert_array_equal(part.to_fit.drive, part.segment.drive)


def test_stretches_are_those_before_and_between_what_judges():
    (part,) = parts_of([bench_truth.held(duration=40.0)], 0.55, 0.75)
    stretches = part.known_stretches
    assert len(stretches) == 5
    np.testing.assert_array_equal(
        np.concatenate([s.t for s in stretches]), part.segment.t[part.known]
    )
    assert all(np.ptp(np.diff(s.t)) < 1e-9 for s in stretches)


def test_blocks_in_turn_leave_what_judges_as_it_was():
    recordings = [FREE, replace(FREE, name='b'), replace(FREE, name='c')]
    for some in (recordings[:1], recordings):
        for one, other in zip(
            parts_of(some, 0.55, 0.75), parts_in_turn(some, 0.55, 0.75), strict=True
        ):
            np.testing.assert_array_equal(one.judge, other.judge)
            assert other.division.is_in_turn
            assert np.mean(other.fit) == pytest.approx(0.55, abs=0.06)


def test_other_signals_of_the_same_recordings_have_the_same_parts():
    """What judges the motion must not be fitted elsewhere, for example in the pressures."""
    slow = np.abs(1.0 - 2.0 * FREE.t / FREE.t[-1])
    cycle = replace(FREE, command_t=FREE.t, command=2e5 + 1e5 * slow)
    parts = parts_of([FREE, cycle, replace(FREE, name='b')], 0.55, 0.75)
    measured = [
        replace(one, command_t=None, command=None, pressure=np.full(one.t.size, 2e5))
        for one in (FREE, cycle, FREE)
    ]
    assert [part.division.is_in_turn for part in parts] == [False, True, False]
    for one, other in zip(parts, like(parts, measured), strict=True):
        assert one.segment.recording == other.segment.recording
        np.testing.assert_array_equal(one.judge, other.judge)
        np.testing.assert_array_equal(one.fit, other.fit)


def test_recordings_of_two_kinds_are_refused():
    with pytest.raises(RecordingError, match='recordings of one kind are needed'):
        parts_of([FREE, bench_truth.held(duration=20.0)], 0.5, 0.75)
