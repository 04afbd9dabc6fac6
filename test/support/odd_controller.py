# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A controller that holds a pressure, and misbehaves as its first argument says.

``good`` answers each state. After 200 states ``dies`` ends with an error, ``stops`` is silent and
``nan`` sends a pressure that is not a number. ``silent`` never answers, ``deaf`` does not even
subscribe, ``floods`` sends without end, and ``timer`` sends at 500 Hz by the clock of its node.
``steps`` commands 10 kPa more after 200 states. With ``notes`` it writes the stamp in ns of each
state, one a line, to the file of its second argument.
"""

import math
import sys
from pathlib import Path

import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

AFTER, PRESSURE, STEP = 200, 300e3, 10e3  # states, Pa, Pa


class OddController(Node):
    """A node that answers states with a constant pressure, or does not."""

    def __init__(self, kind: str, more: str = '') -> None:
        """Behave as *kind* says."""
        super().__init__('odd_controller')
        self._kind, self._states = kind, 0
        self._notes = Path(more).open('w') if kind == 'notes' else None  # noqa: SIM115 kept open
        self._command = self.create_publisher(Float64, 'pressure_command', 10)
        if kind != 'deaf':
            self.create_subscription(JointState, 'joint_states', self._answer, 10)
        if kind == 'floods':
            steady = Clock(clock_type=ClockType.STEADY_TIME)
            self.create_timer(1e-4, self._send_often, clock=steady)
        if kind == 'timer':
            self.create_timer(2e-3, lambda: self._send(PRESSURE))

    def _send_often(self) -> None:
        for _ in range(20):
            self._send(PRESSURE)

    def _send(self, pressure: float) -> None:
        self._command.publish(Float64(data=pressure))

    def _answer(self, state: JointState) -> None:
        self._states += 1
        if self._notes:
            stamp = state.header.stamp
            print(stamp.sec * 10**9 + stamp.nanosec, file=self._notes, flush=True)
        is_odd = self._states > AFTER
        if self._kind in ('silent', 'floods', 'timer') or (is_odd and self._kind == 'stops'):
            return
        if is_odd and self._kind == 'dies':
            raise RuntimeError('the gains are lost')
        odd = {'nan': math.nan, 'steps': PRESSURE + STEP}
        self._send(odd.get(self._kind, PRESSURE) if is_odd else PRESSURE)


if __name__ == '__main__':
    rclpy.init()
    rclpy.spin(OddController(*sys.argv[1:3]))
