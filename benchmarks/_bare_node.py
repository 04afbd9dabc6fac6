# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A minimal node that publishes the same messages as ``pam_sim``, and one that receives them.

``python -m benchmarks._bare_node timer|loop RATE`` publishes, with a timer of rclpy or in the same
loop as the nodes of this package; ``... listen SECONDS FILE`` records the arrival times.
"""

import gc
import sys
from time import monotonic_ns

import numpy as np
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pam_ros.processes.stop import StopRequest

SETTLE = 2_000_000_000  # ns from the first message to the first that counts


class BareNode(Node):
    """Publishes the messages of ``pam_sim`` with arbitrary values."""

    def __init__(self) -> None:
        super().__init__('bare')
        self._now = self.get_clock().now
        self._joint = JointState(name=['pam'], position=[0.0], velocity=[0.0], effort=[0.0])
        self._fluid = FluidPressure(header=self._joint.header)
        self._float = Float64()
        self._joints = self.create_publisher(JointState, 'joint_states', 10)
        self._pressures = self.create_publisher(FluidPressure, 'pressure', 10)
        names = ('force', 'stiffness', 'damping')
        self._floats = [self.create_publisher(Float64, name, 10) for name in names]

    def publish(self, number: int) -> None:
        """Publish each message once; the position is the *number* of the period."""
        self._joint.header.stamp = self._fluid.header.stamp = self._now().to_msg()
        self._joint.position[0] = number
        self._joints.publish(self._joint)
        self._fluid.fluid_pressure = 1e5
        self._pressures.publish(self._fluid)
        for publisher in self._floats:
            self._float.data = 1.0
            publisher.publish(self._float)


def publish(way: str, rate: float, stop: StopRequest) -> None:
    """Publish at *rate* Hz by the *way* 'timer' or 'loop' until *stop*."""
    node = BareNode()
    executor = EventsExecutor()
    executor.add_node(node)
    gc.collect()
    gc.freeze()
    period, start = round(1e9 / rate), monotonic_ns()
    if way == 'timer':
        node.create_timer(
            1.0 / rate,
            lambda: node.publish((monotonic_ns() - start) // period),
            clock=Clock(clock_type=ClockType.STEADY_TIME),
        )
        while not stop.is_made:
            executor.spin_once(timeout_sec=0.1)
        return
    number = 0
    while not stop.is_made:
        wait = start + number * period - monotonic_ns()
        if wait <= 0:
            node.publish(number)
            number += 1
            wait = max(start + number * period - monotonic_ns(), 0)
        executor.spin_once(timeout_sec=wait * 1e-9)


def listen(seconds: float, file: str, stop: StopRequest) -> None:
    """Record ``joint_states`` to *file*; print 'begin' and 'end' of the recorded time.

    Arrays (messages,): arrival in ns of the steady clock, stamp in ns, position.
    """
    node = Node('listener')
    arrival: list[int] = []
    stamp: list[int] = []
    position: list[float] = []

    def take(message: JointState) -> None:
        arrival.append(monotonic_ns())
        stamp.append(message.header.stamp.sec * 10**9 + message.header.stamp.nanosec)
        position.append(message.position[0])

    node.create_subscription(JointState, 'joint_states', take, 10)
    node.create_subscription(FluidPressure, 'pressure', lambda _: None, 10)
    for name in ('force', 'stiffness', 'damping'):
        node.create_subscription(Float64, name, lambda _: None, 10)
    executor = EventsExecutor()
    executor.add_node(node)
    gc.collect()
    gc.freeze()
    while not stop.is_made and (not arrival or arrival[-1] - arrival[0] < SETTLE):
        executor.spin_once(timeout_sec=0.1)
    for received in (arrival, stamp, position):
        received.clear()
    print('begin', flush=True)
    end = monotonic_ns() + round(seconds * 1e9)
    while not stop.is_made and monotonic_ns() < end:
        executor.spin_once(timeout_sec=0.1)
    print('end', flush=True)
    np.savez(file, arrival=arrival, stamp=stamp, position=position)


def main() -> None:
    """Publish or listen, as the command line requires."""
    stop = StopRequest()
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    if sys.argv[1] == 'listen':
        listen(float(sys.argv[2]), sys.argv[3], stop)
    else:
        publish(sys.argv[1], float(sys.argv[2]), stop)
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
