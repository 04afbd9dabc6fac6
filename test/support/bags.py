# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rosbag2 directories written by the ``rosbags`` library, as other recorders write them."""

from pathlib import Path

import numpy as np
import yaml
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

EPOCH = 1_750_000_000_000_000_000  # ns: the clock of the bags' recorder
STORE = get_typestore(Stores.ROS2_JAZZY)
TYPES = STORE.types
FLOAT = 'std_msgs/msg/Float64'
JOINT = 'sensor_msgs/msg/JointState'
FLUID = 'sensor_msgs/msg/FluidPressure'
ARRAY = 'std_msgs/msg/Float64MultiArray'
WRENCH = 'geometry_msgs/msg/WrenchStamped'


def ns(t: float) -> int:
    """Return the recorder's time of *t* s after the start."""
    return EPOCH + round(t * 1e9)


def header(stamp: int):
    """Return a header; 0 is a stamp that nobody has set."""
    time = TYPES['builtin_interfaces/msg/Time'](stamp // 10**9, stamp % 10**9)
    return TYPES['std_msgs/msg/Header'](time, 'rig')


def number(value: float):
    return TYPES[FLOAT](value)


def joint(stamp: int, position, velocity=(), effort=(), names=('pam',)):
    lists = (np.array(values, dtype=float) for values in (position, velocity, effort))
    return TYPES[JOINT](header(stamp), list(names), *lists)


def fluid(stamp: int, pressure: float):
    return TYPES[FLUID](header(stamp), pressure, 0.0)


def wrench(stamp: int, z: float):
    vector = TYPES['geometry_msgs/msg/Vector3']
    inner = TYPES['geometry_msgs/msg/Wrench'](vector(0.0, 0.0, z), vector(0.0, 0.0, 0.0))
    return TYPES[WRENCH](header(stamp), inner)


def write_bag(
    path: Path, topics, plugin=StoragePlugin.MCAP, compression=CompressionMode.NONE
) -> Path:
    """Write ``topic -> (type, [(receive time in ns, message), ...])``; return *path*."""
    writer = Writer(path, version=9, storage_plugin=plugin)
    writer.set_compression(compression, CompressionFormat.ZSTD)
    with writer:
        for topic, (kind, messages) in topics.items():
            connection = writer.add_connection(topic, kind, typestore=STORE)
            for stamp, message in messages:
                writer.write(connection, stamp, STORE.serialize_cdr(message, kind))
    return path


def rig_topics(prefix: str = '', duration: float = 4.0, late: float = 2e-4):
    """Return the topics of a rig that oscillates, with what a reading of them should give.

    Joint states at 200 Hz and pressures at 100 Hz with headers, received *late* s after their
    stamp; forces at 250 Hz and commands without, from 0.5 s on every 0.25 s.
    """
    t = np.arange(round(200 * duration)) / 200
    y = 0.05 + 0.02 * np.sin(2 * np.pi * t)
    v = 0.04 * np.pi * np.cos(2 * np.pi * t)
    t_force = np.arange(round(250 * duration)) / 250
    force = 196.0 + 10.0 * np.cos(2 * np.pi * t_force)
    t_pressure = np.arange(round(100 * duration)) / 100
    gauge = 2e5 + 5e4 * np.sin(2 * np.pi * t_pressure)
    t_command = np.arange(0.5, duration, 0.25)
    command = 2e5 + 5e4 * np.sin(3.0 * np.arange(t_command.size))
    topics = {
        f'{prefix}/joint_states': (
            JOINT,
            [
                (ns(s + late), joint(ns(s), [a], [b], [0.0]))
                for s, a, b in zip(t, y, v, strict=True)
            ],
        ),
        f'{prefix}/force': (
            FLOAT,
            [(ns(s), number(f)) for s, f in zip(t_force, force, strict=True)],
        ),
        f'{prefix}/pressure': (
            FLUID,
            [
                (ns(s + late), fluid(ns(s), p + 101325.0))
                for s, p in zip(t_pressure, gauge, strict=True)
            ],
        ),
        f'{prefix}/pressure_command': (
            FLOAT,
            [(ns(s), number(p)) for s, p in zip(t_command, command, strict=True)],
        ),
    }
    truth = {
        'position': (t, y),
        'velocity': (t, v),
        'force': (t_force, force),
        'pressure': (t_pressure, gauge),
        'command': (t_command, command),
    }
    return topics, truth


def contents(bag):
    """Return topic -> [(stamp in ns, message), ...] as another library reads the bag."""
    found = {}
    with AnyReader([bag]) as reader:
        for connection in reader.connections:
            found[connection.topic] = []
        for connection, stamp, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            found[connection.topic].append((stamp, message))
    return found


def written(bag):
    """Return topic -> number of messages that the bag on disk says it has; none is no bag yet."""
    file = bag / 'metadata.yaml'
    if not file.exists():
        return {}
    information = yaml.safe_load(file.read_text())['rosbag2_bagfile_information']
    return {
        topic['topic_metadata']['name']: topic['message_count']
        for topic in information['topics_with_message_count']
    }


def numbers(values, label='flexor,extensor'):
    """Return an array of numbers, such as a pressure of each muscle, labelled as pam_sim does."""
    dimension = TYPES['std_msgs/msg/MultiArrayDimension'](label, len(values), len(values))
    layout = TYPES['std_msgs/msg/MultiArrayLayout']([dimension], 0)
    return TYPES[ARRAY](layout, np.array(values, dtype=float))
