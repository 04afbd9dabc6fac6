# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One file of a bag: written again and again, undone, deleted."""

import random

import pytest
from mcap.reader import make_reader

from pam_ros.recording.bag.mcap_file import McapFile
from pam_ros.recording.bag.metadata import BagTopic

TOPIC = BagTopic('/log', 'std_msgs/msg/String', 'string data')


@pytest.fixture
def file(tmp_path):
    made = McapFile(tmp_path / 'bag_0.mcap')
    assert made.add_topic(TOPIC) == 1
    yield made
    made.close()


def summary(path):
    with path.open('rb') as stream:
        return make_reader(stream, validate_crcs=True).get_summary()


def fill(file, count, size):
    source = random.Random(1)
    for k in range(count):
        file.write(1, 1000 + k, 1000 + k, source.randbytes(size))


def test_it_exists_from_the_first_put_on(file):
    fill(file, 3, 10)
    assert not file.path.exists()
    file.put()
    file.keep()
    assert summary(file.path).statistics.message_count == 3
    assert (file.count, file.span) == (3, (1000, 1002))


@pytest.mark.parametrize(('count', 'size'), [(0, 0), (1, 10), (900, 1000), (9, 500_000)])
def test_it_has_no_more_chunks_than_its_summary_lists(file, count, size):
    """Large messages begin new chunks between two puts as well."""
    for _ in range(5):
        fill(file, count, size)
        file.put()
        file.keep()
    chunks = len(summary(file.path).chunk_indexes)
    assert chunks <= file.most_chunks <= 5 * (1 + count * size // 1_000_000)
    assert chunks >= 5 or not count


def test_the_first_put_undone_leaves_no_file(file):
    fill(file, 3, 10)
    file.put()
    file.undo()
    assert not file.path.exists()
    file.put()
    file.keep()
    assert summary(file.path).statistics.message_count == 3


def test_a_later_put_undone_leaves_what_was_there(file):
    fill(file, 3, 10)
    file.put()
    file.keep()
    before = file.path.read_bytes()
    fill(file, 3, 10)
    file.put()
    assert file.path.read_bytes() != before
    file.undo()
    assert file.path.read_bytes() == before
    file.put()
    file.keep()
    assert summary(file.path).statistics.message_count == 6


def test_a_file_that_was_deleted_is_not_written_any_more(file):
    file.put()
    file.keep()
    file.path.unlink()
    fill(file, 1, 10)
    with pytest.raises(FileNotFoundError):
        file.put()
