# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_plot``: receives the topics of a rig, and draws them."""

import argparse
import sys
from collections.abc import Mapping
from threading import Lock
from time import monotonic_ns, time_ns
from typing import Any

from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, Float64MultiArray

from pam_ros.errors import PamError, shown
from pam_ros.health.absence import Absence
from pam_ros.health.health import Level
from pam_ros.nodes.common.rclpy_internals import messages_of
from pam_ros.nodes.common.spin import BAD_INPUT, TickingNode
from pam_ros.nodes.common.taken import Taken, never
from pam_ros.plot.history import History
from pam_ros.plot.message_times import Arrived, MessageTimes
from pam_ros.plot.options import Options, add_arguments, checked
from pam_ros.plot.panels import panels
from pam_ros.plot.server import PageServer, Window, content
from pam_ros.plot.topics import TOPICS, muscles_of, numbers
from pam_ros.recording.bag.clocks import stamp_of
from pam_ros.recording.bag.topics import FLOAT64, FLOAT64_ARRAY, FLUID_PRESSURE, JOINT_STATE
from pam_ros.timing.pace import SECOND
from pam_ros.timing.ticker import Ticker

KINDS = {
    FLOAT64: Float64,
    FLOAT64_ARRAY: Float64MultiArray,
    FLUID_PRESSURE: FluidPressure,
    JOINT_STATE: JointState,
}
LOOK = 20.0  # Hz, at which messages are taken and missing ones are noticed
PATIENCE = 3.0  # s without a message after which the user is informed
KEPT = 200  # messages of a topic until they are taken: lost ones are not drawn


class PamPlot(TickingNode):
    """The node; its name is hidden, so that other programs do not count it as part of the rig."""

    has_parameters = False

    def __init__(self, options: Options) -> None:
        """Subscribe, and listen on the port of the page unless a PNG file is requested."""
        super().__init__('_pam_plot')
        self._options = options
        self._history = History(options.seconds)
        self._is_simulated = bool(self.get_parameter('use_sim_time').value)
        self._lock = Lock()  # of the following, which the page reads in other threads
        self._origin: int | None = None  # ns, of the first message
        self._latest = 0  # ns
        self._note = ''
        self._begun = self._received = monotonic_ns()
        self._has_drawn = False
        self._absence = Absence(self.get_logger(), 'receives messages', patience=PATIENCE)
        self._times = MessageTimes(is_simulated=self._is_simulated)
        self._clocks = Absence(
            self.get_logger(), 'messages have the time of their stamps', PATIENCE, Level.WARN
        )
        self._server = PageServer(self._look, options.port) if options.png is None else None
        # Best effort is compatible with every publisher, and none has to wait for this program.
        quality = QoSProfile(depth=KEPT, reliability=ReliabilityPolicy.BEST_EFFORT)
        group = Taken()
        self._subscribed: dict[str, Subscription] = {
            topic: self.create_subscription(
                KINDS[use.kind], topic, never, quality, callback_group=group
            )
            for topic, use in TOPICS.items()
        }
        self._clock_subscribed = self.create_subscription(
            Clock, '/clock', never, quality, callback_group=group
        )
        self.ticker = Ticker(LOOK)

    @classmethod
    def add_arguments(cls, parser: argparse.ArgumentParser) -> None:
        """Add the options of the command line."""
        add_arguments(parser)

    @classmethod
    def of_arguments(cls, arguments: argparse.Namespace) -> 'PamPlot':
        """Create the node with the options of the command line."""
        return cls(checked(arguments))

    def start(self) -> None:
        """Serve the page, and print its address."""
        super().start()
        self._begun = self._received = monotonic_ns()
        if self._server:
            self._server.start()
            print(f'open {self._server.address} in a browser; Ctrl-C ends it', flush=True)

    # What is received ----------------------------------------------------------------------

    def make_executor(self) -> Executor:
        """Return an executor that obeys callback groups: messages are taken with their times."""
        return SingleThreadedExecutor()

    def _take(self) -> None:
        """Take the messages that have arrived, and keep their numbers at their times."""
        for clock, info in messages_of(self._clock_subscribed):
            if not self.refuses_time(clock):
                self._times.tell(
                    info['source_timestamp'], clock.clock.sec * SECOND + clock.clock.nanosec
                )
        taken = [
            (Arrived(topic, stamp_of(message), *_sent_and_received(info)), message)
            for topic, subscription in self._subscribed.items()
            for message, info in messages_of(subscription)
        ]
        if not taken:
            return
        self._received = monotonic_ns()
        taken.sort(key=lambda one: one[0].sent)
        placed = self._times.of([one for one, _ in taken])
        if placed.begins_again:
            with self._lock:
                self._history.clear()
                self._origin = None
        for (one, message), time in zip(taken, placed.times, strict=True):
            if time is not None:
                self._keep(one.topic, message, time)

    def _keep(self, topic: str, message: Any, time: int) -> None:
        """Keep the numbers of a message of a *time* in ns."""
        with self._lock:
            if self._origin is None:
                self._origin = self._latest = time
            self._latest = max(self._latest, time)
            t = (time - self._origin) / SECOND
        self._history.name_muscles(muscles_of(topic, message))
        for key, value in numbers(topic, message):
            self._history.add(key, t, value)

    def tick(self) -> None:
        """Take messages; end if a PNG is complete, or if nothing was received in time."""
        self._take()
        now = monotonic_ns()
        has_time = not self._is_simulated or self.get_clock().now().nanoseconds > 0
        is_missing = self._received == self._begun or now - self._received > PATIENCE * SECOND
        missing = self._missing() if is_missing or not has_time else ''
        self._absence.look(missing, now / SECOND)
        self._clocks.look(self._times.note, now / SECOND, lasting=PATIENCE)
        with self._lock:
            is_late = now - self._received > PATIENCE * SECOND
            self._note = missing if is_late or not has_time else self._times.note
            origin = self._origin
        options = self._options
        if options.png is None:
            return
        if origin is None:
            if now - self._begun > options.wait * SECOND:
                self._fail(f'nothing was received for {options.wait:g} s: {self._missing()}')
        elif self._end() >= options.seconds:
            self._draw(0.0, options.seconds)

    def _missing(self) -> str:
        """Return a sentence on the reason why nothing can be drawn."""
        if self._is_simulated and self.get_clock().now().nanoseconds == 0:
            return 'use_sim_time is set, and nothing is published on /clock'
        other = []
        has_publisher = False
        for topic, use in TOPICS.items():
            for info in self.get_publishers_info_by_topic(self.resolve_topic_name(topic)):
                has_publisher = has_publisher or info.topic_type == use.kind
                if info.topic_type != use.kind:
                    name = self.resolve_topic_name(topic)
                    other.append(f'{name} is {info.topic_type}, not {use.kind}')
        if has_publisher:
            return 'no message is received, although topics of the rig have publishers'
        if other:
            return f'no topic of the rig has the type that is drawn: {", ".join(other)}'
        states = self.resolve_topic_name('joint_states')
        return (
            f'no node publishes {states} or another topic of a rig: start pam_sim or the rig, or '
            'give its namespace with --ros-args -r __ns:=/NAMESPACE'
        )

    # What is drawn -------------------------------------------------------------------------

    def _end(self) -> float:
        """Return the present time in s since the first message."""
        with self._lock:
            if self._origin is None:
                return 0.0
            now = self._latest
            if not self._times.has_own_clock:
                now = max(self.get_clock().now().nanoseconds, now)
            return (now - self._origin) / SECOND

    def _look(self, window: Window | None) -> dict[str, Any]:
        """Return the data that the page draws now, finer within a *window*."""
        now, span = self._end(), self._options.seconds
        drawn = panels(self._history.curves(now), self._options.unit, now)
        with self._lock:
            note = self._note
        start = max(now - span, 0.0)
        return content(drawn, start, start + span, now, note=note, window=window)

    def _draw(self, start: float, end: float) -> None:
        """Write the PNG file, and end."""
        # Not at the start of the node, since the import takes half a second.
        from pam_ros.plot.figure import figure, save

        png = self._options.png
        assert png is not None
        self._has_drawn = True
        self.exit_code = 0
        drawn = panels(self._history.curves(end), self._options.unit, end)
        if not drawn:
            self._fail(f'{png} is not written: no finite number was received')
            return
        try:
            save(figure(drawn, start, end), png)
        except PamError as error:
            self._fail(str(error))
            return
        print(shown(f'wrote {png}'), flush=True)

    def _fail(self, sentence: str) -> None:
        self.exit_code = BAD_INPUT
        print(f'pam_plot: {shown(sentence)}', file=sys.stderr)

    def finish(self) -> None:
        """Close the page, or draw the messages received until a signal requested the end."""
        if self._server:
            self._server.close()
        elif self.exit_code is None:
            if self._origin is None:
                self._fail(f'{self._options.png} is not written: nothing was received yet')
            else:
                self._draw(0.0, max(self._end(), 1e-3))


def _sent_and_received(info: Mapping[str, Any]) -> tuple[int, int]:
    """Return the system times in ns at which the middleware sent and received a message."""
    received = int(info['received_timestamp'] or time_ns())
    return int(info['source_timestamp'] or received), received
