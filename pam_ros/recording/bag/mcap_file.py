# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An MCAP file of a bag that is complete after each write to the disk.

Each write ends with a summary and a footer. The next write replaces both, and ends with new
ones.
"""

import errno
import io
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from pam_ros.errors import RecordingError
from pam_ros.recording.bag.metadata import BagTopic, Span

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
        """Discard the content; continue at *position* in the file."""
        self.start = position
        self.seek(0)
        self.truncate()


class McapFile:
    """A file that the first :meth:`put` creates on the disk.

    ``count`` is the number of messages, ``span`` their first and last time in ns. The file has at
    most ``most_chunks`` chunks; the summary, which each put writes again, has an entry for each.

    Raises RecordingError if the Python package ``mcap`` is not installed.
    """

    def __init__(self, path: Path) -> None:
        """Create an empty file in memory, to be written to *path*."""
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
        self._end = 0  # end of the data of the last put, where its summary begins
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
        """Make the file on the disk complete, with all messages so far.

        Call :meth:`keep` or :meth:`undo` next. Raises OSError if writing to the disk fails, and
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
        """Accept the last put: its data are no longer needed in memory."""
        self._tail.back_to(self._end)
        self._kept = self._end, self._summary

    def undo(self) -> None:
        """Restore the file to its state before the last put; the next put tries again."""
        self._tail.seek(self._end - self._tail.start)
        self._tail.truncate()
        # The old summary was on the disk before, and truncating the file makes room for it.
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
    """Replace the content of *file* from *position* to its end."""
    # Remove the old summary first: a file without an end is recognized as unfinished, a file whose
    # summary is partly an old one is not.
    os.ftruncate(file, position)
    rest = memoryview(data)
    while rest:
        written = os.pwrite(file, rest, position)
        rest, position = rest[written:], position + written
