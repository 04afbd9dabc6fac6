# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The closed loop as ``ros2 launch`` starts it: it moves the load, and ends cleanly.

Run by the plugin that launch_testing brings pytest: ``colcon test`` or ``pytest test/launch``.
"""

import time
import unittest
from contextlib import ExitStack
from pathlib import Path

import launch_testing.actions
import pytest
import rclpy
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_testing.asserts import assertExitCodes
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from support.domain import claimed

FILE = Path(__file__).parents[2] / 'launch' / 'closed_loop.launch.py'
NAMESPACE = 'launched'
TARGET = 0.05  # m
CLOSE = 1e-4  # m
DOMAIN = ExitStack()  # until both programs have ended
DEADLINE = 120.0  # s: a first start compiles


@pytest.mark.launch_test
# launch leaves sockets of its loop to the garbage collection.
@pytest.mark.filterwarnings('ignore::pytest.PytestUnraisableExceptionWarning')
def generate_test_description():
    """Launch the loop in lockstep, in which it does not depend on the speed of the machine."""
    loop = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(str(FILE)),
        launch_arguments={'namespace': NAMESPACE, 'time_mode': 'lockstep'}.items(),
    )
    DOMAIN.enter_context(claimed())
    return LaunchDescription([loop, launch_testing.actions.ReadyToTest()])


class TestLoop(unittest.TestCase):
    """While both programs run."""

    def setUp(self):
        """Start a node, beside them."""
        rclpy.init()
        self.node = rclpy.create_node('watch')

    def tearDown(self):
        """End it."""
        self.node.destroy_node()
        rclpy.shutdown()

    def test_the_load_reaches_a_position(self):
        """Command it until it is there."""
        positions = []
        self.node.create_subscription(
            JointState,
            f'/{NAMESPACE}/joint_states',
            lambda message: positions.append(message.position[0]),
            10,
        )
        reference = self.node.create_publisher(Float64, f'/{NAMESPACE}/position_reference', 10)
        end = time.monotonic() + DEADLINE
        while not positions or abs(positions[-1] - TARGET) > CLOSE:
            assert time.monotonic() < end, f'the load is at {positions[-1:]} m'
            reference.publish(Float64(data=TARGET))
            rclpy.spin_once(self.node, timeout_sec=0.1)
        assert min(positions) < 0.0  # it began at rest without pressure


@launch_testing.post_shutdown_test()
class TestEnd(unittest.TestCase):
    """After launch has stopped both programs."""

    def test_both_end_cleanly(self, proc_info):
        """Both have exit code 0."""
        DOMAIN.close()
        assertExitCodes(proc_info)
