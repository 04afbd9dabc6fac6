# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Write serialised messages to a rosbag2 directory (MCAP) that is always complete on the disk.

Each :meth:`BagWriter.seal` leaves a complete bag: files with summaries and ``metadata.yaml``. A
recorder that is killed therefore loses only the messages after the last seal, and nothing needs
repair. If a seal does not fit on the disk, the bag ends with the previous seal.

Like rosbag2 itself, the writer splits the bag into files ``NAME_0.mcap``, ``NAME_1.mcap`` and so
on, because the memory of a file and the duration of a seal grow with the number of its chunks.
"""

import shutil
from pathlib import Path

from pam_ros.errors import RecordingError
from pam_ros.recording.bag.mcap_file import McapFile
from pam_ros.recording.bag.metadata import BagTopic, ListedFile, Span, metadata_text, whole

CHUNKS = 256  # in a file, then a new file begins; each chunk takes about 3 kB of memory


class BagWriter:
    """A rosbag2 directory that is being written.

    ``counts`` are the messages of each topic by name. Raises RecordingError if the directory
    exists already or cannot be created.
    """

    def __init__(self, directory: Path, ros_distro: str = '') -> None:
        """Create *directory* with an empty bag in it."""
        self._directory, self._distro = directory, ros_distro
        self._topics: dict[int, BagTopic] = {}
        self._finished: list[ListedFile] = []
        self._file = self._next_file()
        try:
            directory.mkdir(parents=True)
        except FileExistsError:
            raise RecordingError(f'{directory} exists already: give another name') from None
        except OSError as error:
            raise RecordingError(f'{directory} cannot be made: {error.strerror}') from error
        self.counts: dict[str, int] = {}
        self._spans: dict[str, Span] = {}  # first and last time of each topic
        self._is_sealed = False
        self._sealed_counts: dict[str, int] = {}
        self._sealed_spans: dict[str, Span] = {}
        try:
            self.seal()
        except RecordingError:
            shutil.rmtree(directory, ignore_errors=True)
            raise

    def _next_file(self) -> McapFile:
        """Return a new file with all topics, which have the same channel numbers in all files."""
        file = McapFile(self._directory / f'{self._directory.name}_{len(self._finished)}.mcap')
        for topic in self._topics.values():
            file.add_topic(topic)
        return file

    def add_topic(self, topic: BagTopic) -> int:
        """Add *topic* and return its channel."""
        channel = self._file.add_topic(topic)
        self._topics[channel] = topic
        self.counts[topic.name] = 0
        self._is_sealed = False
        return channel

    def write(self, channel: int, received: int, published: int, data: bytes) -> None:
        """Add a message of *channel* with its times in ns."""
        self._file.write(channel, received, published, data)
        name = self._topics[channel].name
        self.counts[name] += 1
        first, last = self._spans.get(name, (received, received))
        self._spans[name] = min(first, received), max(last, received)
        self._is_sealed = False

    def seal(self) -> None:
        """Make the bag on the disk complete, with all messages so far.

        Raises RecordingError if writing to the disk fails. The bag is then left as it was after
        the last seal, and the next seal tries again to write all later messages.
        """
        if self._is_sealed:
            return
        listed = ListedFile.of(self._file.path.name, self._file.count, self._file.span)
        try:
            self._file.put()
            # Write the file first: metadata must never list a file that does not exist.
            self._put_metadata(listed)
        except OSError as error:
            self._file.undo()
            raise RecordingError(self._reason(error)) from error
        self._file.keep()
        self._sealed_counts, self._sealed_spans = dict(self.counts), dict(self._spans)
        self._is_sealed = True
        if self._file.most_chunks >= CHUNKS:
            self._file.close()
            self._finished.append(listed)
            self._file = self._next_file()

    def close(self) -> None:
        """Seal the bag for the last time, and close its file.

        Raises RecordingError if writing to the disk fails. Counts and times are then those of the
        last seal, as in the bag.
        """
        try:
            self.seal()
        except RecordingError:
            self.counts, self._spans = self._sealed_counts, self._sealed_spans
            raise
        finally:
            self._file.close()

    @property
    def duration(self) -> float:
        """Return the time in s from the first message to the last."""
        return _seconds(whole(self._spans.values()))

    def rate(self, topic: str) -> float:
        """Return the rate of *topic* in messages/s, from its first message to its last."""
        seconds = _seconds(self._spans.get(topic))
        return (self.counts[topic] - 1) / seconds if seconds else 0.0

    def _put_metadata(self, listed: ListedFile) -> None:
        text = metadata_text(
            self._topics.values(),
            self.counts,
            whole(self._spans.values()),
            [*self._finished, listed],
            self._distro,
        )
        partial = self._directory / '.metadata.yaml.part'
        try:
            partial.write_text(text, encoding='utf-8')
            partial.replace(self._directory / 'metadata.yaml')
        except OSError:
            partial.unlink(missing_ok=True)
            raise

    def _reason(self, error: OSError) -> str:
        """Return a sentence with the reason why a seal failed."""
        if isinstance(error, FileNotFoundError):
            gone = self._file.path if self._directory.is_dir() else self._directory
            return f'{gone} was deleted or renamed while it was recorded: nothing more is recorded'
        seconds = _seconds(whole(self._sealed_spans.values()))
        return (
            f'{self._file.path} cannot be written: {error.strerror}; '
            f'the bag ends after {seconds:.2f} s'
        )


def _seconds(span: Span | None) -> float:
    return (span[1] - span[0]) * 1e-9 if span else 0.0
