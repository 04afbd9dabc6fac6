# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A controller under test, as small as one can be: a process of its own that follows a sine.

``python example_controller.py SECONDS FILE`` answers each new state of ``joint_states`` with one
``pressure_command``, for SECONDS of the states' stamps, and then writes to FILE (.npz) what it
saw: ``t`` (s), ``reference`` and ``position`` (m), ``pressure`` (Pa).
"""

import math
import sys
from time import perf_counter

import numpy as np
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from pam_ros.muscle.muscle import Muscle

MASS, GRAVITY = 20.0, 9.80665
MIDDLE, SWING, FREQUENCY = 0.05, 0.02, 0.5  # m, m, Hz: the reference
PROPORTIONAL, INTEGRAL = 4e6, 2e7  # Pa/m, Pa/(m s)


class ExampleController(Node):
    """Feeds the muscle's own model forward, and the error back."""

    def __init__(self, seconds: float) -> None:
        """Answer until *seconds* have passed by the stamps."""
        super().__init__('example_controller')
        self._muscle, self._seconds = Muscle(), seconds
        self._start = self._last = 0
        self._integral = 0.0  # m s
        self._said = Float64()
        self.rows: list[tuple[float, float, float, float]] = []
        self.began = self.ended = 0.0
        self._command = self.create_publisher(Float64, 'pressure_command', 10)
        self.create_subscription(JointState, 'joint_states', self._answer, 10)

    def _answer(self, state: JointState) -> None:
        stamp = state.header.stamp.sec * 10**9 + state.header.stamp.nanosec
        if self.ended:
            return
        if stamp == self._last:  # published again, before the answer arrived
            self._command.publish(self._said)
            return
        if len(self.rows) == 1:
            self.began = perf_counter()  # both programs are there
        self._start = self._start or stamp
        dt = (stamp - self._last) * 1e-9 if self._last else 0.0
        self._last = stamp
        t, position = (stamp - self._start) * 1e-9, state.position[0]
        turn = 2.0 * math.pi * FREQUENCY
        # The sine begins slowly, from where it is at rest in the middle.
        share = min(t / 2.0, 1.0)
        reference = MIDDLE + share * SWING * math.sin(turn * t)
        acceleration = -share * SWING * turn**2 * math.sin(turn * t)
        error = reference - position
        self._integral += error * dt
        pressure = self._feed_forward(reference, acceleration)
        pressure += PROPORTIONAL * error + INTEGRAL * self._integral
        pressure = min(max(pressure, self._muscle.p_min), self._muscle.p_max)
        self.rows.append((t, reference, position, pressure))
        if t >= self._seconds:
            self.ended = perf_counter()
        else:
            self._said.data = pressure
            self._command.publish(self._said)

    def _feed_forward(self, position: float, acceleration: float) -> float:
        """Return the pressure in Pa at which the model holds the load there, so accelerated."""
        # Force is linear in pressure at each contraction.
        kappa = position / self._muscle.l0
        at_zero, gain = float(self._muscle.force(0.0, kappa)), float(self._muscle.gain(kappa))
        return (MASS * (GRAVITY + acceleration) - at_zero) / gain


def main() -> None:
    """Run until the scenario's end."""
    seconds, file = float(sys.argv[1]), sys.argv[2]
    rclpy.init()
    node = ExampleController(seconds)
    executor = EventsExecutor()
    executor.add_node(node)
    try:
        while not node.ended:
            executor.spin_once(timeout_sec=1.0)
    except (KeyboardInterrupt, ExternalShutdownException):
        sys.exit('stopped before the end')
    t, reference, position, pressure = np.array(node.rows).T
    took = node.ended - node.began
    np.savez(file, t=t, reference=reference, position=position, pressure=pressure, took=took)
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
