# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The text of metadata.yaml, read by a YAML parser."""

import yaml

from pam_ros.recording.bag.metadata import BagTopic, ListedFile, metadata_text, whole

TOPICS = [BagTopic('/a', 'std_msgs/msg/Float64', ''), BagTopic('/b', 'std_msgs/msg/String', '')]


def parsed(*arguments):
    return yaml.safe_load(metadata_text(*arguments))['rosbag2_bagfile_information']


def test_several_files_in_one_bag():
    files = [ListedFile.of('bag_0.mcap', 3, (5, 9)), ListedFile.of('bag_1.mcap', 4, (8, 20))]
    found = parsed(TOPICS, {'/a': 6, '/b': 1}, (5, 20), files, 'jazzy')
    assert found['message_count'] == 7
    assert found['starting_time'] == {'nanoseconds_since_epoch': 5}
    assert found['duration'] == {'nanoseconds': 15}
    assert [one['message_count'] for one in found['topics_with_message_count']] == [6, 1]
    assert found['relative_file_paths'] == ['bag_0.mcap', 'bag_1.mcap']
    assert found['files'] == [
        {
            'path': f'bag_{n}.mcap',
            'starting_time': {'nanoseconds_since_epoch': start},
            'duration': {'nanoseconds': duration},
            'message_count': count,
        }
        for n, start, duration, count in ((0, 5, 4, 3), (1, 8, 12, 4))
    ]


def test_names_that_yaml_would_read_as_something_else():
    for name in ('3', '- x: y_0.mcap', "it's #1_0.mcap", 'Messung ä_0.mcap', 'null'):
        found = parsed([], {}, None, [ListedFile.of(name, 0, None)], '')
        assert found['relative_file_paths'] == [name]
        assert found['files'][0]['path'] == name


def test_a_bag_without_messages_has_the_start_time_of_rosbag2():
    found = parsed(TOPICS, {'/a': 0, '/b': 0}, None, [ListedFile.of('x', 0, None)], '')
    assert found['starting_time'] == {'nanoseconds_since_epoch': 2**63 - 1}
    assert found['duration'] == {'nanoseconds': 0}


def test_the_time_of_all():
    assert whole([]) is None
    assert whole([(3, 9), (1, 4)]) == (1, 9)
