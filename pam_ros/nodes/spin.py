# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Run a node with a fixed rate until it is asked to stop, and leave cleanly.

The loop waits in the executor for the time until the next tick and ticks itself: a timer of
rclpy would skip the ticks that it is late for and costs half as much again.
"""

import gc
import re
import signal
import sys
from collections.abc import Callable
from time import monotonic_ns
from types import FrameType
from typing import Protocol

import rclpy
import rclpy.exceptions
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from pam_ros.errors import PamError
from pam_ros.nodes.ticker import Ticker

try:
    from rclpy.experimental import EventsExecutor
except ImportError:  # before Jazzy's patch release of 2025
    EventsExecutor = SingleThreadedExecutor

BAD_INPUT = 2
LONGEST_WAIT = 0.1  # s in the executor, so that a stop is heeded whatever the rate


class TickingNode(Protocol):
    """A node that does its work at the rate of its ticker."""

    ticker: Ticker

    def tick(self) -> None:
        """Do the work of one period."""

    def destroy_node(self) -> None:
        """Release what the node holds."""


class StopRequest:
    """Ctrl-C and SIGTERM, taken note of instead of raised: a second one does no harm."""

    def __init__(self) -> None:
        """Take over both signals."""
        self.is_made = False
        for kind in (signal.SIGINT, signal.SIGTERM):
            signal.signal(kind, self._note)

    def _note(self, kind: int, frame: FrameType | None) -> None:
        self.is_made = True


def run(make: Callable[[], TickingNode]) -> int:
    """Make a node and run it; return the exit code.

    0 after Ctrl-C or SIGTERM; 2, with the sentence on stderr, when arguments or parameters make
    no node. Arguments are those of the command line (``--ros-args ...``).
    """
    stop = StopRequest()
    node = None
    try:
        try:
            rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
            node = make()
        except (PamError, *_ROS_REFUSALS) as error:
            print(f'{_program()}: {sentence(error)}', file=sys.stderr)
            return BAD_INPUT
        executor = EventsExecutor()
        executor.add_node(node)
        # What is there now stays: a collection over it would cost the loop some 20 ms.
        gc.collect()
        gc.freeze()
        spin(node, executor, stop)
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


def spin(node: TickingNode, executor: Executor, stop: StopRequest) -> None:
    """Tick the node at its rate and let the executor work in between, until *stop*."""
    ticker = node.ticker
    while not stop.is_made:
        now = monotonic_ns()
        wait = ticker.remaining(now)
        if wait <= 0.0:
            ticker.tick(now)
            node.tick()
            # However late the ticks are, commands and services get their turn.
            wait = max(ticker.remaining(monotonic_ns()), 0.0)
        executor.spin_once(timeout_sec=min(wait, LONGEST_WAIT))


# What rclpy raises for command lines, names and parameters.
_ROS_REFUSALS = (
    rclpy.exceptions.NameValidationException,
    rclpy.exceptions.ParameterException,
    RuntimeError,  # RCLError of bad arguments and files, and overrides of QoS that do not exist
)


def sentence(error: Exception) -> str:
    """Return the text of an error without rcl's places in its sources."""
    text = re.sub(r', at \S+\.c(pp)?:\d+', '', str(error))
    text = text.replace('failed to initialize rcl: ', '')
    return ' '.join(text.split())


def _program() -> str:
    return sys.argv[0].rsplit('/', 1)[-1]
