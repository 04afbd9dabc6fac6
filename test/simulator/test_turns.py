# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When a simulator in lockstep continues, repeats its state, and reports a long wait."""

import pytest

from pam_ros.simulator.turns import PATIENCE, REPEAT, SETTLE, Turns
from pam_ros.timing.pace import SECOND
from support.steady import Steady

HERE, THERE = frozenset([b'here']), frozenset([b'there'])


class Watched:
    """Turns of two muscles on a clock and with publishers that the test sets."""

    def __init__(self):
        self.wall = Steady()
        self.publishers = frozenset()
        self.turns = Turns(2, lambda: self.publishers, self.wall)


@pytest.fixture
def watched():
    return Watched()


def test_a_long_wait_is_reported_until_all_muscles_are_commanded(watched):
    turns = watched.turns
    assert turns.complaint == ''
    watched.wall.now += PATIENCE + SECOND // 2
    assert turns.complaint == 'waits for a controller, 1.5 s so far: no node publishes commands'
    watched.publishers = HERE
    turns.must_repeat()
    turns.take([0])
    assert turns.complaint == 'waits for commands, 1.5 s so far: 1 of 2 missing'
    turns.take([1])
    assert turns.complaint == ''
    turns.begin()
    assert turns.complaint == ''
    watched.wall.now += PATIENCE
    assert turns.complaint


def test_it_continues_when_all_muscles_were_commanded_since_the_state(watched):
    turns = watched.turns
    turns.take([0, 1])
    watched.wall.now += SETTLE
    assert turns.is_complete
    turns.begin()
    assert not turns.is_complete
    turns.take([1])
    turns.take([1])
    assert not turns.is_complete
    turns.take([0])
    assert turns.is_complete  # at once: this controller has answered before


def test_all_commands_of_a_new_controller_are_collected_first(watched):
    turns = watched.turns
    turns.take([0, 1])
    assert not turns.is_complete
    watched.wall.now += SETTLE - 1
    assert not turns.is_complete
    watched.wall.now += 1
    assert turns.is_complete


def test_the_state_is_repeated_for_a_controller_that_may_have_missed_it(watched):
    turns, wall = watched.turns, watched.wall
    assert not turns.must_repeat()
    wall.now += REPEAT + 1
    assert turns.must_repeat()  # for one that is not known yet
    assert not turns.must_repeat()
    watched.publishers = HERE
    assert turns.must_repeat()  # at once, since it is new
    turns.take([0, 1])
    turns.begin()
    wall.now += 10 * SECOND
    assert not turns.must_repeat()  # it has answered: it computes
    watched.publishers = THERE
    assert turns.must_repeat()  # another one took its place
    watched.publishers = frozenset()
    wall.now += REPEAT + 1
    assert turns.must_repeat()
