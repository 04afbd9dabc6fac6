# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a received state leads to, for each kind of pacing."""

import pytest

from pam_ros.timing.pacing import REPEAT, Pacing, Reply
from support.steady import Steady


class OwnRate(Pacing):
    answers_states = False


class Answers(Pacing):
    answers_states = True


@pytest.mark.parametrize(
    ('kind', 'new', 'repeated'),
    [
        (OwnRate, Reply.NONE, Reply.NONE),
        (Answers, Reply.COMMAND, Reply.LAST_COMMAND),
    ],
)
def test_only_a_program_without_a_rate_of_its_own_answers_states(kind, new, repeated):
    pacing = kind(Steady())
    assert pacing.keeps_wall_time is (kind is OwnRate)
    assert pacing.reply_to_state(is_repeated=False) is new
    assert pacing.reply_to_state(is_repeated=True) is repeated


def test_the_last_command_is_sent_again_only_some_time_after_it():
    steady = Steady()
    pacing = Answers(steady)
    pacing.note_command()
    steady.now += REPEAT
    assert pacing.since_command == REPEAT
    assert pacing.reply_to_state(is_repeated=True) is Reply.NONE
    steady.now += 1
    assert pacing.reply_to_state(is_repeated=True) is Reply.LAST_COMMAND
