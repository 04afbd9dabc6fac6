# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which samples fits see, which choices see, and which judge."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.identification.data.parts import cut, parts_of
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


def test_nothing_judges_where_other_recordings_do():
    (part,) = parts_of([FREE], 0.7, 1.0)
    assert counts(part)[2] == 0
    assert part.choose[-1]


def test_each_recording_is_divided_by_itself():
    later = replace(FREE, name='b', t=FREE.t + 100.0, command_t=FREE.command_t + 100.0)
    first, second = parts_of([FREE, later], 0.5, 0.75)
    assert counts(first) == counts(second)
    assert second.fit_until == pytest.approx(first.fit_until + 100.0)


def test_gaps_divide_a_recording_but_not_its_parts():
    t = FREE.t
    keep = (t < 4.0) | (t > 5.0)
    gap = replace(
        FREE, t=t[keep], position=FREE.position[keep], gaps=((float(t[t < 4.0][-1]), 5.01),)
    )
    parts = parts_of([gap], 0.5, 0.75)
    assert len(parts) == 2
    assert len({part.fit_until for part in parts}) == 1
    assert counts(parts[0])[1:] == [0, 0]
    # A stretch of which nothing is fitted comes last, so that fitted runs keep their numbers.
    last = parts_of([gap], 0.2, 0.75)[-1]
    assert counts(last)[0] == 0


def test_what_is_cut_off_is_gone_from_all_that_is_sampled():
    held = bench_truth.held(duration=20.0)
    (part,) = parts_of([held], 0.5, 0.75)
    short = part.to_fit
    for name in ('t', 'target', 'fit', 'pressure', 'position', 'velocity'):
        np.testing.assert_array_equal(getattr(short, name), getattr(part.segment, name)[part.fit])
    (part,) = parts_of([FREE], 0.5, 0.75)
    short = cut(part.segment, part.choose)
    np.testing.assert_array_equal(short.t, part.segment.t[part.choose])
    np.testing.assert_array_equal(short.drive, part.segment.drive)


def test_recordings_of_two_kinds_are_refused():
    with pytest.raises(RecordingError, match='recordings of one kind are needed'):
        parts_of([FREE, bench_truth.held(duration=20.0)], 0.5, 0.75)
