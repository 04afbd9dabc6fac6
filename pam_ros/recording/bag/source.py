# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a rosbag2, read with the ``rosbags`` library.

An MCAP file that its recorder did not close (killed, power failure) is read to its end with
``mcap``.
"""

import importlib.util
import io
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from pam_ros.errors import ParameterError, RecordingError
from pam_ros.plain_yaml import read_yaml
from pam_ros.recording.bag.decode import RosbagsDecoder, Topic

METADATA = 'metadata.yaml'
CDR = 'cdr'  # how ROS 2 encodes messages
_MAGIC = b'\x89MCAP0\r\n'


class Message(NamedTuple):
    """A message as it was stored: ``stamp`` is its receive time in ns."""

    topic: str
    stamp: int
    data: bytes


class BagSource(NamedTuple):
    """A bag: its topics by name, a reader of selected ones, a decoder, and notes on defects."""

    topics: dict[str, Topic]
    messages: Callable[[Collection[str]], Iterator[Message]]
    decode: Callable[[Topic, bytes], Any]
    notes: list[str]


def bag_files(path: Path) -> list[Path]:
    """Return the storage files of a bag (a directory or one file), in the order of recording.

    Raises RecordingError if there are none.
    """
    if path.is_file():
        return [path]
    listed = _metadata(path).get('relative_file_paths')
    if not (listed is None or isinstance(listed, list)) or not _are_texts(listed or ()):
        raise RecordingError(
            f'{path / METADATA}: relative_file_paths = {listed!r} is not a list of file names'
        )
    if listed:
        files = [path / Path(name).name for name in listed]
        missing = [name for name, file in zip(listed, files, strict=True) if not file.is_file()]
        if missing:
            raise RecordingError(f'{path}: {METADATA} lists {missing[0]}, which is not there')
        return files
    found = [file for suffix in ('mcap', 'db3') for file in path.glob(f'*.{suffix}')]
    if not found:
        raise RecordingError(f'{path} is not a rosbag2: it has neither a .mcap nor a .db3 file')
    return sorted(found, key=lambda file: (len(file.name), file.name))


def open_bag(path: Path) -> BagSource:
    """Return the bag at *path* (a rosbag2 directory, or one .mcap or .db3 file of one).

    Raises RecordingError if it cannot be read, or if the library that reads it is missing.
    """
    if importlib.util.find_spec('rosbags') is None:
        raise RecordingError(
            f'{path} is a rosbag2: to read it, install the Python package rosbags with pip'
        )
    files = bag_files(path)
    decode = RosbagsDecoder()
    if any(_is_unfinished(file) for file in files):
        notes = ['the bag was not closed by its recorder: read up to where it ends']
        topics, messages = _read_with_mcap(files)
        if not topics:
            raise RecordingError(
                f'{path} was not closed by its recorder, and ends before its first complete '
                'chunk: there is nothing in it that can be read'
            )
        return BagSource(topics, messages, decode, notes)
    others = sorted(set().union(*map(_of_other_encodings, files)))
    if others:
        notes = [f'topics that are not of ROS 2 are not read: {", ".join(others)}']
        return BagSource(*_read_with_mcap(files), decode, notes)
    # A directory without metadata (a recorder that was killed) is read file by file.
    parts = [path] if path.is_file() or (path / METADATA).exists() else files
    topics, messages = _read_with_rosbags(path, parts)
    return BagSource(topics, messages, decode, [])


def _metadata(path: Path) -> dict[str, Any]:
    file = path / METADATA
    if not file.exists():
        return {}
    try:
        content = read_yaml(file)
    except ParameterError as error:
        raise RecordingError(str(error)) from error
    information = 'rosbag2_bagfile_information'
    found = content.get(information) if isinstance(content, dict) else None
    if not isinstance(found, dict):
        raise RecordingError(f'{file} is not the metadata of a rosbag2: {information} is missing')
    return found


def _are_texts(values: Collection[Any]) -> bool:
    return all(isinstance(value, str) for value in values)


def _is_unfinished(file: Path) -> bool:
    """Return whether an MCAP lacks its end. Raises RecordingError if it is not an MCAP."""
    if file.suffix != '.mcap':
        return False
    with file.open('rb') as stream:
        if stream.read(len(_MAGIC)) != _MAGIC:
            raise RecordingError(
                f'{file.name} cannot be read as a rosbag2: it is not an MCAP file'
            )
        size = stream.seek(0, 2)
        stream.seek(size - len(_MAGIC))
        return stream.read() != _MAGIC or size == len(_MAGIC)


def _of_other_encodings(file: Path) -> set[str]:
    """Return the topics of an MCAP that programs without ROS have added, in their own encoding.

    It is empty if the Python package mcap is not installed, or if the file has no summary.
    """
    if file.suffix != '.mcap' or importlib.util.find_spec('mcap') is None:
        return set()
    from mcap.reader import make_reader

    try:
        with file.open('rb') as stream:
            summary = make_reader(stream).get_summary()
    except Exception:  # the reader of the messages says what is wrong
        return set()
    channels = summary.channels.values() if summary else ()
    return {channel.topic for channel in channels if channel.message_encoding != CDR}


def _unreadable(path: Path, error: Exception) -> RecordingError:
    """Return the exception to raise for an *error* of a library that reads the bag at *path*."""
    what = ' '.join(str(error).split()) or type(error).__name__
    return RecordingError(f'{path} cannot be read as a rosbag2: {what}')


Read = tuple[dict[str, Topic], Callable[[Collection[str]], Iterator[Message]]]


def _read_with_rosbags(path: Path, parts: list[Path]) -> Read:
    from rosbags.rosbag2 import Reader

    topics: dict[str, Topic] = {}
    try:
        for part in parts:
            with Reader(part) as reader:
                for connection in reader.connections:
                    # The library takes both from the metadata as they are.
                    if not _are_texts((connection.topic, connection.msgtype)):
                        raise ValueError(
                            f'{METADATA} has a topic {connection.topic!r} of type '
                            f'{connection.msgtype!r}, which are not both texts'
                        )
                    topics[connection.topic] = Topic(connection.msgtype, connection.msgdef.data)
    except Exception as error:  # the library raises whatever its parsing meets
        raise _unreadable(path, error) from error

    def messages(wanted: Collection[str]) -> Iterator[Message]:
        try:
            for part in parts:
                with Reader(part) as reader:
                    chosen = [c for c in reader.connections if c.topic in wanted]
                    for connection, stamp, data in reader.messages(chosen) if chosen else ():
                        yield Message(connection.topic, stamp, bytes(data))
        except Exception as error:
            raise _unreadable(path, error) from error

    return topics, messages


class _Whole(io.BufferedReader):
    """A file that raises EOFError if fewer bytes are left than were requested."""

    def __init__(self, raw: io.FileIO) -> None:
        super().__init__(raw)
        self._size = raw.seek(0, io.SEEK_END)
        raw.seek(0)

    def read(self, size: int | None = -1, /) -> bytes:
        """Return exactly *size* bytes, or raise EOFError."""
        # A length that was written only in part may request more than the memory can hold.
        if size is not None and size > self._size - self.tell():
            raise EOFError
        return super().read(size)


def _read_with_mcap(files: list[Path]) -> Read:
    """Read the topics of ROS 2 in the order of the files, up to the last complete record."""
    try:
        from mcap.records import Channel, Schema
        from mcap.records import Message as Record
        from mcap.stream_reader import StreamReader
    except ImportError:
        raise RecordingError(
            f'{files[-1].name} was not closed by its recorder: to read it, install the Python '
            'package mcap with pip, or repair it with ros2 bag reindex'
        ) from None

    def records(wanted: Collection[str] | None) -> Iterator[tuple[str, Topic, Message | None]]:
        for file in files:
            schemas: dict[int, Any] = {}
            channels: dict[int, Any] = {}
            with _Whole(io.FileIO(file)) as stream:
                try:
                    for record in StreamReader(stream, validate_crcs=True).records:
                        if isinstance(record, Schema):
                            schemas[record.id] = record
                        elif isinstance(record, Channel) and record.message_encoding == CDR:
                            channels[record.id] = record
                            schema = schemas[record.schema_id]
                            topic = Topic(schema.name, schema.data.decode())
                            yield record.topic, topic, None
                        elif isinstance(record, Record) and wanted is not None:
                            channel = channels.get(record.channel_id)
                            if channel is not None and channel.topic in wanted:
                                one = Message(channel.topic, record.log_time, record.data)
                                yield channel.topic, topic, one
                except Exception:  # the libraries raise whatever parsing and decompression meet
                    continue  # the complete records end here

    def messages(wanted: Collection[str]) -> Iterator[Message]:
        return (message for _, _, message in records(wanted) if message is not None)

    return {name: topic for name, topic, _ in records(None)}, messages
