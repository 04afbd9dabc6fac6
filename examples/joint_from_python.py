# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate an antagonistic joint, control its angle, and draw what happened.

    python3 joint_from_python.py joint.png

Two muscles turn a pulley against each other. The joint has friction and a slow valve that are not
in the model of the controller. The desired angle steps to 20 degrees after 1 s, and to -10 degrees
after 3 s.
"""

import argparse

import numpy as np
from matplotlib.figure import Figure

from pam_ros import (
    Arm,
    CoulombFriction,
    Gains,
    Muscle,
    PressureLag,
    Reference,
    Simulation,
    Slack,
    SlidingMode,
    antagonistic_joint,
)

PERIOD = 2e-3  # s between two commands
START = 250e3  # Pa in both muscles

parser = argparse.ArgumentParser(description='Control an antagonistic joint and draw the result.')
parser.add_argument('picture', help='file to write, such as joint.png')
picture = parser.parse_args().picture


def joint(effects):
    """Return the elbow with these effects."""
    load = Arm(mass=1.0, arm=0.25)
    return antagonistic_joint(Muscle(), radius=0.04, load=load, contraction=0.1, effects=effects)


slack = [Slack(share=1.0)]
nominal = joint(slack)
real = joint([*slack, CoulombFriction(level=0.3), PressureLag(fill=0.03)])
plant = Simulation([real], step=1e-3)
plant.reset(START, [0.0], [0.0])
law = SlidingMode(nominal, Gains.for_joint(nominal))
law.start(0.0, (START, START))

t = PERIOD * np.arange(2500)
goal = np.radians(np.select([t < 1.0, t < 3.0], [0.0, 20.0], -10.0))
angle, pressures = np.empty(t.size), np.empty((t.size, 2))
for k in range(t.size):
    angle[k] = plant.position[0]
    pressures[k] = law.update(PERIOD, Reference(goal[k]), angle[k])
    plant.command(pressures[k])
    plant.advance(2)
print(f'{np.degrees(angle[1499]):.2f} degrees after 3 s, {np.degrees(angle[-1]):.2f} after 5 s')

figure = Figure(figsize=(7.0, 5.0), layout='constrained')
upper, lower = figure.subplots(2, sharex=True)
upper.plot(t, np.degrees(goal), '--', label='desired')
upper.plot(t, np.degrees(angle), label='simulated')
upper.set_ylabel('angle in degrees')
lower.plot(t, pressures / 1e3, label=['muscle 1', 'muscle 2'])
lower.set(xlabel='time in s', ylabel='pressure in kPa')
for axes in (upper, lower):
    axes.legend()
    axes.grid(alpha=0.3)
try:
    figure.savefig(picture)
except OSError as error:
    parser.error(f'{picture} cannot be written: {error.strerror}')
except ValueError as error:  # an unknown kind of picture
    parser.error(f'{picture} cannot be written: {error}')
print(f'the picture is in {picture}')
