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
from time import monotonic_ns
from typing import Any

from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock

from pam_ros.errors import RecordingError, shown
from pam_ros.health.absence import Absence
from pam_ros.nodes.common.spin import BAD_INPUT, TickingNode
from pam_ros.nodes.common.taken import Taken, never
from pam_ros.nodes.record.intake import TAKE, MessageIntake
from pam_ros.nodes.record.message_text import message_text
from pam_ros.nodes.record.qos import matching, metadata
from pam_ros.recording.bag.metadata import BagTopic
from pam_ros.recording.bag.writer import BagWriter
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
        self._intake = MessageIntake(
            self._writer,
            lambda: self.get_clock().now().nanoseconds,
            self.refuses_time,
            is_simulated=bool(self.get_parameter('use_sim_time').value),
        )
        self._refused: set[str] = set()
        self._group = Taken()
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
        if self._intake.needs_clock:
            clocks = self.get_publishers_info_by_topic('/clock')
            if clocks:
                self._intake.follow(self._subscribe(Clock, '/clock', clocks, raw=False))
        for topic in self._wanted:
            publishers = self.get_publishers_info_by_topic(topic)
            if publishers and topic not in self._intake and topic not in self._refused:
                self._add(topic, kinds.get(topic, []), publishers)
            if topic in self._intake:
                self._intake.count_publishers(topic, len(publishers))
        is_alone = not (self._intake or self._refused)
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
        self._intake.add(described, self._subscribe(message_type, topic, publishers))

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

    def _work(self) -> None:
        """Take and write messages until the node closes or an error occurs."""
        sealed = monotonic_ns()
        try:
            while not self._is_closing.is_set():
                self._is_closing.wait(TAKE)
                self._intake.take()
                if monotonic_ns() - sealed > SEAL * 1e9:
                    self._intake.seal()
                    sealed = monotonic_ns()
        except Exception as error:  # any error ends the recording and is reported
            self._problem = error

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
                self._intake.take_last(self.count_publishers)
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
            lost = self._intake.lost(topic)
            note = f'  {lost} lost before they were received' if lost else ''
            note = note if count else '  no message was received'
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
