# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The law for an antagonistic pair in simulated time on the truth plant, without ROS."""

import numpy as np

from pam_ros.control.reference.shaping import Shape, Shaper
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.transmissions import Pulley
from support.closed_loop import LAG, LAG_WITH_ZONE, STREAM, ZONE, Run

__all__ = ['LAG', 'LAG_WITH_ZONE', 'ZONE', 'close_pair', 'nominal']
TERMS = ('error', 'surface', 'switching', 'observer', 'learned', 'bandwidth')


def nominal(effects=(), load=()):
    """Return the joint as it is configured in the controller; *effects* of both muscles."""
    actuator = Actuator(effects=effects, contraction=0.1)
    return Joint((actuator, actuator), Arm(), Pulley(), load)


def close_pair(
    law, plant, target, duration, stiffness=None, *, rate=500.0, begin=0.0, shape=None, push=None
):
    """Run *law* on *plant* along *target* (s -> rad), with *stiffness* (s -> N m/rad).

    Both come as samples every STREAM s, as from topics; the angle is measured at *rate*. *push*
    (s -> N m) is a torque on the joint.
    """
    dt, count = 1.0 / rate, round(duration * rate)
    law.start(begin)
    plant.reset(begin, law.terms.pressures)
    shaper = Shaper(shape or Shape.revolute())
    shaper.start(begin)
    measured, taken, wanted = plant.measure(), None, None
    rows, terms = np.zeros((count, 7)), np.zeros((count, len(TERMS)))
    for n in range(count):
        t = n * dt
        sample = int(t / STREAM + 1e-9)
        if sample != taken:
            taken = sample
            shaper.take(target(sample * STREAM), t - sample * STREAM)
            if stiffness and stiffness(t) != wanted:
                wanted = stiffness(t)
                law.stiffen(wanted)
        pressures = law.update(dt, shaper.reference, measured)
        measured = plant.step(pressures, dt, push(t) if push else 0.0)
        shaper.follow(dt)
        end = (n + 1) * dt
        true = plant.stiffness()
        rows[n] = end, target(end), plant.angle, true, law.terms.co_contraction, *pressures
        terms[n] = [getattr(law.terms, name) for name in TERMS]
    t, goal, angle, found, wish, *commands = rows.T
    named = dict(zip(TERMS, terms.T, strict=True))
    return Run(t, goal, angle, np.array(commands), named, found, wish)
