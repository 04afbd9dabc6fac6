# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""When to control and when to be safe: a law and its course, without ROS and without a clock."""

from math import isfinite

from pam_ros.control.course import Course
from pam_ros.control.signals import Reference
from pam_ros.nodes.control_settings import Told

WAITING, CONTROLLING, DISABLED = 'waiting', 'controlling', 'disabled'
LOST, FAULTY = 'timed out', 'at fault'
LONGEST_STEP = 0.02  # s that a law goes on by at once; the rest of a longer pause is passed over


class Loop:
    """Makes commands of measured positions; it begins each time by holding the load where it is.

    ``condition`` is WAITING for a first position, CONTROLLING, LOST when positions have stayed
    away, DISABLED, or FAULTY when the law gave no number: then it vents until it is enabled anew.
    """

    def __init__(self, told: Told) -> None:
        """Wait for a position, or to be enabled."""
        self.told = told
        self.law = told.make_law()
        self.course = Course(told.shape, told.reach)
        self.condition = WAITING if told.settings.start_enabled else DISABLED
        self.last: float | None = None  # Pa commanded last, while nobody else may command
        self._warm_up()
        self._forget()

    def _warm_up(self) -> None:
        """Let everything be compiled and be in the cache before time counts."""
        low, high = self.told.reach
        middle = 0.5 * (low + high) if low > -float('inf') else 0.0
        self.law.start(middle)
        for _ in range(3):
            self.law.update(1.0 / self.told.settings.rate, Reference(middle), middle)
        self.law.start(middle)

    def _forget(self) -> None:
        self._position: float | None = None
        self._velocity: float | None = None
        self._is_new = False

    @property
    def is_controlling(self) -> bool:
        """Whether references are followed."""
        return self.condition == CONTROLLING

    def change(self, told: Told) -> None:
        """Go on with other parameters, from the last command where the law is a new one."""
        before, self.told = self.told, told
        self.course.set_shape(told.shape)
        self.course.reach = told.reach
        is_same = (before.model, before.limits, before.settings.controller, before.pid) == (
            *(told.model, told.limits, told.settings.controller, told.pid),
        )
        if is_same and hasattr(self.law, 'set_gains'):
            if before.gains != told.gains:
                self.law.set_gains(told.gains)
        elif not is_same:
            self.law = told.make_law()
            if self.is_controlling and self._position is not None:
                self.law.start(self._position, self.last)
                self.law.terms.reference = self.course.reference.position

    def enable(self, is_wanted: bool) -> None:
        """Control from the next position on, or command nothing."""
        if not is_wanted:
            self.condition = DISABLED
            self.last = None
        elif self.condition in (DISABLED, FAULTY):
            self.condition = WAITING
            self._forget()

    def see(self, position: float, velocity: float | None = None) -> None:
        """Take in a measured position in m, and m/s where it is measured."""
        self._position, self._velocity, self._is_new = position, velocity, True
        if self.condition in (WAITING, LOST):
            self.law.start(position, self.last)
            self.course.start(position)
            self.condition = CONTROLLING

    def step(self, dt: float, age: float) -> float | None:
        """Return the pressure in Pa to command for the next *dt* s; None: command nothing.

        The newest position is *age* s old.
        """
        if self.condition in (WAITING, DISABLED):
            return None
        if self.condition == CONTROLLING and age > self.told.settings.state_timeout:
            self.condition = LOST
        if self.condition == CONTROLLING:
            self._control(min(dt, LONGEST_STEP), age)
        elif self.condition == FAULTY or self.told.settings.on_timeout == 'vent':
            self.last = self.told.pressures[0]
        return self.last

    def _control(self, dt: float, age: float) -> None:
        position = self._position if self._is_new else None
        self._is_new = False
        try:
            pressure = self.law.update(dt, self.course.reference, position, self._velocity, age)
        except ArithmeticError:
            pressure = float('nan')
        if isfinite(pressure):
            self.last = pressure
            self.course.follow(dt)
        else:
            self.condition, self.last = FAULTY, self.told.pressures[0]
