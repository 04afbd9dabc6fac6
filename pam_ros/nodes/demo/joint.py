# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An antagonistic joint over topics: ``pam_control`` controls angle and stiffness.

``pam_sim`` simulates the joint, whose arm carries more than the nominal mass of the controller.
The angle follows a sine on ``joint_trajectory``; the stiffness is set on
``co_contraction_reference``, during the sine and at rest.
"""

import math

import numpy as np
from rclpy.duration import Duration
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64, Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pam_ros.control.signals import term_names
from pam_ros.demo import joint
from pam_ros.demo.joint import JointRun
from pam_ros.demo.stage import DemoStage
from pam_ros.nodes.demo.lockstep_pair import LockstepPair
from pam_ros.nodes.demo.rig_log import seconds

MUSCLE = 'dmsp_20_400n'
NOMINAL, TRUE = 1.0, 1.3  # kg on the arm
RADIUS = 0.04  # m
NOISE = math.radians(0.02)
SWING, FREQUENCY, CYCLES = math.radians(15.0), 0.5, 4
REST = 1.0  # s
SOFT, STIFF = 20.0, 35.0  # N m/rad
SPACING = 0.02  # s between the points of the trajectory


def play(stage: DemoStage) -> None:
    """Control the joint, and write a plot and a table."""
    stage.say(
        f'An antagonistic joint over ROS topics: two {MUSCLE}, configured with '
        f'an arm of {NOMINAL:g} kg; the real one has {TRUE:g} kg'
    )
    run = record(stage)
    begin = run.departure
    whole = run.between(begin + 1.0 / FREQUENCY, begin + (CYCLES - 1) / FREQUENCY)
    still = run.between(begin + CYCLES / FREQUENCY, np.inf)
    parts = [
        (f'sine, {SOFT:g} N m/rad', whole.with_stiffness(SOFT)),
        (f'sine, {STIFF:g} N m/rad', whole.with_stiffness(STIFF)),
        (f'at rest, to {SOFT:g} N m/rad', still),
    ]
    from pam_ros.demo import figures

    path = stage.folder / 'joint.png'
    headline = f'pam_control: {NOMINAL:g} kg configured, {TRUE:g} kg moved'
    figures.save(joint.figure(run, headline), path)
    stage.wrote(path)
    stage.text('joint.txt', joint.table(parts))


def record(stage: DemoStage) -> JointRun:
    """Return the recorded run."""
    both = {'joint': 'antagonistic', 'muscle': MUSCLE, 'radius': RADIUS}
    rig = {**both, 'mass': TRUE, 'initial.pressure': 250e3, 'sensor.position_noise': NOISE}
    controller = {**both, 'mass': NOMINAL, 'co_contraction': SOFT}
    commands = (Float64MultiArray, 'pressure_commands')
    with LockstepPair(stage, rig, controller, commands) as pair:
        arrays = pair.client.collect(Float64MultiArray, 'stiffnesses')
        pair.begin(arrays)
        before = len(arrays)
        pair.stop_after(REST)
        stage.say(f'  a sine of {math.degrees(SWING):.0f} degrees at {FREQUENCY:g} Hz')
        pair.publish(sine(), 'joint_trajectory')
        begin = seconds(pair.terms[-1])
        pair.stop_after(0.5 * CYCLES / FREQUENCY)
        stage.say(f'  co-contraction from {SOFT:g} to {STIFF:g} N m/rad')
        pair.publish(Float64(data=STIFF), 'co_contraction_reference', 'co_contraction')
        pair.stop_after(begin + CYCLES / FREQUENCY + REST - seconds(pair.states[-1]))
        stage.say(f'  and back to {SOFT:g} N m/rad')
        pair.publish(Float64(data=SOFT), 'co_contraction_reference', 'co_contraction')
        pair.stop_after(REST)
        periods = len({seconds(state) for state in pair.states}) - 1
        pair.client.until(lambda: len(arrays) >= before + periods, 'an array for each state')
        return put_together(pair.states, pair.terms, arrays)


def sine() -> JointTrajectory:
    """Return the sine around 0 as a trajectory.

    Its amplitude grows in the first cycle and decays in the last.
    """
    turn, end = 2.0 * math.pi * FREQUENCY, CYCLES / FREQUENCY
    message = JointTrajectory(joint_names=['pam'])
    for k in range(1, round(end / SPACING) + 1):
        t = k * SPACING
        share = max(min(t * FREQUENCY, (end - t) * FREQUENCY, 1.0), 0.0)
        swing = SWING * math.sin(0.5 * math.pi * share) ** 2
        point = JointTrajectoryPoint(positions=[swing * math.sin(turn * t)])
        point.time_from_start = Duration(seconds=t).to_msg()
        message.points.append(point)
    return message


def put_together(
    states: list[JointState], terms: list[JointState], arrays: list[Float64MultiArray]
) -> JointRun:
    """Return angle and stiffness of the rig together with the terms of the same stamp.

    An array has no stamp. One array arrives with each state, so that they match if
    they are counted from the end.
    """
    count = min(len(states), len(arrays))
    at = {}
    for state, array in zip(states[-count:], arrays[-count:], strict=True):
        stamp = state.header.stamp
        at[stamp.sec, stamp.nanosec] = state.position[0], RADIUS**2 * sum(array.data)
    rows = []
    for message in terms:
        stamp = message.header.stamp
        if (stamp.sec, stamp.nanosec) in at:
            angle, stiffness = at[stamp.sec, stamp.nanosec]
            values = dict(zip(term_names(2), message.position, strict=True))
            pressures = values['pressure_1'], values['pressure_2']
            row = seconds(message), values['reference'], angle, *pressures
            rows.append((*row, values['co_contraction'], stiffness))
    return JointRun(*np.array(rows).T)
