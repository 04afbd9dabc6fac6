# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of the simulator's commands: of a single muscle, of all, and of each muscle."""

from collections.abc import Callable
from functools import partial

from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64, Float64MultiArray

from pam_ros.nodes.common.qos import DEPTH, open_qos
from pam_ros.nodes.sim.lockstep import Turns
from pam_ros.settings.scene import SimulationSetup


def subscribe_commands(
    node: Node,
    setup: SimulationSetup,
    turns: Turns,
    take: Callable[[int, Float64], None],
    take_all: Callable[[Float64MultiArray], None],
) -> None:
    """Pass the commands of each muscle to *take*, and arrays for all muscles to *take_all*.

    *turns* watches which nodes send commands.
    """

    def subscribe(kind: type, topic: str, callback: Callable[..., None]) -> None:
        quality = QoSProfile(depth=DEPTH)
        subscription = node.create_subscription(
            kind, topic, callback, quality, qos_overriding_options=open_qos()
        )
        turns.watch(subscription)

    if setup.is_one:
        subscribe(Float64, 'pressure_command', partial(take, 0))
        return
    subscribe(Float64MultiArray, 'pressure_commands', take_all)
    if setup.settings.muscle_topics:
        for i, name in enumerate(setup.muscle_names):
            subscribe(Float64, f'{name}/pressure_command', partial(take, i))
