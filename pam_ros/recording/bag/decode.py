# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Decode the messages of a rosbag2 with the ``rosbags`` library."""

from typing import Any, NamedTuple

from pam_ros.errors import RecordingError


class Topic(NamedTuple):
    """The type of a topic and the text in the bag that defines this type ('' if there is none)."""

    type: str
    definition: str = ''


class RosbagsDecoder:
    """Decode messages with ``rosbags``, by the type definitions in the bag if it has them."""

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
                    f'the bag does not define {topic.type}, and it is not one of the standard '
                    'types: convert it to MCAP with ros2 bag convert where this type is installed'
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
