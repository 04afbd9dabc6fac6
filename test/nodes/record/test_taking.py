# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whether messages of a topic may still arrive after the recorder was stopped."""

import pytest

from pam_ros.nodes.record.taking import RecordedTopic

MS = 10**6  # ns
START = 10**18  # ns
PERIOD, PATIENCE = 100 * MS, 5000 * MS


def counted(*sent):
    topic = RecordedTopic(None, 0)
    for time in sent:
        topic.count(START + time)
    return topic


@pytest.mark.parametrize(
    ('sent', 'until', 'is_expected'),
    [
        (range(0, 1000 * MS, 2 * MS), 3000 * MS, True),  # the last two seconds are missing
        (range(0, 1000 * MS, 2 * MS), 998 * MS, False),  # a later one has arrived
        (range(0, 1000 * MS, 2 * MS), 7000 * MS, False),  # it would have been sent again already
        (range(0, 10_000 * MS, 500 * MS), 9700 * MS, False),  # too slow to expect a later one
        ([0], 1000 * MS, False),
        ([], 1000 * MS, False),
    ],
)
def test_only_a_topic_that_is_published_all_the_time_may_miss_messages(sent, until, is_expected):
    assert counted(*sent).may_miss(START + until, PERIOD, PATIENCE) is is_expected
