# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node ``pam_record``: finds topics, takes their messages, writes them to a bag."""

import argparse
import os
import sys
import threading
from collections.abc import Sequence
from datetime import datetime
from importlib import import_module
from pathlib import Path
from time import monotonic_ns
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.duration import Duration
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from pam_ros.errors import RecordingError
from pam_ros.nodes.message_text import message_text
from pam_ros.nodes.spin import TickingNode
from pam_ros.nodes.ticker import Ticker
from pam_ros.recording.bag_writer import BagTopic, BagWriter

TOPICS = ('joint_states', 'pressure_command', 'force', 'stiffness', 'damping', 'pressure')
DEPTH = 20_000  # messages of a topic that the middleware keeps while the disk is busy
LOOK = 5.0  # Hz, for new topics
TAKE = 0.01  # s between two rounds of taking messages
TAKE_SIMULATED = 0.001  # s, where the time of taking is what is recorded
SEAL = 0.5  # s between two seals: what a kill can lose
REPORT, REPORT_LOGGED = 1.0, 10.0  # s between lines of progress, on a terminal and in a log


class _Taken(CallbackGroup):
    """Subscriptions that no executor serves: their messages are taken by the recorder's thread.

    The middleware keeps them until then and knows when each was received.
    """

    def can_execute(self, entity: Any) -> bool:
        """Leave it to the recorder."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Leave it to the recorder."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Nothing has begun."""


class _Recorded:
    """A topic that is recorded."""

    def __init__(self, subscription: Subscription, channel: int) -> None:
        self.subscription, self.channel = subscription, channel
        self.last_number: int | None = None
        self.lost = 0

    def count_lost(self, number: int | None, is_sole: bool) -> None:
        """Count the messages between the last number of its one publisher and *number*."""
        if number is None:
            return
        if is_sole and self.last_number is not None and number > self.last_number:
            self.lost += number - self.last_number - 1
        self.last_number = number


class PamRecord(TickingNode):
    """The recorder node."""

    def __init__(self, directory: Path, topics: Sequence[str]) -> None:
        """Make the bag in *directory*; record our topics and *topics*."""
        super().__init__('pam_record')
        self._directory = directory
        names = dict.fromkeys((*TOPICS, *topics))
        self._wanted = {self._resolved(name): name in topics for name in names}
        self._writer = BagWriter(directory, os.environ.get('ROS_DISTRO', 'unknown'))
        self._recorded: dict[str, _Recorded] = {}
        self._refused: set[str] = set()
        self._sole: set[str] = set()
        self._group = _Taken()
        self._lock = threading.Lock()  # of the writer and of what is recorded
        self._is_closing = threading.Event()
        self._problem = ''
        self._begun = monotonic_ns()
        self._told = self._begun
        self._thread = threading.Thread(target=self._work, name='recorder')
        self.ticker = Ticker(LOOK)

    @classmethod
    def of_arguments(cls, parser: argparse.ArgumentParser, given: Sequence[str]) -> 'PamRecord':
        """Make the recorder that the command line asks for."""
        parser.add_argument('topics', nargs='*', metavar='TOPIC', help='record this topic as well')
        parser.add_argument(
            '-o',
            '--output',
            type=Path,
            metavar='DIR',
            default=Path(datetime.now().strftime('recording_%Y_%m_%d-%H_%M_%S')),
            help='directory of the bag, to be made (default: recording_DATE-TIME)',
        )
        arguments = parser.parse_args(given)
        return cls(arguments.output, arguments.topics)

    def make_executor(self) -> Executor:
        """Return an executor that heeds callback groups."""
        return SingleThreadedExecutor()

    def start(self) -> None:
        """Begin to record."""
        super().start()
        self._thread.start()
        print(f'recording to {self._directory}: Ctrl-C ends it', flush=True)

    def _resolved(self, name: str) -> str:
        try:
            return str(self.resolve_topic_name(name))
        except RuntimeError as error:
            raise RecordingError(f'{name!r} is no name of a topic: {error}') from error

    # Finding topics ------------------------------------------------------------------------

    def tick(self) -> None:
        """Look for topics that are published now, and say how it is going."""
        if self._problem:
            print(f'pam_record: {self._problem}', file=sys.stderr)
            self.exit_code = 1
            return
        kinds = dict(self.get_topic_names_and_types())
        for topic in self._wanted:
            publishers = self.get_publishers_info_by_topic(topic)
            if publishers and topic not in self._recorded and topic not in self._refused:
                self._add(topic, kinds.get(topic, []), publishers)
            if len(publishers) == 1:
                self._sole.add(topic)
            elif publishers:
                self._sole.discard(topic)
        pause = REPORT if sys.stdout.isatty() else REPORT_LOGGED
        if monotonic_ns() - self._told > pause * 1e9:
            self._told = monotonic_ns()
            self._tell()

    def _add(self, topic: str, kinds: list[str], publishers: list[Any]) -> None:
        kind = publishers[0].topic_type
        message_type = _message_type(kind)
        if len(set(kinds)) > 1 or message_type is None:
            self._refused.add(topic)
            reason = (
                f'it is published as {" and ".join(kinds)}'
                if len(set(kinds)) > 1
                else f'its type {kind} is not installed here'
            )
            self.get_logger().warning(f'{topic} is not recorded: {reason}')
            return
        described = BagTopic(
            topic,
            kind,
            message_text(kind),
            type_hash=str(publishers[0].topic_type_hash),
            qos=[_qos(info.qos_profile) for info in publishers],
        )
        subscription = self.create_subscription(
            message_type,
            topic,
            _never,
            _matching([info.qos_profile for info in publishers]),
            callback_group=self._group,
            raw=True,
        )
        with self._lock:
            self._recorded[topic] = _Recorded(subscription, self._writer.add_topic(described))

    # Taking and writing --------------------------------------------------------------------

    def _work(self) -> None:
        """Take and write messages until the node closes; a problem ends it."""
        sealed = monotonic_ns()
        try:
            while not self._is_closing.is_set():
                is_simulated = self.get_clock().ros_time_is_active
                self._is_closing.wait(TAKE_SIMULATED if is_simulated else TAKE)
                with self._lock:
                    self._take(is_simulated)
                    if monotonic_ns() - sealed > SEAL * 1e9:
                        self._writer.seal()
                        sealed = monotonic_ns()
        except Exception as error:  # whatever it is, nothing is recorded any more: say so
            self._problem = str(error) or type(error).__name__

    def _take(self, is_simulated: bool) -> None:
        """Write all messages that have come."""
        for topic, recorded in self._recorded.items():
            handle = recorded.subscription.handle
            is_sole = topic in self._sole
            with handle:
                while True:
                    taken = handle.take_message(recorded.subscription.msg_type, True)
                    if taken is None:
                        break
                    data, info = taken
                    received, sent = info['received_timestamp'], info['source_timestamp']
                    if is_simulated or not received:
                        received = sent = self.get_clock().now().nanoseconds
                    self._writer.write(recorded.channel, received, sent, data)
                    recorded.count_lost(info['publication_sequence_number'], is_sole)

    # Saying how it is ----------------------------------------------------------------------

    def _tell(self) -> None:
        elapsed = (monotonic_ns() - self._begun) * 1e-9
        counts = self._writer.counts
        missing = [topic for topic in self._wanted if topic not in counts]
        line = f'{elapsed:.0f} s, {sum(counts.values())} messages on {len(counts)} topics'
        if missing:
            line += ', nobody publishes ' + ', '.join(missing)
        if sys.stdout.isatty():
            print(f'\r\x1b[K{line}', end='', flush=True)
        else:
            print(line, flush=True)

    def destroy_node(self) -> None:
        """Close the bag and say what is in it."""
        if self._thread.is_alive():
            self._is_closing.set()
            self._thread.join()
        try:
            if not self._problem:
                self._take(self.get_clock().ros_time_is_active)
            self._writer.close()
        except RecordingError as error:
            print(f'pam_record: {error}', file=sys.stderr)
            self.exit_code = 1
        self._summarise()
        super().destroy_node()

    def _summarise(self) -> None:
        lines = [f'{self._directory}: {self._writer.duration:.2f} s']
        for topic, count in sorted(self._writer.counts.items()):
            lost = self._recorded[topic].lost
            note = f'  {lost} lost before they came here' if lost else ''
            lines.append(
                f'  {topic:<28} {count:>9} messages {self._writer.rate(topic):9.1f} Hz{note}'
            )
        for topic, is_asked in self._wanted.items():
            if topic not in self._writer.counts and is_asked:
                lines.append(f'  {topic:<28} was not published')
        if sys.stdout.isatty():
            print()
        print('\n'.join(lines), flush=True)


def _never(message: bytes) -> None:
    """Stand in for the callback: messages are taken, not called back with."""


def _message_type(kind: str) -> Any:
    package, _, name = kind.split('/')
    try:
        return getattr(import_module(f'{package}.msg'), name)
    except (ImportError, AttributeError):
        return None


def _matching(offered: list[QoSProfile]) -> QoSProfile:
    """Return a profile that hears all publishers, as well as they can be heard."""
    reliable = all(q.reliability == ReliabilityPolicy.RELIABLE for q in offered)
    lasting = all(q.durability == DurabilityPolicy.TRANSIENT_LOCAL for q in offered)
    return QoSProfile(
        depth=DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if lasting else DurabilityPolicy.VOLATILE,
    )


def _qos(profile: QoSProfile) -> dict[str, Any]:
    """Return a publisher's profile as rosbag2's metadata has it."""
    return {
        'history': profile.history.name.lower(),
        'depth': profile.depth,
        'reliability': profile.reliability.name.lower(),
        'durability': profile.durability.name.lower(),
        'deadline': _time(profile.deadline),
        'lifespan': _time(profile.lifespan),
        'liveliness': profile.liveliness.name.lower(),
        'liveliness_lease_duration': _time(profile.liveliness_lease_duration),
        'avoid_ros_namespace_conventions': profile.avoid_ros_namespace_conventions,
    }


def _time(duration: Duration) -> dict[str, int]:
    seconds, nanoseconds = divmod(duration.nanoseconds, 10**9)
    return {'sec': seconds, 'nsec': nanoseconds}
