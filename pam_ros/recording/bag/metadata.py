# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The ``metadata.yaml`` of a rosbag2 directory with MCAP files, version 9.

The fields are those that ``rosbag2_storage/yaml.hpp`` lists; the lists of files are at the end.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from textwrap import indent
from typing import Any, NamedTuple

import yaml

METADATA_VERSION = 9  # rosbag2's, since Jazzy
_NO_TIME = 2**63 - 1  # the start that rosbag2 writes for a bag without messages

Span = tuple[int, int]  # first and last time in ns


@dataclass(frozen=True)
class BagTopic:
    """A topic as a bag describes it.

    ``definition`` is the complete text of the message type, ``encoding`` its format
    (``ros2msg``), ``type_hash`` the type's description hash, ``qos`` the profiles of the
    publishers as rosbag2's metadata lists them.
    """

    name: str
    type: str
    definition: str
    encoding: str = 'ros2msg'
    type_hash: str = ''
    qos: list[dict[str, Any]] = field(default_factory=list)

    @property
    def channel_metadata(self) -> dict[str, str]:
        """Return the metadata that rosbag2 stores with the topic in each MCAP file."""
        return {
            'offered_qos_profiles': _dump(self.qos) if self.qos else '',
            'topic_type_hash': self.type_hash,
        }


class ListedFile(NamedTuple):
    """The two entries of a file in the metadata, as YAML text.

    The text of a finished file is kept, because dumping a list of many files takes long.
    """

    path: str
    entry: str

    @classmethod
    def of(cls, name: str, count: int, span: Span | None) -> 'ListedFile':
        """Return the text of the file *name* with *count* messages between the times *span*."""
        entry = {'path': name, **_times(span), 'message_count': count}
        return cls(indent(_dump([name]), '  '), indent(_dump([entry]), '  '))


def whole(spans: Iterable[Span]) -> Span | None:
    """Return the first and the last time in ns of all *spans*, None if there are none."""
    starts_and_ends = list(zip(*spans, strict=True))
    return (min(starts_and_ends[0]), max(starts_and_ends[1])) if starts_and_ends else None


def metadata_text(
    topics: Iterable[BagTopic],
    counts: Mapping[str, int],
    span: Span | None,
    files: Sequence[ListedFile],
    ros_distro: str,
) -> str:
    """Return the text of ``metadata.yaml``; *counts* are the messages of each topic by name."""
    content = {
        'version': METADATA_VERSION,
        'storage_identifier': 'mcap',
        **_times(span),
        'message_count': sum(counts.values()),
        'topics_with_message_count': [
            {
                'topic_metadata': {
                    'name': topic.name,
                    'type': topic.type,
                    'serialization_format': 'cdr',
                    'offered_qos_profiles': topic.qos,
                    'type_description_hash': topic.type_hash,
                },
                'message_count': counts[topic.name],
            }
            for topic in topics
        ],
        'compression_format': '',
        'compression_mode': '',
        'custom_data': None,
        'ros_distro': ros_distro,
    }
    return ''.join(
        (
            _dump({'rosbag2_bagfile_information': content}),
            '  relative_file_paths:\n',
            *(file.path for file in files),
            '  files:\n',
            *(file.entry for file in files),
        )
    )


def _times(span: Span | None) -> dict[str, dict[str, int]]:
    first, last = span or (_NO_TIME, _NO_TIME)
    return {
        'duration': {'nanoseconds': last - first},
        'starting_time': {'nanoseconds_since_epoch': first},
    }


class _Plain(yaml.SafeDumper):
    """YAML without anchors, with keys in their given order, as rosbag2 writes it."""

    def ignore_aliases(self, data: Any) -> bool:
        """Write every value in full, without an alias."""
        return True


def _dump(content: Any) -> str:
    return str(yaml.dump(content, Dumper=_Plain, sort_keys=False))
