# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Run a node at a fixed rate until a stop is requested, and end it cleanly.

The loop waits in the executor for the time until the next tick and ticks itself: a timer of
rclpy skips the ticks that it is late for, and costs more (``benchmarks/node_rate.py``).
"""

import argparse
import gc
import os
import re
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable
from itertools import pairwise
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
from pam_ros.nodes.common.parameter_list import parameter_list
from pam_ros.nodes.common.rclpy_internals import EventsExecutor
from pam_ros.processes.ends import end_within
from pam_ros.processes.priority import NORMAL, prefer_real_time
from pam_ros.processes.prompt_end import end_promptly
from pam_ros.processes.stop import StopRequest
from pam_ros.settings.files import lacking
from pam_ros.timing.ticker import Ticker
from pam_ros.version import VERSION_HELP, VERSION_LINE

BAD_INPUT = 2
# s in which the client reads the response of a service that was stopped. A lost response is sent
# again after the heartbeat period of the middleware: 3 s, WriterTimes of Fast DDS.
LAST_ANSWER = 4.0
# s in which the middleware must shut down. It usually takes 0.1 s, but it may hang.
LEAVING = 20.0
# Options that ROS has after --ros-args.
FOR_ROS = {'-p', '--param', '-r', '--remap', '--params-file', '-e', '--enclave', '--log-level'}
LONGEST_WAIT = 0.1  # s in the executor, so that the node stops soon even if its ticks are slow

# What rclpy raises for an invalid command line. RuntimeError is raised for errors of rcl and for
# unknown policies in overrides of QoS.
REFUSALS = (PamError, NameValidationException, ParameterException, RuntimeError)


class TickingNode(Node, ABC):
    """A node that does its work in :meth:`tick`, at the rate of its ``ticker``.

    A node whose work is finished sets ``exit_code``; the others run until they are stopped. With
    ``keeps_wall_time`` a node has a higher priority than other programs if the system permits it.
    With ``has_answered_at_end`` it was stopped during a service, whose client reads the response.
    A node with ``has_parameters`` has parameters of its own, which ``--parameters`` lists.
    """

    ticker: Ticker
    exit_code: int | None = None
    keeps_wall_time = False
    has_answered_at_end = False
    has_parameters = True
    stop: StopRequest  # long tasks check it meanwhile
    scheduling = NORMAL

    @classmethod
    def add_arguments(cls, parser: argparse.ArgumentParser) -> None:
        """Add arguments of the command line that are not for ROS to *parser*: none."""

    @classmethod
    def of_arguments(cls, arguments: argparse.Namespace) -> 'TickingNode':
        """Return the node for the parsed *arguments*."""
        return cls()

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[[Any], None],
        *more: Any,
        **options: Any,
    ) -> Subscription:
        """Subscribe as any node does, but ignore times of ``/clock`` below 0.

        rclpy's own subscription to ``/clock`` is created here, too. Such a message would end the
        program, because a Time of rclpy cannot be negative.
        """
        if msg_type is not Clock:
            return super().create_subscription(msg_type, topic, callback, *more, **options)

        def not_negative(message: Clock) -> None:
            if not self.refuses_time(message):
                callback(message)

        return super().create_subscription(msg_type, topic, not_negative, *more, **options)

    def refuses_time(self, message: Clock) -> bool:
        """Return whether a time of ``/clock`` is below 0, with a warning the first time."""
        is_negative = bool(message.clock.sec < 0)
        if is_negative:
            self.get_logger().warning(
                f'/clock has a time of {message.clock.sec} s, which is not allowed: times below 0 '
                'are ignored',
                once=True,
            )
        return is_negative

    def make_executor(self) -> Executor:
        """Return the executor that serves the node: the one with the least overhead."""
        return EventsExecutor()

    def start(self) -> None:
        """Start the ticker: everything is ready, and the loop begins."""
        self.ticker.start(self.ticker.rate, monotonic_ns())

    def finish(self) -> None:
        """Do what is necessary before the node is destroyed: nothing."""

    @abstractmethod
    def tick(self) -> None:
        """Do the work of one period."""


def run(kind: type[TickingNode], stop: StopRequest, about: str) -> int:
    """Create a node of *kind* and run it until *stop* or its end; return the exit code.

    It is 0 after a stop, the node's own at its end, and 2, with a message on stderr, if the
    arguments (``--ros-args ...``) or the parameters are invalid.
    """
    node = None
    try:
        try:
            parser = _parser(kind, about)
            arguments = _parsed(parser)
            part = arguments.parameters if kind.has_parameters else None
            if part is not None:
                # Running programs must not take this node for another simulator or controller.
                os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'OFF'
            rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
            with end_promptly(0):  # kernels are compiled here, and nothing is commanded yet
                node = kind.of_arguments(arguments)
            node.stop = stop
            if part is not None:
                print(parameter_list(node, part))
                return 0
            if kind.has_parameters:
                _warn_of_unused_files(node)
        except REFUSALS as error:
            print(f'{parser.prog}: {sentence(error)}', file=sys.stderr)
            return BAD_INPUT
        executor = node.make_executor()
        executor.add_node(node)
        # Present objects are kept: a collection that checks them would take some 20 ms.
        gc.freeze()
        gc.enable()
        if node.keeps_wall_time:
            node.scheduling = prefer_real_time()
        node.start()
        spin(node, executor, stop)
        if node.has_answered_at_end:
            sleep(LAST_ANSWER)  # a response is lost if its server ends before it is read
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


def _parser(kind: type[TickingNode], about: str) -> argparse.ArgumentParser:
    """Return the parser of the arguments that are not for ROS; *about* is the text of the help."""
    parser = argparse.ArgumentParser(
        prog=Path(sys.argv[0]).stem,
        description=about,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog='Parameters and remappings follow --ros-args: see the manual of ROS 2.',
    )
    parser.add_argument('--version', action='version', version=VERSION_LINE, help=VERSION_HELP)
    if kind.has_parameters:
        parser.add_argument(
            '--parameters',
            nargs='?',
            const='',
            metavar='TEXT',
            help='print the parameters with TEXT in their names, or all, and end',
        )
    kind.add_arguments(parser)
    return parser


def _parsed(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """Parse the arguments that are not for ROS; an error has a hint at those that are."""
    arguments, unknown = parser.parse_known_args(remove_ros_args(sys.argv)[1:])
    if unknown:
        is_for_ros = not FOR_ROS.isdisjoint(unknown) or any(':=' in word for word in unknown)
        hint = ': parameters and remappings follow --ros-args' if is_for_ros else ''
        parser.error(f'unrecognized arguments: {" ".join(unknown)}{hint}')
    return arguments


def _warn_of_unused_files(node: TickingNode) -> None:
    """Warn of parameter files of the command line that have none for *node*: rcl does not."""
    files = [file for word, file in pairwise(sys.argv) if word == '--params-file']
    for file in files:
        if text := lacking(Path(file), node.get_fully_qualified_name()):
            node.get_logger().warning(shown(text))


def spin(node: TickingNode, executor: Executor, stop: StopRequest) -> None:
    """Call the node's tick, and the executor in between, until *stop* or the node's end."""
    ticker = node.ticker
    while not stop.is_made and node.exit_code is None:
        executor.spin_once(timeout_sec=min(tick_if_due(ticker, node.tick), LONGEST_WAIT))


def tick_if_due(ticker: Ticker, tick: Callable[[], None]) -> float:
    """Call *tick* if it is due, and return the time in s until the next one, at least 0."""
    now = monotonic_ns()
    wait = ticker.remaining(now)
    if wait > 0.0:
        return wait
    ticker.tick(now)
    tick()
    # Commands and services are served even if ticks are late.
    return max(ticker.remaining(monotonic_ns()), 0.0)


def sentence(error: Exception) -> str:
    """Return the text of an error in one line, without the positions in rcl's sources."""
    text = re.sub(r', at \S+\.c(pp)?:\d+', '', str(error))
    text = re.sub(
        r"^\['([^-].*:=.*)'\]$",
        r'\1 is not a ROS argument: give -p before a parameter, -r before a remapping',
        text,
    )
    text = re.sub(r"^\['(-.*)'\]$", r'unknown ROS arguments: \1', text)
    text = text.replace('failed to initialize rcl: ', '')
    is_secure = os.environ.get('ROS_SECURITY_ENABLE') == 'true'
    if text == 'error not set' and is_secure and not os.environ.get('ROS_SECURITY_KEYSTORE'):
        # rcl has no text for this.
        text = 'ROS_SECURITY_KEYSTORE is not set: give the folder of the keys, or no security'
    return shown(' '.join(text.split()))
