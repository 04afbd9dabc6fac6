# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bags that we write, read by another library: whole at every moment."""

import os
import shutil
from pathlib import Path

import pytest
import yaml
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)

from pam_ros.errors import RecordingError
from pam_ros.recording.bag.metadata import BagTopic
from pam_ros.recording.bag.source import open_bag
from pam_ros.recording.bag.writer import BagWriter
from support import bags

FOREVER = {'sec': 9223372036, 'nsec': 854775807}
OFFERED = {
    'history': 'keep_last',
    'depth': 10,
    'reliability': 'reliable',
    'durability': 'volatile',
    'deadline': FOREVER,
    'lifespan': FOREVER,
    'liveliness': 'automatic',
    'liveliness_lease_duration': FOREVER,
    'avoid_ros_namespace_conventions': False,
}
# The fields of rosbag2's metadata, version 9, as rosbag2_storage/yaml.hpp lists them.
FIELDS = {
    *('version', 'storage_identifier', 'duration', 'starting_time', 'message_count'),
    *('topics_with_message_count', 'compression_format', 'compression_mode'),
    *('relative_file_paths', 'files', 'custom_data', 'ros_distro'),
}


def topic(name, kind):
    text, _ = bags.STORE.generate_msgdef(kind)
    return BagTopic(name, kind, text, type_hash=bags.STORE.hash_rihs01(kind), qos=[OFFERED])


def put(writer, channel, k, kind=bags.FLOAT):
    message = bags.number(float(k)) if kind == bags.FLOAT else bags.joint(bags.ns(k), [k])
    data = bytes(bags.STORE.serialize_cdr(message, kind))
    writer.write(channel, bags.ns(k), bags.ns(k) - 1000, data)


def numbers(path):
    """Return topic -> numbers, as the other library reads them."""
    found = {}
    with AnyReader([path]) as reader:
        for connection in reader.connections:
            found[connection.topic] = []
        for connection, _, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            value = message.data if connection.msgtype == bags.FLOAT else message.position[0]
            found[connection.topic].append(value)
        assert reader.message_count == sum(map(len, found.values()))
    return found


def test_each_seal_leaves_a_whole_bag(tmp_path):
    writer = BagWriter(tmp_path / 'bag')
    states = []

    def look():
        copy = tmp_path / f'copy{len(states)}'
        shutil.copytree(tmp_path / 'bag', copy)
        states.append(numbers(copy))
        assert numbers(copy / 'bag_0.mcap') == states[-1]

    look()
    force = writer.add_topic(topic('/force', bags.FLOAT))
    writer.seal()
    look()
    for k in range(3):
        put(writer, force, k)
    writer.seal()
    look()
    joint = writer.add_topic(topic('/joint_states', bags.JOINT))
    for k in range(3, 5000):
        put(writer, force, k)
    put(writer, joint, 5, bags.JOINT)
    writer.seal()
    look()
    put(writer, joint, 6, bags.JOINT)
    look()
    writer.close()
    look()
    assert states == [
        {},
        {'/force': []},
        {'/force': [0.0, 1.0, 2.0]},
        {'/force': list(range(5000)), '/joint_states': [5.0]},
        {'/force': list(range(5000)), '/joint_states': [5.0]},
        {'/force': list(range(5000)), '/joint_states': [5.0, 6.0]},
    ]


def test_a_seal_that_a_kill_cuts_off_costs_only_what_it_would_have_added(tmp_path, monkeypatch):
    """The writing of a seal may stop at any byte of it."""
    pwrite = os.pwrite
    for written in (*range(0, 1200, 37), 2000, 10_000):
        folder = tmp_path / str(written)
        writer = BagWriter(folder / 'bag')
        force = writer.add_topic(topic('/force', bags.FLOAT))
        for k in range(100):
            put(writer, force, k)
        writer.seal()
        for k in range(100, 200):
            put(writer, force, k)

        def killed(file, data, position, written=written):
            pwrite(file, data[:written], position)
            raise KeyboardInterrupt

        with monkeypatch.context() as patch:
            patch.setattr(os, 'pwrite', killed)
            with pytest.raises(KeyboardInterrupt):
                writer.close()
        source = open_bag(folder / 'bag')
        got = [
            source.decode(source.topics[m.topic], m.data).data for m in source.messages(['/force'])
        ]
        assert got in (list(range(100)), list(range(200)))
        assert got == list(range(200)) or written < 2000


def test_the_metadata_is_rosbag2s(tmp_path):
    writer = BagWriter(tmp_path / 'bag', 'jazzy')
    force = writer.add_topic(topic('/force', bags.FLOAT))
    for k in range(2, 5):
        put(writer, force, k)
    assert writer.duration == pytest.approx(2.0)
    writer.close()
    content = yaml.safe_load((tmp_path / 'bag' / 'metadata.yaml').read_text())
    assert list(content) == ['rosbag2_bagfile_information']
    information = content['rosbag2_bagfile_information']
    assert set(information) == FIELDS
    assert information['version'] == 9
    assert information['storage_identifier'] == 'mcap'
    assert information['ros_distro'] == 'jazzy'
    start = {'nanoseconds_since_epoch': bags.ns(2)}
    assert information['starting_time'] == start
    assert information['duration'] == {'nanoseconds': 2 * 10**9}
    assert information['message_count'] == 3
    assert information['relative_file_paths'] == ['bag_0.mcap']
    assert information['files'] == [
        {
            'path': 'bag_0.mcap',
            'starting_time': start,
            'duration': {'nanoseconds': 2 * 10**9},
            'message_count': 3,
        }
    ]
    (listed,) = information['topics_with_message_count']
    assert listed['message_count'] == 3
    assert listed['topic_metadata'] == {
        'name': '/force',
        'type': bags.FLOAT,
        'serialization_format': 'cdr',
        'offered_qos_profiles': [OFFERED],
        'type_description_hash': bags.STORE.hash_rihs01(bags.FLOAT),
    }
    text = (tmp_path / 'bag' / 'metadata.yaml').read_text()
    assert '&id' not in text  # yaml-cpp reads anchors, people do not


def test_quality_of_service_is_read_back(tmp_path):
    writer = BagWriter(tmp_path / 'bag')
    writer.add_topic(topic('/force', bags.FLOAT))
    writer.close()
    time = QosTime(**FOREVER)
    expected = Qos(
        QosHistory.KEEP_LAST,
        10,
        QosReliability.RELIABLE,
        QosDurability.VOLATILE,
        time,
        time,
        QosLiveliness.AUTOMATIC,
        time,
        False,
    )
    for path in (tmp_path / 'bag', tmp_path / 'bag' / 'bag_0.mcap'):
        with AnyReader([path]) as reader:
            assert reader.connections[0].ext.offered_qos_profiles == [expected]


def test_the_file_is_an_mcap_of_the_ros2_profile(tmp_path):
    writer = BagWriter(tmp_path / 'bag')
    force = writer.add_topic(topic('/force', bags.FLOAT))
    for k in range(50):
        put(writer, force, k)
        if k % 10 == 0:
            writer.seal()
    writer.close()
    with (tmp_path / 'bag' / 'bag_0.mcap').open('rb') as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert reader.get_header().profile == 'ros2'
        summary = reader.get_summary()
        messages = list(reader.iter_messages())
    assert summary.statistics.message_count == 50
    assert summary.statistics.channel_message_counts == {force: 50}
    assert [message.log_time for _, _, message in messages] == [bags.ns(k) for k in range(50)]
    assert all(m.publish_time == m.log_time - 1000 for _, _, m in messages)
    schema, channel, _ = messages[0]
    assert (schema.name, schema.encoding) == (bags.FLOAT, 'ros2msg')
    assert channel.message_encoding == 'cdr'
    assert channel.metadata['topic_type_hash'] == bags.STORE.hash_rihs01(bags.FLOAT)


def test_a_directory_that_exists_is_left_alone(tmp_path):
    (tmp_path / 'bag').mkdir()
    (tmp_path / 'bag' / 'precious').touch()
    with pytest.raises(RecordingError, match='bag exists already'):
        BagWriter(tmp_path / 'bag')
    assert [file.name for file in (tmp_path / 'bag').iterdir()] == ['precious']


def test_a_directory_that_cannot_be_made(tmp_path):
    (tmp_path / 'file').touch()
    with pytest.raises(RecordingError, match='cannot be made'):
        BagWriter(tmp_path / 'file' / 'bag')


def test_a_full_disk_is_reported(tmp_path, monkeypatch):
    writer = BagWriter(tmp_path / 'bag')
    force = writer.add_topic(topic('/force', bags.FLOAT))
    put(writer, force, 1)

    def full(*_):
        raise OSError(28, 'No space left on device')

    with monkeypatch.context() as patch:
        patch.setattr(os, 'pwrite', full)
        with pytest.raises(RecordingError, match=r'bag_0\.mcap cannot be written: No space left'):
            writer.seal()
    writer.close()
    assert numbers(tmp_path / 'bag') == {'/force': [1.0]}


@pytest.mark.parametrize('part', ['data', 'metadata'])
def test_a_full_disk_leaves_the_bag_as_it_was_before(tmp_path, monkeypatch, part):
    writer = BagWriter(tmp_path / 'bag')
    force = writer.add_topic(topic('/force', bags.FLOAT))
    for k in range(100):
        put(writer, force, k)
    writer.seal()
    room = (tmp_path / 'bag' / 'bag_0.mcap').stat().st_size + 500
    for k in range(100, 3000):
        put(writer, force, k)
    pwrite = os.pwrite

    def nearly_full(file, data, position):
        if position >= room:
            raise OSError(28, 'No space left on device')
        return pwrite(file, data[: room - position], position)

    def full(path, *_, **__):
        path.touch()
        raise OSError(28, 'No space left on device')

    with monkeypatch.context() as patch:
        if part == 'data':
            patch.setattr(os, 'pwrite', nearly_full)
        else:
            patch.setattr(Path, 'write_text', full)
        with pytest.raises(
            RecordingError, match=r'No space left on device; the bag ends after 99'
        ):
            writer.seal()
        assert numbers(tmp_path / 'bag') == {'/force': list(range(100))}
        with pytest.raises(RecordingError, match='No space left on device'):
            writer.close()
    assert numbers(tmp_path / 'bag') == {'/force': list(range(100))}
    assert writer.counts == {'/force': 100}
    assert writer.duration == pytest.approx(99.0)
    assert sorted(p.name for p in (tmp_path / 'bag').iterdir()) == ['bag_0.mcap', 'metadata.yaml']


def test_a_bag_that_the_disk_has_no_room_for_is_not_begun(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(os, 'pwrite', full)
    with pytest.raises(RecordingError, match=r'bag_0\.mcap cannot be written: No space left'):
        BagWriter(tmp_path / 'bag')
    assert list(tmp_path.iterdir()) == []
