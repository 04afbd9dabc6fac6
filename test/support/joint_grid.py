# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Every kind of joint with light to heavy loads, and a law that goes from anywhere to anywhere."""

from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from pam_ros.effects import Slack
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Mass
from support.joint_loop import close_joint

SLACK = [Slack(share=1.0)]
# Of the masses of the defaults, 20 kg on a slide and 1 kg on an arm; no lighter arm has a reach on
# a lever, and none heavier than four times can be lifted by a crank far from where it hangs.
LOADS = (0.5, 1.0, 3.0)
WAIT = 5.0  # s from one goal to the next
# Shares of the reach that the error may have at the end of that. PID goes slowly near a dead
# centre, where the muscle has little torque: after 10 s it is a tenth of that.
REACHED = {'Pid': 0.04, 'SlidingMode': 2e-4}
# How far it may go beyond both ends of a step: a PID law does not know the inertia of a heavy arm.
BEYOND = {'Pid': 0.3, 'SlidingMode': 0.01}


def nominal(kind, load=1.0, effects=()):
    """Return a joint of a *kind* by name: its defaults with *load* times the mass."""
    (found,) = (one for one in ARRANGEMENTS if one.name == kind)
    muscle = Actuator(effects=effects, contraction=found.contraction)
    default = found.load()
    if isinstance(default, Mass) or load >= 1.0:
        default = replace(default, mass=load * default.mass)
    else:
        default = replace(default, inertia=load * default.inertia)
    return Joint((muscle,) * found.muscles, default, found.transmission())


@dataclass
class Visit:
    """How a goal was reached: where from and where to, and the largest error of the last 0.5 s."""

    begin: float
    goal: float
    error: float
    farthest: float


def visits(law, joint, places=3, wait=WAIT):
    """Return visits from each of some *places* of the reach to each other one, in one run.

    Errors and the farthest coordinate outside the two ends are shares of the reach.
    """
    low, high = law.allocation.reach
    grid = np.linspace(low, high, places)
    goals = [grid[0]]
    for one, two in permutations(grid, 2):
        goals += [two] if goals[-1] == one else [one, two]
    run = close_joint(
        law,
        joint,
        lambda t: goals[min(int(t / wait), len(goals) - 1)],
        wait * len(goals),
        goals[0],
    )
    found = []
    for i in range(1, len(goals)):
        during = (run.t > i * wait) & (run.t <= (i + 1) * wait)
        last = run.t[during] > (i + 1) * wait - 0.5
        begin, goal = goals[i - 1], goals[i]
        beyond = np.maximum(
            run.coordinate[during] - max(begin, goal), min(begin, goal) - run.coordinate[during]
        )
        error = np.max(np.abs(run.error[during][last]))
        found.append(
            Visit(begin, goal, error / (high - low), max(0.0, np.max(beyond)) / (high - low))
        )
    return found
