# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Decode the messages of a rosbag2, with ROS or with the ``rosbags`` library."""

import importlib
from typing import Any, NamedTuple

from pam_ros.errors import RecordingError


class Topic(NamedTuple):
    """A topic's type and, as the bag tells it, the text that defines the type (or '')."""

    type: str
    definition: str = ''


class RosbagsDecoder:
    """Decode messages with ``rosbags``, by the definitions in the bag where it has them."""

    def __init__(self) -> None:
        from rosbags.typesys import Stores, get_typestore

        self._known = get_typestore(Stores.ROS2_JAZZY)
        self._stores: dict[Topic, Any] = {}

    def __call__(self, topic: Topic, data: bytes) -> Any:
        """Return the message of *topic* that *data* holds."""
        from rosbags.serde import SerdeError
        from rosbags.typesys import TypesysError

        try:
            if topic not in self._stores:
                self._stores[topic] = self._store(topic)
            return self._stores[topic].deserialize_cdr(data, topic.type)
        except SerdeError as error:
            raise RecordingError(f'not a {topic.type}: {error}') from error
        except (TypesysError, LookupError) as error:
            raise RecordingError(
                f'the bag does not define {topic.type} as it should: {error}'
            ) from error

    def _store(self, topic: Topic) -> Any:
        from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

        if not topic.definition:
            if topic.type not in self._known.fielddefs:
                raise RecordingError(
                    f'the bag does not define {topic.type}, and it is none of the standard types'
                )
            return self._known
        store = get_typestore(Stores.EMPTY)
        parts = topic.definition.split('=' * 80 + '\n')
        if parts[0] == '' and parts[-1].startswith('IDL: '):
            for part in parts[1:]:
                store.register(get_types_from_idl(part.split('\n', 1)[1]))
        else:
            store.register(get_types_from_msg(topic.definition, topic.type))
        return store


def decode_with_ros(topic: Topic, data: bytes) -> Any:
    """Return the message of *topic* that *data* holds, decoded by ROS."""
    package, *_, name = topic.type.split('/')
    try:
        message_type = getattr(importlib.import_module(f'{package}.msg'), name)
    except (ImportError, AttributeError) as error:
        raise RecordingError(
            f'message type {topic.type} is not installed here: source the workspace that has it'
        ) from error
    serialization = importlib.import_module('rclpy.serialization')
    try:
        return serialization.deserialize_message(data, message_type)
    except RuntimeError as error:
        raise RecordingError(f'not a {topic.type}: {error}') from error
