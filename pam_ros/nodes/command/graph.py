# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is there: nodes, their topics and services; and waiting for it."""

import os
import sys
from collections.abc import Callable, Generator
from time import monotonic
from typing import Any, TypeVar

from rclpy.node import Node

from pam_ros.command.absence import AbsentError, absent, in_another_namespace
from pam_ros.command.options import Options
from pam_ros.errors import shown

T = TypeVar('T')
# Steps of an action, between which other programs are heard. Each tells whether a stop that is
# requested now is the regular end of the action.
Steps = Generator[bool, None, T]

NOTED = 1.0  # s of waiting after which the user is told
SETTLED = 0.5  # s without a change of the nodes, after which those of one program are all found
# s after which all programs are found: Fast DDS repeats each 3 s that a program is there, and what
# it says at the start of another program does not always arrive.
SURVEYED = 3.2
UNKNOWN = '_NODE_NAME'  # start of the name that rmw gives to a node it has not discovered yet
OBSERVERS = ('pam_record', 'rosbag2_recorder')  # subscribe to commands, and move nothing


class Graph:
    """The nodes that *node* finds, within the patience of the *options*."""

    def __init__(self, node: Node, options: Options) -> None:
        """See nothing yet: discovery takes some tenths of a second."""
        self._node, self.wait = node, options.wait
        self._begun = monotonic()
        self.space = node.get_namespace().rstrip('/')

    # Waiting -------------------------------------------------------------------------------

    def until(self, condition: Callable[[], T], what: str, missing: Callable[[], str]) -> Steps[T]:
        """Wait for *what*, until *condition* returns a true value, and return this value.

        Raises AbsentError with the sentence *missing*() after the patience of the user.
        """
        begun, is_noted = monotonic(), False
        while not (found := condition()):
            waited = monotonic() - begun
            if waited > self.wait:
                raise AbsentError(missing())
            if waited > NOTED and not is_noted:
                is_noted = True
                say(f'waits up to {self.wait:g} s for {what}')
            yield False
        return found

    def settle(self) -> Steps[None]:
        """Wait until no further node was found for some time: nodes are found in parts."""
        nodes, since = self.nodes(), monotonic()
        while monotonic() - since < SETTLED:
            yield False
            if (now := self.nodes()) != nodes:
                nodes, since = now, monotonic()

    def survey(self) -> Steps[None]:
        """Wait until all nodes are found, as far as the patience of the user permits."""
        while monotonic() - self._begun < min(SURVEYED, self.wait):
            yield False
        yield from self.settle()

    def during(self, seconds: float) -> Steps[None]:
        """Hear other programs for this time."""
        end = monotonic() + seconds
        while monotonic() < end:
            yield False

    # What is there -------------------------------------------------------------------------

    def nodes(self) -> list[str]:
        """Return the full names of all other nodes that are not hidden."""
        found = {
            f'{space.rstrip("/")}/{name}'
            for name, space in self._node.get_node_names_and_namespaces()
            if not name.startswith('_')
        }
        return sorted(found)

    def expanded(self, node: str) -> str:
        """Return the full name of a node that a user has named."""
        return node if node.startswith('/') else f'{self.space}/{node}'

    def services(self) -> dict[str, str]:
        """Return the type of each service of a node that is not hidden, by its full name."""
        return {
            name: kinds[0]
            for name, kinds in self._node.get_service_names_and_types()
            if not name.rpartition('/')[0].rpartition('/')[2].startswith('_')
        }

    def receivers(self, topic: str, kind: str) -> list[str]:
        """Return the nodes that subscribe to *topic* with the type *kind* and can use it."""
        infos = self._node.get_subscriptions_info_by_topic(topic)
        return [
            _full_name(info)
            for info in infos
            if info.topic_type == kind
            and not info.node_name.startswith('_')
            and info.node_name not in OBSERVERS
        ]

    def senders(self, topic: str) -> list[str]:
        """Return the other nodes that publish *topic*."""
        infos = self._node.get_publishers_info_by_topic(topic)
        names = [_full_name(info) for info in infos if not info.node_name.startswith(UNKNOWN)]
        own = self._node.get_fully_qualified_name()
        if own in names:
            names.remove(own)
        return names

    def endpoints(self, topic: str) -> int:
        """Return the number of subscriptions to *topic*."""
        return int(self._node.count_subscribers(topic))

    def missing_topic(self, topics: list[str], kind: str) -> str:
        """Return the sentence on *topics* to which no node subscribes that can use them."""
        other = [
            f'{topic} is {info.topic_type}, not {kind}'
            for topic in topics
            for info in self._node.get_subscriptions_info_by_topic(topic)
            if info.topic_type != kind
        ]
        names = ' or '.join(topics)
        text = f'no node of a rig subscribes to {names}' + (f' ({other[0]})' if other else '')
        known = [name for name, _ in self._node.get_topic_names_and_types()]
        elsewhere = [name for name in known if name.rpartition('/')[0] != self.space]
        heard = [name for name in elsewhere if self._node.count_subscribers(name)]
        return self.missing(text, in_another_namespace(topics[0], heard))

    def missing_node(self, text: str, wanted: str) -> str:
        """Return the sentence on the node *wanted*, with one of its name elsewhere."""
        return self.missing(text, in_another_namespace(wanted, self.nodes()))

    def missing(self, text: str, alike: str = '') -> str:
        """Return the sentence on what is missing, with what was found instead."""
        domain = os.environ.get('ROS_DOMAIN_ID') or '0'
        return absent(text, self.wait, self.nodes(), domain, alike)


def _full_name(info: Any) -> str:
    return f'{info.node_namespace.rstrip("/")}/{info.node_name}'


def say(sentence: str) -> None:
    """Tell the user something that is not the result."""
    print(f'pam_command: {shown(sentence)}', file=sys.stderr, flush=True)
