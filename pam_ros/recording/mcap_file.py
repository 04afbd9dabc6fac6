# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An MCAP file of a bag that is whole each time it is written to the disk.

What is written ends in a summary and a footer. What is written next takes the place of the summary
and ends in a new one.
"""

import errno
import io
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from pam_ros.errors import RecordingError
from pam_ros.recording.bag_metadata import BagTopic, Span

_CHUNK = 1 << 20  # bytes of records, after which the library begins a new chunk
_RECORD = 31  # bytes of a message record without its data


class _Tail(io.BytesIO):
    """The end of a file that is not written yet; positions are those in the file."""

    def __init__(self) -> None:
        super().__init__()
        self.start = 0

    def tell(self) -> int:
        """Return the position in the file."""
        return self.start + super().tell()

    def back_to(self, position: int) -> None:
        """Forget everything; go on at *position* in the file."""
        self.start = position
        self.seek(0)
        self.truncate()


class McapFile:
    """A file that begins to exist with the first :meth:`put`.

    ``count`` is the number of messages, ``span`` their first and last time in ns. The file has at
    most ``most_chunks`` chunks; the summary, which each put writes again, has an entry for each.

    Raises RecordingError if the Python package ``mcap`` is not installed.
    """

    def __init__(self, path: Path) -> None:
        """Make an empty file in memory, for the place *path*."""
        try:
            from mcap.writer import CompressionType, Writer
        except ImportError:
            raise RecordingError(
                'writing bags needs the Python package mcap: install it with pip, or record with '
                'ros2 bag record'
            ) from None
        self.path = path
        self.count = 0
        self.span: Span | None = None
        self.most_chunks = 0
        self._descriptor: int | None = None
        self._schemas: dict[str, int] = {}
        self._bytes = 0  # of records since the last put
        self._tail = _Tail()
        self._end = 0  # of the data that the last put wrote: there begins its summary
        self._summary = b''
        self._kept: tuple[int, bytes] | None = None  # position and bytes of the last summary
        self._writer: Any = Writer(
            self._tail, _CHUNK, compression=CompressionType.ZSTD, use_summary_offsets=False
        )
        self._writer.start(profile='ros2', library='pam_ros')

    def add_topic(self, topic: BagTopic) -> int:
        """Add *topic* and return its channel: 1 for the first topic, 2 for the second..."""
        if topic.type not in self._schemas:
            self._schemas[topic.type] = self._writer.register_schema(
                topic.type, topic.encoding, topic.definition.encode()
            )
        schema = self._schemas[topic.type]
        return int(
            self._writer.register_channel(topic.name, 'cdr', schema, topic.channel_metadata)
        )

    def write(self, channel: int, received: int, published: int, data: bytes) -> None:
        """Add a message of *channel* with its times in ns."""
        self._writer.add_message(channel, received, data, published)
        self.count += 1
        self._bytes += len(data) + _RECORD
        first, last = self.span or (received, received)
        self.span = min(first, received), max(last, received)

    def put(self) -> None:
        """Make the file on the disk whole, with all that was written so far.

        Call :meth:`keep` or :meth:`undo` next. Raises OSError if the disk does not take it, and
        FileNotFoundError if the file was deleted.
        """
        self._writer.flush()
        self.most_chunks += 1 + self._bytes // _CHUNK
        self._bytes = 0
        start, self._end = self._tail.start, self._tail.tell()
        self._writer.finish()
        data = self._tail.getvalue()
        self._summary = data[self._end - start :]
        if self._descriptor is None:
            self._descriptor = os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
        elif os.fstat(self._descriptor).st_nlink == 0:
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
        _write(self._descriptor, data, start)

    def keep(self) -> None:
        """Accept what the last put wrote: it is no longer needed in memory."""
        self._tail.back_to(self._end)
        self._kept = self._end, self._summary

    def undo(self) -> None:
        """Leave the file as it was before the last put, which the next one tries again."""
        self._tail.seek(self._end - self._tail.start)
        self._tail.truncate()
        # The old summary was on the disk before, and cutting the file off makes room for it.
        with suppress(OSError):
            if self._kept is not None and self._descriptor is not None:
                position, summary = self._kept
                _write(self._descriptor, summary, position)
            elif self._descriptor is not None:
                self.close()
                self.path.unlink()

    def close(self) -> None:
        """Close the file as it is on the disk."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None


def _write(file: int, data: bytes, position: int) -> None:
    """Replace what *file* has from *position* on."""
    # The old summary goes first: a file that lacks its end is recognized as unfinished, one
    # whose summary is half that of another is not.
    os.ftruncate(file, position)
    rest = memoryview(data)
    while rest:
        written = os.pwrite(file, rest, position)
        rest, position = rest[written:], position + written
