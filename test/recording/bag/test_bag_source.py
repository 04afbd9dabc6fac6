# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of every kind, and however their recorder ended."""

import importlib.util
import shutil

import pytest
from rosbags.rosbag2 import CompressionMode, StoragePlugin

from pam_ros.errors import RecordingError
from pam_ros.recording.bag.decode import RosbagsDecoder, Topic
from pam_ros.recording.bag.source import bag_files, open_bag
from support import bags

PLUGINS = list(StoragePlugin)


@pytest.fixture
def bag(tmp_path):
    topics, _ = bags.rig_topics()
    return bags.write_bag(tmp_path / 'bag', topics)


def contents(source):
    """Return everything in a bag: topic, stamp and number of each message."""
    return [
        (m.topic, m.stamp, _number(source.decode(source.topics[m.topic], m.data)))
        for m in source.messages(list(source.topics))
    ]


def changed(old, new):
    """Return a function that changes the metadata of a bag."""

    def change(bag):
        file = bag / 'metadata.yaml'
        assert old in file.read_text()
        file.write_text(file.read_text().replace(old, new))

    return change


def _number(message):
    for name in ('data', 'fluid_pressure'):
        if hasattr(message, name):
            return getattr(message, name)
    return message.position[0]


def test_topics_types_and_messages(bag):
    source = open_bag(bag)
    assert source.notes == []
    assert source.topics['/joint_states'].type == bags.JOINT
    found = contents(source)
    assert len(found) == 800 + 1000 + 400 + 14
    assert [m.topic for m in source.messages(['/force'])] == ['/force'] * 1000
    assert list(source.messages([])) == []


@pytest.mark.parametrize('plugin', PLUGINS)
def test_a_bag_without_metadata(tmp_path, plugin):
    topics, _ = bags.rig_topics()
    bag = bags.write_bag(tmp_path / 'bag', topics, plugin)
    whole = contents(open_bag(bag))
    (bag / 'metadata.yaml').unlink()
    assert contents(open_bag(bag)) == whole


@pytest.mark.parametrize('plugin', PLUGINS)
@pytest.mark.parametrize('mode', [CompressionMode.FILE, CompressionMode.MESSAGE])
def test_a_compressed_bag(tmp_path, bag, plugin, mode):
    topics, _ = bags.rig_topics()
    compressed = bags.write_bag(tmp_path / 'compressed', topics, plugin, mode)
    assert contents(open_bag(compressed)) == contents(open_bag(bag))


def test_a_bag_in_several_files(tmp_path):
    topics, _ = bags.rig_topics()
    whole = bags.write_bag(tmp_path / 'whole', topics)
    split = tmp_path / 'split'
    split.mkdir()
    for k in range(11):
        part = {name: (kind, m[k::11]) for name, (kind, m) in topics.items()}
        written = bags.write_bag(tmp_path / f'part{k}', part)
        shutil.move(written / f'part{k}.mcap', split / f'split_{k}.mcap')
    assert [f.name for f in bag_files(split)] == [f'split_{k}.mcap' for k in range(11)]
    assert sorted(contents(open_bag(split))) == sorted(contents(open_bag(whole)))


@pytest.mark.parametrize('cut', [1, 30, 60, 400, 5000, 60_000])
def test_a_file_that_ends_anywhere_is_read_up_to_there(tmp_path, cut):
    """As a recorder leaves it that was killed: first without an end, then within the data."""
    topics, _ = bags.rig_topics()
    unchunked = tmp_path / 'killed.mcap'
    expected = write_unchunked(unchunked, topics)
    with unchunked.open('r+b') as file:
        size = file.seek(0, 2)
        file.truncate(size - cut)
    source = open_bag(unchunked)
    found = contents(source)
    assert source.notes == ['the bag was not closed by its recorder: read up to where it ends']
    assert found == expected[: len(found)]
    # A message takes some hundred bytes at most, the summary and the end some thousand.
    assert len(expected) - len(found) <= max(0, cut // 40)
    assert len(found) >= 0.3 * len(expected)


def write_unchunked(path, topics):
    """Write an MCAP without chunks, as rosbag2's fastwrite profile does; return its contents."""
    from mcap.writer import Writer

    expected = []
    with path.open('wb') as file:
        writer = Writer(file, use_chunking=False)
        writer.start(profile='ros2')
        for topic, (kind, messages) in topics.items():
            text, _ = bags.STORE.generate_msgdef(kind)
            schema = writer.register_schema(kind, 'ros2msg', text.encode())
            channel = writer.register_channel(topic, 'cdr', schema)
            for stamp, message in messages:
                data = bytes(bags.STORE.serialize_cdr(message, kind))
                writer.add_message(channel, stamp, data, stamp)
                expected.append((topic, stamp, _number(message)))
        writer.finish()
    return expected


def test_a_type_that_the_bag_defines_itself(tmp_path):
    """Read as ROS readers do where neither the library nor the machine knows the type."""
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import get_types_from_msg

    bags.STORE.register(get_types_from_msg('float64 level\nint32 code\n', 'lab_msgs/msg/Valve'))
    valve = bags.STORE.types['lab_msgs/msg/Valve']
    with Writer(tmp_path / 'bag', version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection('/valve', 'lab_msgs/msg/Valve', typestore=bags.STORE)
        data = bags.STORE.serialize_cdr(valve(0.25, 7), 'lab_msgs/msg/Valve')
        writer.write(connection, bags.EPOCH, data)
    source = open_bag(tmp_path / 'bag')
    (message,) = source.messages(['/valve'])
    decoded = source.decode(source.topics['/valve'], message.data)
    assert (decoded.level, decoded.code) == (0.25, 7)


def test_a_type_without_a_definition_is_reported():
    """As in a .db3 file of ROS 2 Humble."""
    with pytest.raises(RecordingError, match=r'lab_msgs/msg/Valve.* ros2 bag convert'):
        RosbagsDecoder()(Topic('lab_msgs/msg/Valve'), b'')


@pytest.mark.parametrize(
    ('spoil', 'words'),
    [
        (lambda bag: [f.unlink() for f in bag.iterdir()], ['not a rosbag2', '.mcap', '.db3']),
        (lambda bag: (bag / 'bag.mcap').unlink(), ['lists bag.mcap', 'not there']),
        (lambda bag: (bag / 'metadata.yaml').write_text('{'), ['metadata.yaml', 'not valid YAML']),
        (lambda bag: (bag / 'metadata.yaml').write_text('a: 1'), ['not the metadata']),
        (changed('- bag.mcap', '- 3'), ['relative_file_paths = [3] is not a list of file names']),
        (changed('relative_file_paths:\n  - bag.mcap', 'relative_file_paths: 3'), ['paths = 3']),
        (changed('name: /force', 'name: 3'), ['topic 3 of type', 'not both texts']),
        (changed('type: std_msgs/msg/Float64', 'type: []'), ["topic '/force' of type []"]),
        (changed('version: 9', 'version: 99'), ['cannot be read', '99']),
    ],
)
def test_what_is_no_bag(bag, spoil, words):
    spoil(bag)
    with pytest.raises(RecordingError) as caught:
        open_bag(bag)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize('name', ['rubbish.mcap', 'rubbish.db3'])
def test_a_file_that_only_has_the_name(tmp_path, name):
    (tmp_path / name).write_bytes(b'nothing of the kind' * 100)
    with pytest.raises(RecordingError, match=name):
        open_bag(tmp_path / name)


def test_a_length_beyond_the_end_of_an_unfinished_file_is_not_read(tmp_path):
    """Reading it would take all memory."""
    magic = b'\x89MCAP0\r\n'
    (tmp_path / 'cut.mcap').write_bytes(magic + b'\1' + b'\xff' * 7 + b'\0' * 9)
    with pytest.raises(RecordingError, match='ends before its first complete chunk'):
        open_bag(tmp_path / 'cut.mcap')


def test_a_file_that_ends_within_its_first_chunk_is_said_to_be_empty(bag):
    file = bag / 'bag.mcap'
    file.write_bytes(file.read_bytes()[:2000])
    with pytest.raises(RecordingError, match=r'not closed .*, and ends before its first complete'):
        open_bag(file)


def test_topics_of_programs_without_ros_are_left_out(tmp_path):
    from mcap.writer import Writer

    topics, _ = bags.rig_topics()
    expected = write_unchunked(tmp_path / 'ros.mcap', topics)
    with (tmp_path / 'mixed.mcap').open('wb') as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema('example.Pose', 'protobuf', b'descriptor')
        other = writer.register_channel('/pose', 'protobuf', schema)
        schema = writer.register_schema(bags.FLOAT, 'ros2msg', b'float64 data')
        channel = writer.register_channel('/force', 'cdr', schema)
        expected = [one for one in expected if one[0] == '/force']
        for _, stamp, value in expected:
            writer.add_message(other, stamp, b'anything', stamp)
            data = bags.STORE.serialize_cdr(bags.number(value), bags.FLOAT)
            writer.add_message(channel, stamp, bytes(data), stamp)
        writer.finish()
    source = open_bag(tmp_path / 'mixed.mcap')
    assert source.notes == ['topics that are not of ROS 2 are not read: /pose']
    assert contents(source) == expected


def test_without_the_library_it_is_named(bag, monkeypatch):
    monkeypatch.setattr(importlib.util, 'find_spec', lambda name: None)
    with pytest.raises(RecordingError, match='install the Python package rosbags'):
        open_bag(bag)
