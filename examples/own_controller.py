# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Control the position of a muscle over topics with a custom controller: an integral law.

Start the simulator, then this program. In lockstep it waits for a command after each state:

    ros2 run pam_ros pam_sim --ros-args -p muscle:=dmsp_20_400n -p time_mode:=lockstep
    python3 own_controller.py
"""

import signal

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

GOAL = 0.06  # m of contraction, until a reference arrives
GAIN, PERIOD = 8e6, 0.002  # Pa per m and s; s between two states


class OwnController(Node):
    """Answers each state with one command."""

    def __init__(self):
        super().__init__('own_controller')
        self.goal, self.pressure, self.answered = GOAL, 0.0, None
        self.publisher = self.create_publisher(Float64, 'pressure_command', 10)
        self.create_subscription(Float64, 'position_reference', self.take_goal, 10)
        self.create_subscription(JointState, 'joint_states', self.control, 10)

    def take_goal(self, message):
        """Take a reference in m."""
        self.goal = message.data

    def control(self, state):
        """Integrate the error of a state, and publish the pressure in Pa."""
        if state.header.stamp == self.answered:
            return  # in lockstep a state may be published again
        self.answered = state.header.stamp
        error = self.goal - state.position[0]
        self.pressure = min(max(self.pressure + GAIN * PERIOD * error, 0.0), 600e3)
        self.publisher.publish(Float64(data=self.pressure))


signals = []  # received signals that end the program: Ctrl-C, SIGTERM
for kind in (signal.SIGINT, signal.SIGTERM):
    signal.signal(kind, lambda number, frame: signals.append(number))
rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = OwnController()
executor = SingleThreadedExecutor()
executor.add_node(node)
while not signals:
    executor.spin_once(timeout_sec=0.1)
print(f'last command: {node.pressure / 1e3:.1f} kPa')
executor.shutdown()
node.destroy_node()
rclpy.try_shutdown()
