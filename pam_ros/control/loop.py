# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A law in service: it starts where the load is, and does what is safe when nothing is seen.

All times are seconds of one clock, whose time is given with each call; measurements carry the
time at which they were taken.
"""

from dataclasses import dataclass
from math import isfinite

from pam_ros.control.plausibility import Plausibility
from pam_ros.control.reference.course import Course
from pam_ros.control.reference.points import Point, Points
from pam_ros.control.reference.trajectory import Trajectory
from pam_ros.control.signals import PositionLaw, Pressures, Reference

HOLD, VENT = 'hold', 'vent'
WAITING, RUNNING, BLIND, DISABLED = 'waiting', 'running', 'blind', 'disabled'
# Shortest step in periods, since a law divides by it, and longest in s: what passes in a longer
# one is not controlled, and a law that took it for one step would overshoot.
LEAST, MOST = 0.1, 0.1
# s for which 0 Pa is commanded after venting, so that a lost message does not matter. A simulator
# or valve that starts again later must not obey what was meant for the one that is gone.
VENTING = 0.2


@dataclass(frozen=True)
class Reading:
    """A measurement: time taken in s, position in m, velocity in m/s where there is one.

    ``stamp`` is the time in s by the clock of the sensor, which may be another than that of the
    loop; None where there is none.
    """

    time: float
    position: float
    velocity: float | None = None
    stamp: float | None = None


class Loop:
    """Runs a law at a period, on measurements and set targets.

    state
        WAITING for a first measurement, RUNNING, BLIND without fresh measurements, DISABLED
    pressures
        the last commands in Pa, one a muscle, None before there were any
    time
        of the last step, s
    implausible
        how many measurements were left out because they cannot be true
    timeout, safe
        age in s of the newest measurement after which the loop is BLIND, and what it then commands
    lost
        time in s from which on it vents, None where it does not
    vent_time
        s in which VENT lowers the pressures to 0 Pa, all in proportion: muscles that pull against
        each other keep the ratio of their pressures
    """

    def __init__(
        self, law: PositionLaw, course: Course, period: float, plausibility: Plausibility
    ) -> None:
        """Make it wait for the first measurement; *period* in s."""
        self.law, self.course, self.period = law, course, period
        self.plausibility, self.implausible = plausibility, 0
        self.timeout, self.safe, self.vent_time = 0.1, HOLD, 0.0
        self.state = WAITING
        self.pressures: Pressures | None = None
        self.chambers: Pressures | None = None  # commands in Pa that would hold what is measured
        self.awaits_chamber = False  # whether to wait for such a measurement
        self.starts = 0
        self._seen: Reading | None = None
        self._is_new = False
        self.lost: float | None = None
        self._left: Pressures = ()  # the pressures then, Pa
        self._has_left = False  # whether the rig is left to itself
        self.time = 0.0

    @property
    def is_enabled(self) -> bool:
        """Whether it commands, or will when it sees something."""
        return self.state != DISABLED

    def enable(self, is_enabled: bool) -> None:
        """Begin anew from wherever the load is, or command nothing."""
        if is_enabled != self.is_enabled:
            self.state = WAITING if is_enabled else DISABLED
            self._seen = None
            self.plausibility.forget()

    def see(self, reading: Reading) -> str:
        """Take in a measurement; return why it cannot be true, '' where it can.

        One that cannot be true is left out, and so is one that is older than the last: control
        goes on by the model, and after the time-out as where nothing is seen.
        """
        last = self._seen
        if last is not None and reading.time <= last.time:
            return ''
        passed = 0.0 if last is None else reading.time - last.time
        if last is not None and last.stamp is not None and reading.stamp is not None:
            # Messages that were held up arrive at once: their time of receipt is no clock.
            passed = max(reading.stamp - last.stamp, 0.0)
        fault = self.plausibility.fault_of(passed, reading.position, reading.velocity)
        if fault:
            self.implausible += 1
            return fault
        if self.plausibility.is_first and self.state == RUNNING:
            self.state = BLIND  # either this or the one that control began at is false
        self._seen, self._is_new = reading, True
        return ''

    def change(self, law: PositionLaw, course: Course) -> None:
        """Go on with another law and course from where the load and the pressure are."""
        if self.state == RUNNING:
            law.start(self.law.terms.position, self.pressures)
            course.start(self.course.reference.position)
        self.law, self.course = law, course

    def forget(self) -> None:
        """Begin anew at the next measurement: the clock has jumped."""
        self._seen = None
        self.plausibility.forget()
        if self.is_enabled:
            self.state = WAITING

    def age(self, now: float) -> float | None:
        """Return how old the newest measurement is, in s."""
        return None if self._seen is None else now - self._seen.time

    def tick(self, now: float) -> Pressures | None:
        """Return the gauge pressure in Pa to command from *now* on, None for no command."""
        if self.state == DISABLED:
            return None
        reading = self._seen
        if reading is None or now - reading.time > self.timeout:
            self.plausibility.forget()
            return self._stay_safe(now)
        self.lost, self._has_left = None, False
        if self.state != RUNNING:
            if self.awaits_chamber and self.chambers is None:
                return self.pressures if self.state == BLIND and self.safe == HOLD else None
            self._start(reading, now)
        passed = max(now - self.time, LEAST * self.period)
        dt = min(passed, MOST)
        self.time = now
        position, velocity = None, None
        if self._is_new:
            position, velocity = reading.position, reading.velocity
            self._is_new = False
        reference = self.course.follow(dt, passed - dt)
        self.pressures = self.law.update(dt, reference, position, velocity, now - reading.time)
        return self.pressures

    def _start(self, reading: Reading, now: float) -> None:
        """Begin anew where the load is, at the pressure that is there."""
        known = self.pressures if self.chambers is None else self.chambers
        self.law.start(reading.position, known)
        self.course.start(reading.position)
        self.time = now - self.period
        self.state = RUNNING
        self.starts += 1

    def _stay_safe(self, now: float) -> Pressures | None:
        """Return what is commanded when nothing is seen: nothing before the first start."""
        if self.state == RUNNING:
            self.state = BLIND
        if self.state != BLIND or self.pressures is None:
            return None
        if self.safe == HOLD:
            return self.pressures
        if self.lost is None:
            self.lost, self._left = now, self.pressures
        passed = now - self.lost
        self.pressures = self.vented(self._left, passed)
        is_over = self._has_left or passed > self.vent_time + VENTING
        return None if is_over else self.pressures

    def vented(self, pressures: Pressures, time: float) -> Pressures:
        """Return what is left in Pa of *pressures* after *time* in s of venting."""
        share = max(1.0 - time / self.vent_time, 0.0) if self.vent_time else 0.0
        return tuple(share * pressure for pressure in pressures)

    def leave(self) -> None:
        """Command no more until something is seen: the rig is another one by now."""
        self._has_left = True


def warm_up(law: PositionLaw, reach: tuple[float, float], period: float) -> None:
    """Let *law* and trajectories compile and load all that they need, before time counts."""
    middle = 0.5 * (reach[0] + reach[1]) if isfinite(reach[0]) else 0.0
    for rest in ((), (0.0,), (0.0, 0.0)):  # each kind of interpolation
        Trajectory(Reference(middle), Points.of([Point(1.0, middle, *rest)]), reach)
    law.start(middle)
    for _ in range(3):
        law.update(period, Reference(middle), middle)
