# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_record`` on a disk that is full: a whole bag of what was written before."""

import random
import resource
import string
from contextlib import contextmanager

import pytest
from std_msgs.msg import String

from support.bags import contents
from support.harness import FreshProgram

ROOM = 4_000_000  # bytes of one file; the middleware has files of its own below that
LETTERS = 100_000  # of one message


@contextmanager
def small_disk():
    """Let programs that are started write no file beyond ROOM: they see an OSError there."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (ROOM, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.at_any_pace
def test_it_ends_with_one_sentence_and_the_bag_has_what_fitted(peer, tmp_path):
    bag = tmp_path / 'rig'
    with small_disk():
        program = FreshProgram('pam_record', '--', '-o', str(bag), 'log')
    letters = random.Random(1)
    count = 0
    with program:

        def has_ended():
            nonlocal count
            if program.is_running:
                text = ''.join(letters.choices(string.printable, k=LETTERS))
                peer.publish(String(data=f'{count} {text}'), 'log')
                count += 1
            return not program.is_running

        peer.until(has_ended, 'the end of the recorder')
        assert program.wait() == 2
        output = program.output
    assert output.count('cannot be written: File too large; the bag ends after') == 1
    assert 'Traceback' not in output
    assert (bag / 'rig_0.mcap').stat().st_size <= ROOM
    numbers = [int(message.data.split()[0]) for _, message in contents(bag)['/log']]
    assert 10 < len(numbers) < count
    assert numbers == sorted(numbers)
    assert f'{len(numbers)} messages' in output
