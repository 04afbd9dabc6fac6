# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The middle of a rest is left out, and nothing else."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.parts import parts_of
from pam_ros.identification.data.rests import KEPT, without_rests
from pam_ros.recording.recording import Recording
from support import bench_truth

NOISE = 20e-6
# s: the command jumps at 5 and at 45; the output follows within 3, and noise is on it.
T = np.arange(0.0, 60.0, 0.01)
COMMANDS = np.array([0.0, 5.0, 45.0]), np.array([2e5, 3e5, 2e5])


def part(position, stamps=COMMANDS[0], command=COMMANDS[1], t=T):
    noise = np.random.default_rng(1).normal(0.0, NOISE, t.size)
    recording = Recording('r', t, stamps, command, position + noise)
    (found,) = parts_of([recording], 0.55, 0.75)
    return found


def ending(whole, ends):
    """Return the part *whole* with its blocks ending at other times."""
    return replace(whole, division=whole.division._replace(ends=ends))


def following():
    """Return a position that has settled 3 s after each command, to a thousandth of the noise."""
    found = np.zeros_like(T)
    for begin, size in ((5.0, 0.02), (45.0, -0.02)):
        found += np.where(begin <= T, size * -np.expm1(-(np.maximum(T - begin, 0.0)) / 0.2), 0.0)
    return found


def test_what_is_left_is_every_motion_with_some_rest_on_both_sides():
    whole = part(following())
    brief = without_rests(whole, NOISE)
    s = brief.segment
    # 5 s before the first command, and after each 2 to 5 s until it has settled, and both ends.
    assert s.t[-1] == pytest.approx(5.0 + 2 * (2 * KEPT + 2.0), abs=3.0)
    np.testing.assert_allclose(np.diff(s.t), 0.01, atol=1e-6)
    jumps = s.drive_t[1:][np.abs(np.diff(s.drive[:, 0])) > 0.0]
    assert jumps.size == 2
    around = np.arange(-int(KEPT / 0.01) + 1, int(KEPT / 0.01))
    for before, jump in zip((5.0, 45.0), jumps, strict=True):
        there, here = (int(np.argmin(abs(t - at))) for t, at in ((T, before), (s.t, jump)))
        np.testing.assert_array_equal(
            s.target[here + around], whole.segment.target[there + around]
        )


@pytest.mark.parametrize('ends', np.random.default_rng(0).uniform(10.0, 58.0, (20, 2)))
def test_parts_keep_their_samples(ends):
    """Wherever they end: nothing that judges may become part of a fit."""
    whole = ending(part(following()), np.sort(ends))
    brief = without_rests(whole, NOISE)
    of = {value: k for k, value in enumerate(whole.segment.target)}
    rows = [of[value] for value in brief.segment.target]
    for name in ('fit', 'choose', 'judge'):
        np.testing.assert_array_equal(getattr(brief, name), getattr(whole, name)[rows])


def test_what_creeps_is_no_rest():
    creeping = following() + 0.5 * NOISE * T
    brief = without_rests(part(creeping), NOISE)
    assert brief.segment.t[-1] > 55.0


def test_an_oscillation_that_goes_on_for_seconds_is_no_rest():
    slow = following() + 20.0 * NOISE * np.sin(2.0 * np.pi * 0.2 * T)
    assert without_rests(part(slow), NOISE).segment.t.size > 0.9 * T.size


def test_commands_that_move_leave_no_rest():
    stamps = np.arange(0.0, 60.0, 0.05)
    whole = part(following(), stamps, 2e5 + 1e3 * np.sin(stamps))
    assert without_rests(whole, NOISE) is whole


def test_repeated_commands_are_no_change():
    stamps = np.arange(0.0, 60.0, 0.01)
    command = COMMANDS[1][np.searchsorted(COMMANDS[0], stamps, side='right') - 1]
    brief, once = (
        without_rests(one, NOISE).segment
        for one in (part(following(), stamps, command), part(following()))
    )
    np.testing.assert_array_equal(brief.target, once.target)
    assert np.all(np.diff(brief.drive_t) > 0.0)


def test_a_run_at_prescribed_lengths_stays_whole():
    (held, *_) = parts_of([bench_truth.held(duration=40.0)], 0.55, 0.75)
    assert without_rests(held, 1.0) is held


def test_the_end_of_a_part_within_a_rest_stays_within_it():
    whole = ending(part(following()), np.array([30.0, np.inf]))
    brief = without_rests(whole, NOISE)
    assert 5.0 < brief.division.ends[0] < 15.0
    assert brief.division.ends[1] == np.inf
