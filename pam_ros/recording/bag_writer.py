# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Write serialised messages to a rosbag2 directory (MCAP) that is whole at every moment.

Each :meth:`BagWriter.seal` leaves a complete bag behind: chunks, summary, footer and
``metadata.yaml``. What is written next takes the place of the summary and ends in a new one. A
recorder that is killed therefore loses what came after the last seal, and nothing needs repair.
Where a seal does not fit on the disk, the bag ends with the one before.
"""

import io
import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from pam_ros.errors import RecordingError

METADATA_VERSION = 9  # rosbag2's, since Jazzy
_NO_TIME = 2**63 - 1  # what rosbag2 writes as the start of a bag without messages


@dataclass(frozen=True)
class BagTopic:
    """A topic as a bag describes it.

    ``definition`` is the complete text of the message type, ``encoding`` its form
    (``ros2msg``), ``type_hash`` the type's description hash, ``qos`` the profiles of the
    publishers as rosbag2's metadata lists them.
    """

    name: str
    type: str
    definition: str
    encoding: str = 'ros2msg'
    type_hash: str = ''
    qos: list[dict[str, Any]] = field(default_factory=list)


class _Tail(io.BytesIO):
    """The end of a file that is not written yet; positions are those in the file."""

    def __init__(self, start: int) -> None:
        super().__init__()
        self.start = start

    def tell(self) -> int:
        """Return the position in the file."""
        return self.start + super().tell()

    def back_to(self, position: int) -> None:
        """Forget everything; go on at *position* in the file."""
        self.start = position
        self.seek(0)
        self.truncate()


class BagWriter:
    """A rosbag2 directory that is being written.

    Raises RecordingError where the directory exists already or cannot be made.
    """

    def __init__(self, directory: Path, ros_distro: str = '') -> None:
        """Make *directory* with an empty bag in it."""
        try:
            from mcap.writer import CompressionType, Writer
        except ImportError:
            raise RecordingError(
                'writing bags needs the Python package mcap: install it with pip, or record with '
                'ros2 bag record'
            ) from None
        self._directory, self._distro = directory, ros_distro
        self._name = f'{directory.name}_0.mcap'
        try:
            directory.mkdir(parents=True)
            self._file = os.open(
                directory / self._name, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666
            )
        except FileExistsError:
            raise RecordingError(f'{directory} exists already: give another name') from None
        except OSError as error:
            raise RecordingError(f'{directory} cannot be made: {error.strerror}') from error
        self._topics: dict[int, BagTopic] = {}
        self._schemas: dict[str, int] = {}
        self.counts: dict[str, int] = {}
        self._spans: dict[str, tuple[int, int]] = {}  # first and last time of each topic
        self._tail = _Tail(0)
        self._writer: Any = Writer(
            self._tail, compression=CompressionType.ZSTD, use_summary_offsets=False
        )
        self._writer.start(profile='ros2', library='pam_ros')
        self._is_sealed = False
        self._sealed: tuple[int, bytes] = (0, b'')  # position and bytes of the last summary
        self._sealed_counts: dict[str, int] = {}
        self._sealed_spans: dict[str, tuple[int, int]] = {}
        try:
            self.seal()
        except RecordingError:
            os.close(self._file)
            shutil.rmtree(directory, ignore_errors=True)
            raise

    def add_topic(self, topic: BagTopic) -> int:
        """Add *topic* and return its channel."""
        if topic.type not in self._schemas:
            self._schemas[topic.type] = self._writer.register_schema(
                topic.type, topic.encoding, topic.definition.encode()
            )
        metadata = {
            'offered_qos_profiles': _dump(topic.qos) if topic.qos else '',
            'topic_type_hash': topic.type_hash,
        }
        schema = self._schemas[topic.type]
        channel: int = self._writer.register_channel(topic.name, 'cdr', schema, metadata)
        self._topics[channel] = topic
        self.counts[topic.name] = 0
        self._is_sealed = False
        return channel

    def write(self, channel: int, received: int, published: int, data: bytes) -> None:
        """Add a message of *channel* with its times in ns."""
        self._writer.add_message(channel, received, data, published)
        name = self._topics[channel].name
        self.counts[name] += 1
        first, last = self._spans.get(name, (received, received))
        self._spans[name] = min(first, received), max(last, received)
        self._is_sealed = False

    def seal(self) -> None:
        """Make the bag on disk whole, with all that was written so far.

        Raises RecordingError where the disk does not take it: the bag is then left as by the last
        seal, and the next one tries to write all that came after it.
        """
        if self._is_sealed:
            return
        self._writer.flush()
        start, end = self._tail.start, self._tail.tell()
        self._writer.finish()
        data = self._tail.getvalue()
        try:
            self._put(data, start)
            self._put_metadata()
        except OSError as error:
            self._tail.seek(end - start)
            self._tail.truncate()
            self._back_to_last_seal()
            raise RecordingError(
                f'{self._directory / self._name} cannot be written: {error.strerror}; '
                f'the bag ends after {_seconds(self._sealed_spans):.2f} s'
            ) from error
        self._tail.back_to(end)
        self._sealed = end, data[end - start :]
        self._sealed_counts, self._sealed_spans = dict(self.counts), dict(self._spans)
        self._is_sealed = True

    def _back_to_last_seal(self) -> None:
        position, summary = self._sealed
        # It was there before, and cutting the file off makes room for it.
        with suppress(OSError):
            self._put(summary, position)

    def close(self) -> None:
        """Seal the bag for good.

        Raises RecordingError where the disk does not take it: counts and times are then those of
        the last seal, as the bag is.
        """
        try:
            self.seal()
        except RecordingError:
            self.counts, self._spans = self._sealed_counts, self._sealed_spans
            raise
        finally:
            os.close(self._file)

    @property
    def duration(self) -> float:
        """Return the time in s from the first message to the last."""
        return _seconds(self._spans)

    def rate(self, topic: str) -> float:
        """Return the messages a second of *topic* between its first and its last."""
        first, last = self._spans.get(topic, (0, 0))
        return (self.counts[topic] - 1) / ((last - first) * 1e-9) if last > first else 0.0

    def _put(self, data: bytes, position: int) -> None:
        # The old summary goes first: a file that lacks its end is known to, one whose summary
        # is half another's is not.
        os.ftruncate(self._file, position)
        rest = memoryview(data)
        while rest:
            written = os.pwrite(self._file, rest, position)
            rest, position = rest[written:], position + written

    def _put_metadata(self) -> None:
        total = sum(self.counts.values())
        first, last = _whole(self._spans)
        duration = {'nanoseconds': last - first}
        start = {'nanoseconds_since_epoch': first}
        content = {
            'version': METADATA_VERSION,
            'storage_identifier': 'mcap',
            'duration': duration,
            'starting_time': start,
            'message_count': total,
            'topics_with_message_count': [
                {
                    'topic_metadata': {
                        'name': topic.name,
                        'type': topic.type,
                        'serialization_format': 'cdr',
                        'offered_qos_profiles': topic.qos,
                        'type_description_hash': topic.type_hash,
                    },
                    'message_count': self.counts[topic.name],
                }
                for topic in self._topics.values()
            ],
            'compression_format': '',
            'compression_mode': '',
            'relative_file_paths': [self._name],
            'files': [
                {
                    'path': self._name,
                    'starting_time': start,
                    'duration': duration,
                    'message_count': total,
                }
            ],
            'custom_data': None,
            'ros_distro': self._distro,
        }
        partial = self._directory / '.metadata.yaml.part'
        try:
            partial.write_text(_dump({'rosbag2_bagfile_information': content}), encoding='utf-8')
            partial.replace(self._directory / 'metadata.yaml')
        except OSError:
            partial.unlink(missing_ok=True)
            raise


def _whole(spans: Mapping[str, tuple[int, int]]) -> tuple[int, int]:
    """Return the first and the last time in ns of all topics."""
    if not spans:
        return _NO_TIME, _NO_TIME
    return min(first for first, _ in spans.values()), max(last for _, last in spans.values())


def _seconds(spans: Mapping[str, tuple[int, int]]) -> float:
    first, last = _whole(spans)
    return (last - first) * 1e-9


class _Plain(yaml.SafeDumper):
    """YAML without anchors, in the order in which it was made: as rosbag2 writes it."""

    def ignore_aliases(self, data: Any) -> bool:
        """Write every value out."""
        return True


def _dump(content: Any) -> str:
    return str(yaml.dump(content, Dumper=_Plain, sort_keys=False))
