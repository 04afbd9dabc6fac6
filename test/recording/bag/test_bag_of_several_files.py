# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Long recordings, which are split into files: flat, whole and in order, however they end."""

import gc
import os
import shutil
import signal
import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from rosbags.rosbag2 import Reader

from pam_ros.errors import RecordingError
from pam_ros.recording.bag import writer
from pam_ros.recording.bag.metadata import BagTopic
from pam_ros.recording.bag.source import bag_files, open_bag
from pam_ros.recording.bag.writer import CHUNKS, BagWriter
from support import bags

TEXT, _ = bags.STORE.generate_msgdef(bags.FLOAT)
TOPICS = ('/force', '/stiffness')
PER_SEAL = 3  # messages of each topic


@pytest.fixture
def short_files(monkeypatch):
    """Begin a new file after every four chunks, the seal of the empty bag among them."""
    monkeypatch.setattr(writer, 'CHUNKS', 4)


class Recorder:
    """A writer of two topics whose messages count up, from 0, one a second of their own time."""

    def __init__(self, path):
        self.writer = BagWriter(path)
        self.channels = [
            self.writer.add_topic(BagTopic(name, bags.FLOAT, TEXT)) for name in TOPICS
        ]
        self.count = 0

    def fill(self):
        for _ in range(PER_SEAL):
            data = bytes(bags.STORE.serialize_cdr(bags.number(float(self.count)), bags.FLOAT))
            for channel in self.channels:
                self.writer.write(channel, bags.ns(self.count), bags.ns(self.count), data)
            self.count += 1

    def seal(self, times=1):
        for _ in range(times):
            self.fill()
            self.writer.seal()


def ours(path):
    """Return topic -> numbers, as our reader reads them."""
    source = open_bag(path)
    found = {name: [] for name in TOPICS}
    for message in source.messages(TOPICS):
        found[message.topic].append(source.decode(source.topics[message.topic], message.data).data)
    return found


def theirs(path):
    """Return topic -> numbers, as rosbags reads them by the metadata."""
    found = {name: [] for name in TOPICS}
    with Reader(path) as reader:
        for connection, _, data in reader.messages():
            found[connection.topic].append(bags.STORE.deserialize_cdr(data, bags.FLOAT).data)
        assert reader.message_count == sum(map(len, found.values()))
    return found


def both(count):
    return {name: [float(k) for k in range(count)] for name in TOPICS}


def test_a_long_recording_is_whole_and_in_order_and_no_file_grows(tmp_path):
    recorder = Recorder(tmp_path / 'bag')
    recorder.seal(2 * CHUNKS + CHUNKS // 2)
    recorder.writer.close()
    assert ours(tmp_path / 'bag') == theirs(tmp_path / 'bag') == both(recorder.count)
    files = bag_files(tmp_path / 'bag')
    assert [file.name for file in files] == ['bag_0.mcap', 'bag_1.mcap', 'bag_2.mcap']
    content = yaml.safe_load((tmp_path / 'bag' / 'metadata.yaml').read_text())
    information = content['rosbag2_bagfile_information']
    assert information['relative_file_paths'] == [file.name for file in files]
    assert information['message_count'] == len(TOPICS) * recorder.count
    assert information['duration'] == {'nanoseconds': (recorder.count - 1) * 10**9}
    for file, listed in zip(files, information['files'], strict=True):
        with file.open('rb') as stream:
            reader = make_reader(stream, validate_crcs=True)
            summary = reader.get_summary()
            stamps = [message.log_time for _, _, message in reader.iter_messages()]
        assert len(summary.chunk_indexes) <= CHUNKS
        assert {channel.topic for channel in summary.channels.values()} == set(TOPICS)
        assert listed == {
            'path': file.name,
            'starting_time': {'nanoseconds_since_epoch': stamps[0]},
            'duration': {'nanoseconds': stamps[-1] - stamps[0]},
            'message_count': len(stamps),
        }


def test_without_metadata_the_files_are_read_in_their_order(tmp_path, short_files):
    recorder = Recorder(tmp_path / 'bag')
    recorder.seal(45)
    recorder.writer.close()
    assert (tmp_path / 'bag' / 'bag_10.mcap').exists()
    (tmp_path / 'bag' / 'metadata.yaml').unlink()
    assert ours(tmp_path / 'bag') == both(recorder.count)


def test_memory_does_not_grow_from_file_to_file(tmp_path, monkeypatch):
    """At the same place of each file; the index of one file takes some 12 times the limit.

    The median, since Python itself fills tables of its own in the first files and now and then.
    """
    monkeypatch.setattr(writer, 'CHUNKS', 32)
    recorder = Recorder(tmp_path / 'bag')
    recorder.seal(40)
    taken = []
    tracemalloc.start()
    try:
        for _ in range(10):
            recorder.seal(32)
            gc.collect()
            taken.append(tracemalloc.get_traced_memory()[0])
    finally:
        tracemalloc.stop()
    assert np.median(np.diff(taken)) < 4000
    recorder.writer.close()


def test_a_topic_that_comes_late_is_in_the_files_from_then_on(tmp_path, short_files):
    recorder = Recorder(tmp_path / 'bag')
    recorder.seal(5)
    late = recorder.writer.add_topic(BagTopic('/late', bags.FLOAT, TEXT))
    data = bytes(bags.STORE.serialize_cdr(bags.number(7.0), bags.FLOAT))
    for _ in range(6):
        recorder.writer.write(late, bags.ns(recorder.count), bags.ns(recorder.count), data)
        recorder.seal()
    recorder.writer.close()
    source = open_bag(tmp_path / 'bag')
    assert len(list(source.messages(['/late']))) == 6
    assert ours(tmp_path / 'bag') == both(recorder.count)


def test_the_end_at_a_change_of_files_leaves_no_empty_file(tmp_path, short_files):
    recorder = Recorder(tmp_path / 'bag')
    recorder.seal(7)
    recorder.writer.close()
    assert sorted(file.name for file in (tmp_path / 'bag').iterdir()) == [
        *('bag_0.mcap', 'bag_1.mcap', 'metadata.yaml')
    ]
    assert ours(tmp_path / 'bag') == theirs(tmp_path / 'bag') == both(recorder.count)


@pytest.mark.parametrize('seals', [3, 5], ids=['first of a file', 'later'])
def test_a_seal_of_the_second_file_that_a_kill_cuts_off(tmp_path, monkeypatch, short_files, seals):
    """It costs only what it would have added, at whichever byte it stops."""
    pwrite = os.pwrite
    for written in (*range(0, 1400, 97), 10_000):
        folder = tmp_path / str(written)
        recorder = Recorder(folder / 'bag')
        recorder.seal(seals)
        before = recorder.count
        recorder.fill()

        def killed(file, data, position, written=written):
            pwrite(file, data[:written], position)
            raise KeyboardInterrupt

        with monkeypatch.context() as patch:
            patch.setattr(os, 'pwrite', killed)
            with pytest.raises(KeyboardInterrupt):
                recorder.writer.seal()
        assert (folder / 'bag' / 'bag_1.mcap').exists()
        assert not (folder / 'bag' / 'bag_2.mcap').exists()
        assert ours(folder / 'bag') in (both(before), both(recorder.count))


ENDLESS = """
import struct
import sys
from pathlib import Path
from pam_ros.recording.bag import writer as bag_writer
from pam_ros.recording.bag.metadata import BagTopic
bag_writer.CHUNKS = 4
writer = bag_writer.BagWriter(Path(sys.argv[1]))
channels = [writer.add_topic(BagTopic(name, 'std_msgs/msg/Float64', 'float64 data'))
            for name in ('/force', '/stiffness')]
count = 0
while True:
    data = bytes((0, 1, 0, 0)) + struct.pack('<d', count)
    for channel in channels:
        writer.write(channel, count, count, data)
    count += 1
    writer.seal()
"""


def test_a_process_that_is_killed_leaves_all_files(tmp_path):
    bag = tmp_path / 'bag'
    process = subprocess.Popen([sys.executable, '-c', ENDLESS, str(bag)])
    try:
        while not (bag / 'bag_3.mcap').exists():
            assert process.poll() is None
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()
    files = len(bag_files(bag))
    assert files >= 3
    found = ours(bag)
    assert len(found['/force']) >= 3 + 4 * (files - 2)
    assert found == both(len(found['/force']))


@pytest.mark.parametrize(
    ('seals', 'part'), [(3, 'open'), (3, 'data'), (3, 'metadata'), (5, 'data'), (5, 'metadata')]
)
def test_a_disk_that_is_full_in_the_second_file(tmp_path, monkeypatch, short_files, seals, part):
    """The bag ends with the seal before, and goes on where there is room again."""
    bag = tmp_path / 'bag'
    recorder = Recorder(bag)
    recorder.seal(seals)
    before = recorder.count
    names = sorted(file.name for file in bag.iterdir())
    recorder.fill()
    pwrite, room = os.pwrite, sum(file.stat().st_size for file in bag.glob('bag_1.mcap')) + 200

    def nearly_full(file, data, position):
        if position >= room:
            full()
        return pwrite(file, data[: room - position], position)

    def full(*_, **__):
        raise OSError(28, 'No space left on device')

    with monkeypatch.context() as patch:
        if part == 'open':
            patch.setattr(os, 'open', full)
        elif part == 'data':
            patch.setattr(os, 'pwrite', nearly_full)
        else:
            patch.setattr(Path, 'write_text', full)
        with pytest.raises(
            RecordingError,
            match=rf'bag_1\.mcap cannot be written: No space.*; the bag ends after {before - 1}\.',
        ):
            recorder.writer.seal()
    assert sorted(file.name for file in bag.iterdir()) == names
    assert ours(bag) == theirs(bag) == both(before)
    recorder.seal()
    recorder.writer.close()
    assert ours(bag) == theirs(bag) == both(recorder.count)


def test_a_directory_that_is_deleted_is_named(tmp_path, short_files):
    for seals in (1, 3):
        recorder = Recorder(tmp_path / 'bag')
        recorder.seal(seals)
        shutil.rmtree(tmp_path / 'bag')
        recorder.fill()
        with pytest.raises(RecordingError, match=r'/bag was deleted or renamed while it was rec'):
            recorder.writer.close()
        assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_deleted_is_named(tmp_path):
    recorder = Recorder(tmp_path / 'bag')
    recorder.seal()
    (tmp_path / 'bag' / 'bag_0.mcap').unlink()
    recorder.fill()
    with pytest.raises(RecordingError, match=r'/bag_0\.mcap was deleted or renamed while it was'):
        recorder.writer.close()


def test_a_directory_that_is_renamed_stays_whole(tmp_path):
    recorder = Recorder(tmp_path / 'bag')
    recorder.seal()
    (tmp_path / 'bag').rename(tmp_path / 'other')
    recorder.fill()
    with pytest.raises(RecordingError, match=r'/bag was deleted or renamed'):
        recorder.writer.close()
    assert ours(tmp_path / 'other') == theirs(tmp_path / 'other') == both(PER_SEAL)
