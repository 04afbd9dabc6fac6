# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Run a node at a fixed rate until it is asked to stop, and leave cleanly.

The loop waits in the executor for the time until the next tick and ticks itself: a timer of
rclpy skips the ticks that it is late for, and costs more (``benchmarks/node_rate.py``).
"""

import argparse
import gc
import re
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from time import monotonic_ns, sleep
from typing import Any

import rclpy
from rclpy.exceptions import NameValidationException, ParameterException
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.subscription import Subscription
from rclpy.utilities import remove_ros_args
from rosgraph_msgs.msg import Clock

from pam_ros.errors import PamError, shown
from pam_ros.nodes.common.rclpy_internals import EventsExecutor
from pam_ros.processes.ends import end_within
from pam_ros.processes.priority import NORMAL, prefer_real_time
from pam_ros.processes.stop import StopRequest
from pam_ros.timing.ticker import Ticker
from pam_ros.version import VERSION_HELP, VERSION_LINE

BAD_INPUT = 2
# s in which the answer of a service that was told to stop is read. One that is lost among the
# states is sent again after the heartbeat of the middleware: 3 s, WriterTimes of Fast DDS.
LAST_ANSWER = 4.0
# s in which the middleware must be left, which takes some 0.1 s: it may hang, at any end.
LEAVING = 20.0
LONGEST_WAIT = 0.1  # s in the executor, so that a stop is heeded whatever the rate

# What rclpy raises for a command line that makes no node; RuntimeError is what rcl's own errors
# and unknown policies in overrides of QoS come as.
REFUSALS = (PamError, NameValidationException, ParameterException, RuntimeError)


class TickingNode(Node, ABC):
    """A node that does its work in :meth:`tick`, at the rate of its ``ticker``.

    A node whose work comes to an end sets ``exit_code``; the others run until they are stopped.
    One that ``keeps_wall_time`` runs before other programs where the system permits it. One that
    ``has_answered_at_end`` was told to stop while a service worked, whose client reads the answer.
    """

    ticker: Ticker
    exit_code: int | None = None
    keeps_wall_time = False
    has_answered_at_end = False
    stop: StopRequest  # what takes long asks it meanwhile
    scheduling = NORMAL

    @classmethod
    def add_arguments(cls, parser: argparse.ArgumentParser) -> None:
        """Add the arguments of the command line beside those for ROS to *parser*: none."""

    @classmethod
    def of_arguments(cls, arguments: argparse.Namespace) -> 'TickingNode':
        """Make the node of the parsed *arguments*."""
        return cls()

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[[Any], None],
        *more: Any,
        **options: Any,
    ) -> Subscription:
        """Subscribe as any node does, but leave out times of ``/clock`` below 0.

        rclpy's own subscription to ``/clock`` is made here as well, and would end the program: a
        Time of rclpy cannot be negative.
        """
        if msg_type is not Clock:
            return super().create_subscription(msg_type, topic, callback, *more, **options)

        def not_negative(message: Clock) -> None:
            if not self.refuses_time(message):
                callback(message)

        return super().create_subscription(msg_type, topic, not_negative, *more, **options)

    def refuses_time(self, message: Clock) -> bool:
        """Return whether a message of ``/clock`` is below 0; the first is warned of."""
        is_negative = bool(message.clock.sec < 0)
        if is_negative:
            self.get_logger().warning(
                f'/clock has a time of {message.clock.sec} s, which is not allowed: times below 0 '
                'are left out',
                once=True,
            )
        return is_negative

    def make_executor(self) -> Executor:
        """Return the executor that serves the node: the lightest there is."""
        return EventsExecutor()

    def start(self) -> None:
        """Begin to count time: all is there and the loop starts."""
        self.ticker.start(self.ticker.rate, monotonic_ns())

    def finish(self) -> None:
        """Do what is left to do before the node is destroyed: nothing."""

    @abstractmethod
    def tick(self) -> None:
        """Do the work of one period."""


def run(kind: type[TickingNode], stop: StopRequest, about: str) -> int:
    """Make a node of *kind* and run it until *stop* or its end; return the exit code.

    0 after a stop, the node's own at its end; 2, with the sentence on stderr, when the arguments
    (``--ros-args ...``) or the parameters make no node.
    """
    node = None
    try:
        try:
            parser = argparse.ArgumentParser(
                prog=Path(sys.argv[0]).stem,
                description=about,
                formatter_class=argparse.RawDescriptionHelpFormatter,
                epilog='All else is given with --ros-args: see the manual of ROS 2.',
            )
            parser.add_argument(
                '--version', action='version', version=VERSION_LINE, help=VERSION_HELP
            )
            kind.add_arguments(parser)
            arguments = parser.parse_args(remove_ros_args(sys.argv)[1:])
            rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
            node = kind.of_arguments(arguments)
            node.stop = stop
        except REFUSALS as error:
            print(f'{parser.prog}: {sentence(error)}', file=sys.stderr)
            return BAD_INPUT
        executor = node.make_executor()
        executor.add_node(node)
        # What is there now stays: a collection over it would cost the loop some 20 ms.
        gc.freeze()
        gc.enable()
        if node.keeps_wall_time:
            node.scheduling = prefer_real_time()
        node.start()
        spin(node, executor, stop)
        if node.has_answered_at_end:
            sleep(LAST_ANSWER)  # an answer is lost with the server that sent it
    finally:
        try:
            if node is not None:
                node.finish()
        finally:
            end_within(LEAVING)
            if node is not None:
                node.destroy_node()
            rclpy.try_shutdown()
    return node.exit_code or 0


def spin(node: TickingNode, executor: Executor, stop: StopRequest) -> None:
    """Tick the node and let the executor work in between, until *stop* or the node's end."""
    ticker = node.ticker
    while not stop.is_made and node.exit_code is None:
        now = monotonic_ns()
        wait = ticker.remaining(now)
        if wait <= 0.0:
            ticker.tick(now)
            node.tick()
            # However late the ticks are, commands and services get their turn.
            wait = max(ticker.remaining(monotonic_ns()), 0.0)
        executor.spin_once(timeout_sec=min(wait, LONGEST_WAIT))


def sentence(error: Exception) -> str:
    """Return the text of an error in one line, without rcl's places in its sources."""
    text = re.sub(r', at \S+\.c(pp)?:\d+', '', str(error))
    text = re.sub(
        r"^\['([^-].*:=.*)'\]$",
        r'\1 is not a ROS argument: give -p before a parameter, -r before a remapping',
        text,
    )
    text = re.sub(r"^\['(-.*)'\]$", r'unknown ROS arguments: \1', text)
    text = text.replace('failed to initialize rcl: ', '')
    return shown(' '.join(text.split()))
