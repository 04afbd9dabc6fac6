# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A step and a sine over DDS in real time: ``pam_sim`` and ``pam_control`` as processes.

There is no sensor noise, so that ``pam_sim`` publishes the true position of the load. The step is
one message on ``position_reference``; the sine is a trajectory with a stamp, so that the desired
position at the stamp of each joint state is known.
"""

import math
import os
from dataclasses import dataclass

import numpy as np
from rclpy.duration import Duration
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pam_ros.control.signals import TERMS
from pam_ros.nodes.demo.client import Client
from pam_ros.nodes.demo.rig_log import seconds
from pam_ros.processes.children import Program

MASS, PRESSURE = 20.0, 300e3  # configured kg, Pa at the start
BEFORE = 1.0  # s at rest before the step, and from one motion to the other
SPACING = 0.05  # s between the points of the sine


@dataclass(frozen=True)
class Series:
    """From the start of a motion: t s and error m (n,), pressure_t s and pressure Pa (k,)."""

    t: np.ndarray
    error: np.ndarray
    pressure_t: np.ndarray
    pressure: np.ndarray


class Pair:
    """Both programs in a namespace of this process, and a client that collects their messages."""

    def __init__(self, client: Client) -> None:
        """Subscribe to the states of both."""
        self.client = client
        self.states = client.collect(JointState, 'joint_states')
        self.terms = client.collect(JointState, 'pam_control/state')

    def wait(self, end: float) -> None:
        """Wait until both have published a time after *end* s."""
        self.client.until(
            lambda: min(seconds(self.states[-1]), seconds(self.terms[-1])) > end, 'the motion'
        )

    def series(self, begin: float, duration: float, target) -> Series:
        """Return the series from *begin* s on; *target* (s -> m) is the desired position."""
        t = np.array([seconds(m) for m in self.states]) - begin
        y = np.array([m.position[0] for m in self.states])
        inside = (t > 0.0) & (t < duration)
        terms_t = np.array([seconds(m) for m in self.terms]) - begin
        pressure = np.array([m.position[TERMS.index('pressure')] for m in self.terms])
        within = (terms_t > 0.0) & (terms_t < duration)
        error = np.array([target(now) for now in t[inside]]) - y[inside]
        return Series(t[inside], error, terms_t[within], pressure[within])


def sine_points(middle: float, swing: float, frequency: float, end: float) -> JointTrajectory:
    """Return a sine of *swing* m at *frequency* Hz around *middle* m until *end* s."""
    turn = 2.0 * math.pi * frequency
    message = JointTrajectory(joint_names=['pam'])
    for k in range(1, round(end / SPACING) + 1):
        t = k * SPACING
        wave = swing * math.sin(turn * t)
        point = JointTrajectoryPoint(time_from_start=Duration(seconds=t).to_msg())
        point.positions, point.accelerations = [middle + wave], [-turn * turn * wave]
        point.velocities = [swing * turn * math.cos(turn * t)]
        message.points.append(point)
    return message


def step_and_sine(
    controller: str,
    payload: float,
    step: tuple[float, float],
    sine: tuple[float, float, float],
) -> tuple[Series, Series]:
    """Return the responses to a *step* (m, s) and a *sine* (m, Hz, s) with a law by name."""
    space = f'/control_{os.getpid()}'
    where = ('-r', f'__ns:={space}')
    rig = {'mass': MASS + payload, 'initial.pressure': PRESSURE}
    believed = {'mass': MASS, 'controller': controller}
    # Keep out nodes of other machines.
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    with (
        Client(space) as client,
        Program('pam_sim', *where, parameters=rig),
        Program('pam_control', *where, parameters=believed),
    ):
        pair = Pair(client)
        client.until(lambda: len(pair.terms) > 1 and len(pair.states) > 1, 'control')
        pair.wait(seconds(pair.terms[0]) + BEFORE)
        origin = pair.terms[-1].position[TERMS.index('reference')]
        height, rest = step
        begin = client.node.get_clock().now().nanoseconds * 1e-9
        client.publish(Float64(data=origin + height), 'position_reference')
        pair.wait(begin + rest)
        stepped = pair.series(begin, rest, lambda t: origin + height)

        swing, frequency, end = sine
        back = client.node.get_clock().now().nanoseconds * 1e-9
        client.publish(Float64(data=origin), 'position_reference')
        pair.wait(back + BEFORE + rest / 2.0)
        at = client.node.get_clock().now() + Duration(seconds=BEFORE)
        message = sine_points(origin, swing, frequency, end)
        message.header.stamp = Time(nanoseconds=at.nanoseconds).to_msg()
        client.publish(message, 'joint_trajectory')
        begin = at.nanoseconds * 1e-9
        pair.wait(begin + end)
        turn = 2.0 * math.pi * frequency
        swung = pair.series(begin, end, lambda t: origin + swing * math.sin(turn * t))
    return stepped, swung
