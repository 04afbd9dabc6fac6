# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quality of service of the package's topics, which a user may override."""

from math import ceil

from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

DEPTH = 10
# s of states that a simulator can send again. After a delay it publishes up to half a second of
# states at once. This is more than the shared memory of the middleware holds until a recorder
# takes them, which is delayed, too. Sending them again takes up to another second
# (benchmarks.soak).
KEPT = 2.0
# Messages that each program can send again if time is simulated. It can pass faster than wall
# time: then some thousands are published while a recorder is delayed for a second.
KEPT_SIMULATED = 5000


def states_depth(rate: float, *, is_simulated: bool) -> int:
    """Return how many states a simulator keeps that publishes them at *rate* in Hz.

    *is_simulated* means that it generates the time itself.
    """
    return max(KEPT_SIMULATED if is_simulated else DEPTH, ceil(KEPT * rate))


def answers_depth(node: Node) -> int:
    """Return how many messages *node* keeps that it publishes in answer to states."""
    return KEPT_SIMULATED if node.get_parameter('use_sim_time').value else DEPTH


def states_reliability(*, are_answered: bool) -> ReliabilityPolicy:
    """Return how to subscribe to the states of a rig.

    *are_answered* means that time follows the states, each of which is answered.
    """
    # If time follows the states, it would stop at a lost state. A rig in real time publishes the
    # next one soon, reliably or not: best effort receives from both kinds of publishers.
    return ReliabilityPolicy.RELIABLE if are_answered else ReliabilityPolicy.BEST_EFFORT


def open_qos() -> QoSOverridingOptions:
    """Let a user change history, depth and reliability by ``qos_overrides`` parameters."""
    return QoSOverridingOptions.with_default_policies()
