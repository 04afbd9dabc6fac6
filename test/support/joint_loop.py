# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Laws in simulated time on the package's own rig, for joints of every kind."""

import numpy as np

from pam_ros.control.reference.shaping import Shape, Shaper
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.transmissions import Lever, Pulley, Straight
from support.closed_loop import Run

HUNG = Actuator(contraction=0.1)
JOINTS = {
    'parallel': Joint((Actuator(), Actuator()), Mass(mass=40.0), Straight()),
    'lever': Joint((HUNG, HUNG), Arm(hanging_at=0.2), Lever()),
    'crank': Joint((HUNG,), Arm(hanging_at=-0.6), Lever()),
    'four': Joint((HUNG,) * 4, Arm(mass=2.0), Pulley()),
}


def close_joint(law, joint, target, duration, begin=None, noise=0.0, seed=0, rate=500.0):
    """Run *law* on a rig of *joint* from rest at *begin*; *target* (s -> m or rad) is shaped.

    Where nothing else is said, it begins in the middle of its reach.
    """
    dt, random = 1.0 / rate, np.random.default_rng(seed)
    origin = 0.5 * sum(law.allocation.reach) if begin is None else begin
    law.start(origin)
    rig = Simulation([joint])
    rig.reset(law.terms.pressures, [origin], [0.0])
    shaper = Shaper(Shape.revolute() if joint.is_revolute else Shape())
    shaper.start(origin)
    steps, count, goal = round(dt / rig.step), round(duration * rate), origin
    rows = np.zeros((count, 3 + len(joint.muscles)))
    for n in range(count):
        t = n * dt
        if target(t) != goal:
            goal = target(t)
            shaper.take(goal)
        measured = float(rig.position[0]) + noise * random.standard_normal()
        pressures = law.update(dt, shaper.reference, measured)
        rig.command(pressures)
        rig.advance(steps)
        shaper.follow(dt)
        rows[n] = t + dt, goal, rig.position[0], *pressures
    t, goal, found, *commands = rows.T
    return Run(t, goal, found, np.array(commands))
