# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Send a reference to a controller, and find out whether it refuses it."""

from collections.abc import Callable
from time import time_ns
from typing import Any

from rcl_interfaces.msg import Log
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Float64

from pam_ros.command.amounts import Amount
from pam_ros.command.options import STIFFNESS, Options
from pam_ros.command.rig import checked_position, unit_of
from pam_ros.errors import PamError, shown
from pam_ros.nodes.command.graph import Graph, Steps, say
from pam_ros.nodes.command.requests import all_values
from pam_ros.recording.bag.topics import FLOAT64
from pam_ros.timing.pace import SECOND

AT_ONCE = Duration()
LOGGED = 0.3  # s in which a line of the log arrives that was written before an answer of the node
LOG_DEPTH = 1000  # lines that each node keeps for late subscribers
# How the lines begin with which pam_control refuses a reference.
REFUSALS = ('reference ', 'position_reference ', 'co_contraction_reference ', 'co-contraction ')
CONTROLS = 'state_timeout'  # a parameter that a controller of this package has


def send_position(node: Node, graph: Graph, options: Options) -> Steps[None]:
    """Send the position reference."""
    amount = _amount(options)
    topic = node.resolve_topic_name('position_reference')
    receiver, values = yield from _controller(node, graph, topic)
    unit = unit_of(values) if CONTROLS in values else ''
    position = checked_position(amount, unit, receiver)
    yield from _send(node, graph, topic, receiver, position, unit or amount.unit, amount)


def send_stiffness(node: Node, graph: Graph, options: Options) -> Steps[None]:
    """Send the desired stiffness of a joint."""
    amount = _amount(options)
    topic = node.resolve_topic_name('co_contraction_reference')
    receiver, _ = yield from _controller(node, graph, topic)
    yield from _send(node, graph, topic, receiver, amount.value, STIFFNESS, amount)


def _amount(options: Options) -> Amount:
    assert options.amount is not None
    return options.amount


def _controller(node: Node, graph: Graph, topic: str) -> Steps[tuple[str, dict[str, Any]]]:
    """Return the node that receives *topic*, and its parameters; one of this package first."""
    yield from graph.until(
        lambda: graph.receivers(topic, FLOAT64),
        f'a subscriber of {topic}',
        lambda: graph.missing_topic([topic], FLOAT64),
    )
    yield from graph.settle()
    found: dict[str, dict[str, Any]] = {}
    for one in graph.receivers(topic, FLOAT64):
        found[one] = yield from all_values(node, graph, one)
    if not found:
        raise PamError(f'the node that subscribed to {topic} has ended')
    return min(found.items(), key=lambda item: CONTROLS not in item[1])


def _send(
    node: Node,
    graph: Graph,
    topic: str,
    receiver: str,
    value: float,
    unit: str,
    amount: Amount,
) -> Steps[None]:
    others = graph.senders(topic)
    if others:
        say(f'warning: {" and ".join(others)} publishes {topic} as well: the newest value counts')
    lines: list[Log] = []
    kept = QoSProfile(depth=LOG_DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    log = node.create_subscription(Log, '/rosout', lines.append, kept)
    publisher = node.create_publisher(Float64, topic, 10)
    yield from matched(graph, topic, publisher)
    sent = time_ns()
    publisher.publish(Float64(data=value))
    yield from acknowledged(graph, topic, publisher)
    # The node answers after it has taken the reference, and has logged its refusal by then.
    yield from all_values(node, graph, receiver)
    yield from graph.during(LOGGED)
    node.destroy_subscription(log)
    name = receiver.strip('/').replace('/', '.')
    refusals = [
        line.msg
        for line in lines
        if line.name == name
        and line.stamp.sec * SECOND + line.stamp.nanosec >= sent
        and line.msg.startswith(REFUSALS)
    ]
    if refusals:
        hint = '' if amount.unit else f' (a number without a unit is in {unit or "m or rad"})'
        raise PamError(f'{receiver} refuses it: {refusals[0]}{hint}')
    print(shown(f'{receiver} received {value:g} {unit}'.rstrip() + f' on {topic}'))


def matched(graph: Graph, topic: str, publisher: Publisher) -> Steps[None]:
    """Wait until *publisher* is connected with all subscriptions to *topic*."""
    yield from graph.until(
        lambda: publisher.get_subscription_count() >= max(1, graph.endpoints(topic)),
        f'the connection to {topic}',
        lambda: f'no connection to all subscribers of {topic} after {graph.wait:g} s',
    )


def acknowledged(
    graph: Graph, topic: str, publisher: Publisher, again: Callable[[], None] | None = None
) -> Steps[None]:
    """Wait until all reliable subscribers have received what was published.

    Until then, *again* is called in each step, to publish it again.
    """

    def is_received() -> bool:
        is_so = bool(publisher.wait_for_all_acked(AT_ONCE))
        if not is_so and again is not None:
            again()
        return is_so

    yield from graph.until(
        is_received,
        f'the receipt of a message on {topic}',
        lambda: f'a subscriber of {topic} has not acknowledged the message: does it still run?',
    )
