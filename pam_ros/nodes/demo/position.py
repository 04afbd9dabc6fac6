# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Position control over topics: ``pam_control`` moves the load of ``pam_sim``.

The load is heavier than the nominal load of the controller. Set-points are sent on
``position_reference``, a sine on ``joint_trajectory``. Both programs run in lockstep, so that the
result does not depend on the load of the machine.
"""

import math

import numpy as np
from rclpy.duration import Duration
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pam_ros.control.signals import TERMS
from pam_ros.demo import position
from pam_ros.demo.position import PositionRun
from pam_ros.demo.stage import DemoStage
from pam_ros.nodes.demo.lockstep_pair import STILL, LockstepPair
from pam_ros.nodes.demo.rig_log import seconds

MUSCLE = 'dmsp_20_400n'
NOMINAL, TRUE = 20.0, 25.0  # kg
GOALS = (0.070, 0.050, 0.060)  # m
HOLD = 2.5  # s for each of them
SWING, FREQUENCY, CYCLES = 0.010, 0.5, 4  # m, Hz: the sine, around the last of the goals
SPACING = 0.05  # s between the points of its trajectory


def play(stage: DemoStage) -> None:
    """Move the load, and write a plot and a table."""
    stage.say(
        f'Position control over ROS topics: {MUSCLE}, configured with {NOMINAL:g} kg; '
        f'the real load has {TRUE:g} kg'
    )
    run, marks = record(stage)
    steps = [
        (goal, run.between(begin, begin + HOLD))
        for goal, begin in zip(GOALS, marks[:-1], strict=True)
    ]
    whole = run.between(
        marks[-1] + 1.0 / FREQUENCY, marks[-1] + (CYCLES - 1) / FREQUENCY
    )  # the part with the full amplitude
    from pam_ros.demo import figures

    path = stage.folder / 'position_control.png'
    headline = f'pam_control: {NOMINAL:g} kg configured, {TRUE:g} kg moved'
    figures.save(position.figure(run, headline), path)
    stage.wrote(path)
    stage.text('position_control.txt', position.table(steps, whole))


def record(stage: DemoStage) -> tuple[PositionRun, list[float]]:
    """Return the recorded run, and the times in s at which the goals and the sine start."""
    rig = {'muscle': MUSCLE, 'mass': TRUE, 'initial.pressure': 300e3}
    controller = {'muscle': MUSCLE, 'mass': NOMINAL}
    with LockstepPair(stage, rig, controller, (Float64, 'pressure_command')) as pair:
        pair.begin()
        stops = [pair.stop_after(1.5)]
        for goal in GOALS:
            stage.say(f'  to {1e3 * goal:.0f} mm')
            pair.publish(Float64(data=goal), 'position_reference')
            stops.append(pair.stop_after(HOLD))
        stage.say(f'  a sine of {1e3 * SWING:.0f} mm at {FREQUENCY:g} Hz')
        pair.publish(sine(GOALS[-1]), 'joint_trajectory')
        pair.stop_after(CYCLES / FREQUENCY + 0.5)
        run = put_together(pair.states, pair.terms)
    return run, [run.departure(stop, STILL) for stop in stops]


def sine(middle: float) -> JointTrajectory:
    """Return the sine as a trajectory around *middle* m."""
    turn, end = 2.0 * math.pi * FREQUENCY, CYCLES / FREQUENCY
    message = JointTrajectory(joint_names=['pam'])
    for k in range(1, round(end / SPACING) + 1):
        t = k * SPACING
        # Its amplitude grows over the first cycle and decays over the last.
        share = min(t * FREQUENCY, (end - t) * FREQUENCY, 1.0)
        swing = SWING * math.sin(0.5 * math.pi * max(share, 0.0)) ** 2
        message.points.append(
            JointTrajectoryPoint(
                positions=[middle + swing * math.sin(turn * t)],
                time_from_start=Duration(seconds=t).to_msg(),
            )
        )
    return message


def put_together(states: list[JointState], terms: list[JointState]) -> PositionRun:
    """Return the positions of the rig together with the terms of the same stamp."""
    at = {(m.header.stamp.sec, m.header.stamp.nanosec): m.position[0] for m in states}
    rows = []
    for message in terms:
        stamp = message.header.stamp
        measured = at.get((stamp.sec, stamp.nanosec))
        if measured is not None:
            values = dict(zip(TERMS, message.position, strict=True))
            row = seconds(message), values['reference'], measured
            rows.append((*row, values['surface'], values['pressure']))
    return PositionRun(*np.array(rows).T)
