# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A loop whose law writes down what it is called with."""

from pam_ros.control.loop import Loop, Measurement
from pam_ros.control.plausibility import MotionBounds, Plausibility
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.signals import Terms

PERIOD = 0.002
BOUNDS = MotionBounds(-0.1, 0.2, 50.0, 1e-3, 'm')


def first(count):
    """Return the commands of a law that has been called so many times."""
    return (100e3 + count,)


class Recorder:
    """A law that writes down what it is called with."""

    def __init__(self):
        self.starts, self.calls = [], []
        self.terms = Terms()

    def start(self, position, pressures=None):
        self.starts.append((position, pressures))

    def update(self, dt, reference, position, velocity=None, age=0.0):
        self.calls.append((dt, reference.position, position, velocity, age))
        self.terms = Terms(position=reference.position)
        return first(len(self.calls))


def recorded_loop():
    """Return the loop, whose target may be between -1 and 1 m."""
    return Loop(Recorder(), ReferenceSource(Shape(), (-1.0, 1.0)), PERIOD, Plausibility(BOUNDS))


def seen(loop, now, position=0.05):
    """Give *loop* a measurement in m at the time *now* in s; return what it commands then."""
    loop.see(Measurement(now, position))
    return loop.tick(now)
