# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The parts of rclpy outside its public interface that this package uses: all are here.

Each function states why the public interface is not sufficient. Tried with rclpy 7.1.6 (Jazzy) and
9.1.2 (Kilted); with a version that changes one of these parts, ``test_rclpy_internals.py`` fails.
"""

from collections.abc import Iterator, Sequence
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.subscription import Subscription

try:
    # Experimental, but no other executor has as little overhead.
    from rclpy.experimental import EventsExecutor
except ImportError:  # Jazzy before its patch release of 2025
    EventsExecutor = SingleThreadedExecutor

__all__ = ['EventsExecutor', 'declare_texts', 'messages_of', 'overrides_of']


def overrides_of(node: Node) -> dict[str, Any]:
    """Return the values that *node* was started with, by the names that were given.

    The public interface returns a value only after a parameter of its name has been declared. An
    empty list has no type in YAML and arrives as not set; no other value arrives like this.
    """
    overrides = node._parameter_overrides.items()
    return {name: [] if p.value is None else p.value for name, p in overrides}


def declare_texts(
    node: Node, name: str, texts: Sequence[str], descriptor: ParameterDescriptor
) -> None:
    """Declare an array of strings, which may be empty, on *node*; *descriptor* gets the type.

    ``declare_parameter`` finds no type in an empty list.
    """
    kind = Parameter.Type.STRING_ARRAY
    descriptor.type = kind.value
    node._declare_parameter_common([Parameter(name, kind, list(texts))], {name: descriptor})


def messages_of(subscription: Subscription) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Yield all messages that have arrived, each with the information of the middleware.

    This is the time of sending, the time of receipt and the sequence number. The executors of this
    package do not pass it to a callback, and each callback would cost a control loop time.
    """
    handle = subscription.handle
    with handle:
        while taken := handle.take_message(subscription.msg_type, subscription.raw):
            yield taken
