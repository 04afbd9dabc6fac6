# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node ``pam_record``: finds topics, takes their messages, writes them to a bag."""

import argparse
import os
import sys
import threading
from collections.abc import Container, Mapping, Sequence
from datetime import datetime
from importlib import import_module
from pathlib import Path
from time import monotonic_ns, sleep, time_ns
from typing import Any

from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock

from pam_ros.errors import RecordingError, shown
from pam_ros.health.absence import Absence
from pam_ros.nodes.common.rclpy_internals import messages_of
from pam_ros.nodes.common.spin import BAD_INPUT, TickingNode
from pam_ros.nodes.record.message_text import message_text
from pam_ros.nodes.record.qos import matching, metadata
from pam_ros.nodes.record.taking import Recorded, Taken, never
from pam_ros.recording.bag_metadata import BagTopic
from pam_ros.recording.bag_writer import BagWriter
from pam_ros.recording.simulated_time import SimulatedTime
from pam_ros.timing.pace import SECOND
from pam_ros.timing.ticker import Ticker

# The topics of a muscle with its own load, and of a rig with joints.
OF_MUSCLE = ('joint_states', 'pressure_command', 'force', 'stiffness', 'damping', 'pressure')
OF_JOINTS = (
    'joint_states',
    'pressure_commands',
    'forces',
    'stiffnesses',
    'dampings',
    'pressures',
)
LOOK = 5.0  # Hz, for new topics
TAKE = 0.01  # s between two rounds of taking messages
# ns that the recorder waits for missing messages, also at its end: the middleware sends a lost
# message again after up to 3 s.
PATIENCE = 5 * SECOND
# ns. At the end, a topic with a longer period is not expected to have a later message, and no
# time on /clock is missing that would be so little later than the last one.
STILL = SECOND // 10
SEAL = 0.5  # s between two seals: a killed recorder can lose the messages of this time
REPORT, REPORT_LOGGED = 1.0, 10.0  # s between lines of progress, on a terminal and in a log


def missing_topics(
    wanted: Mapping[str, bool], found: Container[str], of_muscle: set[str], of_joints: set[str]
) -> list[str]:
    """Return those of the *wanted* topics that are not among those *found*.

    *wanted* is true for a topic that the user requested. Other topics are missing only if they
    belong to the rig. These are the topics of a muscle, until a topic is found that only a rig
    with joints has; then they are the topics of joints.
    """
    has_joints = any(topic in found for topic in of_joints - of_muscle)
    own = of_joints if has_joints else of_muscle
    return [
        name
        for name, is_requested in wanted.items()
        if name not in found and (is_requested or name in own)
    ]


class PamRecord(TickingNode):
    """The recorder node."""

    has_parameters = False

    def __init__(self, directory: Path, topics: Sequence[str]) -> None:
        """Create the bag in *directory*; record the topics of a rig and *topics*."""
        super().__init__('pam_record')
        self._directory = directory
        names = dict.fromkeys((*OF_MUSCLE, *OF_JOINTS, *topics))
        self._wanted = {self._resolved(name): name in topics for name in names}
        self._of_rigs = [{*map(self._resolved, own)} for own in (OF_MUSCLE, OF_JOINTS)]
        self._writer = BagWriter(directory, os.environ.get('ROS_DISTRO', 'unknown'))
        self._recorded: dict[str, Recorded] = {}
        self._refused: set[str] = set()
        self._sole: set[str] = set()
        self._group = Taken()
        self._time = SimulatedTime()
        self._is_simulated = bool(self.get_parameter('use_sim_time').value)
        self._clock_subscription: Subscription | None = None
        self._lock = threading.Lock()  # of the writer and of the recorded topics
        self._is_closing = threading.Event()
        self._problem: Exception | None = None
        self._absence = Absence(self.get_logger(), 'the first topic is found')
        self._begun = monotonic_ns()
        self._reported = self._begun
        self._thread = threading.Thread(target=self._work, name='recorder')
        self.ticker = Ticker(LOOK)

    @classmethod
    def add_arguments(cls, parser: argparse.ArgumentParser) -> None:
        """Add the topics and the directory."""
        parser.add_argument('topics', nargs='*', metavar='TOPIC', help='record this topic as well')
        parser.add_argument(
            '-o',
            '--output',
            type=Path,
            metavar='DIR',
            default=Path(datetime.now().strftime('recording_%Y_%m_%d-%H_%M_%S')),
            help='directory of the bag, which is created (default: recording_DATE-TIME)',
        )

    @classmethod
    def of_arguments(cls, arguments: argparse.Namespace) -> 'PamRecord':
        """Create the recorder with the options of the command line."""
        return cls(arguments.output, arguments.topics)

    def make_executor(self) -> Executor:
        """Return an executor that obeys callback groups."""
        return SingleThreadedExecutor()

    def start(self) -> None:
        """Start to record."""
        super().start()
        self._thread.start()
        self.get_logger().info(
            shown(f'records to {self._directory}, until Ctrl-C: {", ".join(self._wanted)}')
        )

    def _resolved(self, name: str) -> str:
        try:
            return str(self.resolve_topic_name(name))
        except RuntimeError as error:
            raise RecordingError(f'{name!r} is not a valid topic name: {error}') from error

    # Finding topics ------------------------------------------------------------------------

    def tick(self) -> None:
        """Look for published topics, and print the progress."""
        if self._problem:
            self._fail(self._problem)
            return
        kinds = dict(self.get_topic_names_and_types())
        clocks = self.get_publishers_info_by_topic('/clock') if self._is_simulated else []
        if clocks and self._clock_subscription is None:
            clock = self._subscribe(Clock, '/clock', clocks, raw=False)
            with self._lock:
                self._clock_subscription = clock
        for topic in self._wanted:
            publishers = self.get_publishers_info_by_topic(topic)
            if publishers and topic not in self._recorded and topic not in self._refused:
                self._add(topic, kinds.get(topic, []), publishers)
            if len(publishers) == 1:
                self._sole.add(topic)
            elif publishers:
                self._sole.discard(topic)
        is_alone = not (self._recorded or self._refused)
        missing = 'waits for a publisher of one of these topics' if is_alone else ''
        self._absence.look(missing, monotonic_ns() / SECOND)
        pause = REPORT if sys.stdout.isatty() else REPORT_LOGGED
        if monotonic_ns() - self._reported > pause * 1e9:
            self._reported = monotonic_ns()
            self._report()

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
            qos=[metadata(info.qos_profile) for info in publishers],
        )
        subscription = self._subscribe(message_type, topic, publishers)
        with self._lock:
            self._recorded[topic] = Recorded(subscription, self._writer.add_topic(described))

    def _subscribe(
        self, kind: Any, topic: str, publishers: list[Any], *, raw: bool = True
    ) -> Subscription:
        """Subscribe with the best quality of service that these publishers offer."""
        return self.create_subscription(
            kind,
            topic,
            never,
            matching([info.qos_profile for info in publishers]),
            callback_group=self._group,
            raw=raw,
        )

    # Taking and writing --------------------------------------------------------------------

    def _work(self) -> None:
        """Take and write messages until the node closes or an error occurs."""
        sealed = monotonic_ns()
        try:
            while not self._is_closing.is_set():
                self._is_closing.wait(TAKE)
                with self._lock:
                    self._take()
                    if monotonic_ns() - sealed > SEAL * 1e9:
                        self._writer.seal()
                        sealed = monotonic_ns()
        except Exception as error:  # any error ends the recording and is reported
            self._problem = error

    def _take(self, *, is_last: bool = False) -> None:
        """Take all messages that have arrived; write those with a known time, or all if *is_last*.

        The time of a message is the time when it was sent. On the clock of the recorder it is
        known if the topic has one publisher; else it is the time of receipt. In simulated time it
        is the time on ``/clock`` when the message was sent. The time when it is taken is later;
        the faster time is simulated, the greater is this delay.
        """
        for topic, recorded in self._recorded.items():
            for data, info in messages_of(recorded.subscription):
                received, sent = info['received_timestamp'], info['source_timestamp']
                recorded.count(sent)
                if self._is_simulated and sent:
                    recorded.waiting.append((data, sent, monotonic_ns()))
                else:
                    if self._is_simulated or not received:
                        received = sent = self.get_clock().now().nanoseconds
                    elif sent and topic in self._sole:
                        received = recorded.sending.at(sent, received)
                    self._writer.write(recorded.channel, received, sent, data)
                recorded.count_lost(info['publication_sequence_number'], topic in self._sole)
        if self._clock_subscription:
            for message, info in messages_of(self._clock_subscription):
                if not self.refuses_time(message):
                    now = message.clock.sec * SECOND + message.clock.nanosec
                    self._time.tell(info['source_timestamp'], now)
        for recorded in self._recorded.values():
            self._write_waiting(recorded, is_last)

    def _write_waiting(self, recorded: Recorded, is_last: bool) -> None:
        """Write the messages of a topic before the first one whose time is not known yet."""
        now, waiting = monotonic_ns(), recorded.waiting
        while waiting:
            data, sent, taken = waiting[0]
            time = self._time.at(sent)
            if time is None:
                if not is_last and now - taken < PATIENCE:
                    return
                time = self._time.before(sent)
            self._writer.write(recorded.channel, time, time, data)
            waiting.popleft()

    def _take_last(self) -> None:
        """Take what was sent until now, also what the middleware has to send again."""
        until, begun = time_ns(), monotonic_ns()
        is_reported = False
        self._take()
        while missing := self._may_miss(until):
            waited = monotonic_ns() - begun
            if waited > PATIENCE:
                break
            if waited > SECOND // 2 and not is_reported:
                limit = f'waits up to {PATIENCE // SECOND} s for the last messages of '
                print(limit + ', '.join(missing), flush=True)
                is_reported = True
            sleep(TAKE)
            self._take()
        self._take(is_last=True)

    def _may_miss(self, until: int) -> list[str]:
        """Return the topics of which messages that were sent before *until* may still arrive."""
        clock = ['/clock'] if self._misses_times() else []
        return clock + [
            topic
            for topic, one in self._recorded.items()
            if one.may_miss(until, STILL, PATIENCE) and self.count_publishers(topic)
        ]

    def _misses_times(self) -> bool:
        newest = self._time.newest
        last = max(
            (one.waiting[-1][1] for one in self._recorded.values() if one.waiting), default=0
        )
        return newest is not None and last > newest + STILL

    # Progress reports ----------------------------------------------------------------------

    def _report(self) -> None:
        elapsed = (monotonic_ns() - self._begun) * 1e-9
        counts = self._writer.counts
        missing = missing_topics(self._wanted, counts, *self._of_rigs)
        line = f'{elapsed:.0f} s, {sum(counts.values())} messages on {len(counts)} topics'
        if missing:
            line += ', without a publisher: ' + ', '.join(missing)
        if sys.stdout.isatty():
            print(f'\r\x1b[K{line}', end='', flush=True)
        else:
            print(line, flush=True)

    def finish(self) -> None:
        """Close the bag and print a summary of it."""
        if self._thread.is_alive():
            self._is_closing.set()
            self._thread.join()
        try:
            if self._problem:
                self._fail(self._problem)
            else:
                self._take_last()
            self._writer.close()
        except RecordingError as error:
            self._fail(error)
        if self._directory.is_dir():  # a bag that was deleted contains no messages
            self._summarise()

    def _fail(self, error: Exception) -> None:
        """Print once why the recording ends, and set the exit code for this reason."""
        if self.exit_code is None:
            print(f'pam_record: {str(error) or type(error).__name__}', file=sys.stderr)
            self.exit_code = BAD_INPUT if isinstance(error, RecordingError) else 1

    def _summarise(self) -> None:
        lines = [f'{self._directory}: {self._writer.duration:.2f} s']
        for topic, count in sorted(self._writer.counts.items()):
            lost = self._recorded[topic].lost
            note = f'  {lost} lost before they were received' if lost else ''
            lines.append(
                f'  {topic:<28} {count:>9} messages {self._writer.rate(topic):9.1f} Hz{note}'
            )
        for topic, is_requested in self._wanted.items():
            if topic not in self._writer.counts and is_requested:
                lines.append(f'  {topic:<28} was not published')
        if sys.stdout.isatty():
            print()
        print('\n'.join(lines), flush=True)


def _message_type(kind: str) -> Any:
    package, _, name = kind.split('/')
    try:
        return getattr(import_module(f'{package}.msg'), name)
    except (ImportError, AttributeError):
        return None
