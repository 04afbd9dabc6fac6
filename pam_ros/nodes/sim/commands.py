# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of the simulator's commands: of a single muscle, of all, and of each muscle."""

from collections.abc import Callable, Sequence

from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64, Float64MultiArray

from pam_ros.nodes.common.qos import DEPTH, open_qos
from pam_ros.settings.scene import SimulationSetup

# Takes pressures in Pa, and the numbers of the muscles that they command.
Take = Callable[[Sequence[float], Sequence[int]], None]


def subscribe_commands(
    node: Node, setup: SimulationSetup, take: Take
) -> Callable[[], frozenset[bytes]]:
    """Pass the commands on the topics of *setup* to *take*.

    Return a function that returns an identification of each node that publishes commands.
    """
    subscriptions = []
    muscles = range(len(setup.muscles))

    def subscribe(kind: type, topic: str, callback: Callable[..., None]) -> None:
        quality = QoSProfile(depth=DEPTH)
        subscription = node.create_subscription(
            kind, topic, callback, quality, qos_overriding_options=open_qos()
        )
        subscriptions.append(subscription)

    def of_muscle(muscle: int) -> Callable[[Float64], None]:
        only = (muscle,)
        return lambda message: take((message.data,), only)

    def of_all(message: Float64MultiArray) -> None:
        if len(message.data) == len(muscles):
            take(message.data.tolist(), muscles)
            return
        reason = f'{len(message.data)} values for {len(muscles)} muscles: not used'
        node.get_logger().warning(f'pressure_commands has {reason}', throttle_duration_sec=1.0)

    if setup.has_arrays:
        subscribe(Float64MultiArray, 'pressure_commands', of_all)
    for i, prefix in enumerate(setup.muscle_prefixes):
        subscribe(Float64, f'{prefix}pressure_command', of_muscle(i))

    def publishers() -> frozenset[bytes]:
        return frozenset(
            bytes(info.endpoint_gid)
            for subscription in subscriptions
            for info in node.get_publishers_info_by_topic(subscription.topic_name)
        )

    return publishers
