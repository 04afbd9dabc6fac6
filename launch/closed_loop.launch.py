# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Start a closed loop: ``ros2 launch pam_ros closed_loop.launch.py mass:=10.0``.

With ``joint:=antagonistic`` two antagonistic muscles turn a pulley.
"""

import sys

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from pam_ros.settings.launch import (
    ARGUMENTS,
    JointEnd,
    controller,
    is_started,
    refuse_unknown,
    simulator,
)

NAMES = (
    *('muscle', 'joint', 'mass', 'params'),
    *('publish_rate', 'rate', 'time_mode', 'use_sim_time', 'namespace'),
)


def start(context: LaunchContext) -> list[Node]:
    """Return both nodes; values of the command line override the files."""
    refuse_unknown(__file__, NAMES, sys.argv)
    given = {name: LaunchConfiguration(name).perform(context) for name in NAMES}
    # A launch file that includes this one decides itself what happens when a program dies.
    is_own = is_started(__file__, sys.argv)
    on_exit = JointEnd(2, lambda reason: Shutdown(reason=reason)) if is_own else None
    return [
        Node(
            package='pam_ros',
            executable='pam_sim',
            namespace=given['namespace'],
            parameters=simulator(given),
            output='screen',
            emulate_tty=True,
            on_exit=on_exit,
        ),
        Node(
            package='pam_ros',
            executable='pam_control',
            namespace=given['namespace'],
            parameters=controller(given),
            output='screen',
            emulate_tty=True,
            on_exit=on_exit,
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the arguments and the nodes."""
    arguments = [DeclareLaunchArgument(name, **ARGUMENTS[name].declared) for name in NAMES]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
