# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A law in operation: starts at the position of the load, and is safe without measurements.

All times are seconds of one clock, and each call gives the time. Each measurement carries the time
at which it was taken.
"""

from dataclasses import dataclass
from math import isfinite

from pam_ros.control.plausibility import Plausibility
from pam_ros.control.reference.points import Point, Points
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.reference.trajectory import ReferenceTrajectory
from pam_ros.control.signals import LONGEST_TIME, PositionLaw, Pressures, Reference

HOLD, VENT = 'hold', 'vent'
WAITING, RUNNING, BLIND, DISABLED = 'waiting', 'running', 'blind', 'disabled'
# Shortest step in periods, since a law divides by it, and longest step in s: during a longer one
# nothing was controlled, and a law that took it as one step would overshoot.
LEAST, MOST = 0.1, 0.1
# s by which a measurement may be late for the law to use it. A later one that is taken for the
# present position makes a loop oscillate, as an unconfigured delay of 20 to 80 ms does.
LATE = 0.02
# Share of the newest interval between two measurements in the usual one: a single pause of the
# rig hardly counts, and a rate that changes counts within a dozen measurements.
NEWEST = 0.1
# s in which the reference stops when measurements stay away, and continues when they are back: its
# velocity does not jump, and a measurement that is a few ms overdue hardly slows it.
STOPPING = 0.03
# s for which 0 Pa is commanded after venting, so that a lost message does not matter. It is short,
# since a simulator or valve that is restarted must not receive the command for the former one.
VENTING = 0.2


@dataclass(frozen=True)
class Measurement:
    """A measurement: time taken in s, position in m, velocity in m/s if it is measured.

    ``stamp`` is the time in s by the clock of the sensor, which may differ from that of the
    loop; None without a stamp. ``late`` is the time in s by which it arrived late, as far as that
    is known.
    """

    time: float
    position: float
    velocity: float | None = None
    stamp: float | None = None
    late: float = 0.0


class Loop:
    """Runs a law at a period, on measurements and set targets.

    state
        WAITING for a first measurement, RUNNING, BLIND (no recent measurements), DISABLED
    pressures
        the last commands in Pa, one a muscle, None before the first command
    time
        of the last step, s
    implausible
        number of measurements that were ignored as not plausible
    timeout, safe
        age in s of the newest measurement after which the loop is BLIND, and its command then
    lost
        time in s from which the loop vents, None if it does not vent
    is_received
        whether the rig receives the commands; venting is suspended while it does not
    vent_time
        s in which VENT lowers the pressures to 0 Pa, all in proportion: antagonistic muscles
        keep the ratio of their pressures
    """

    def __init__(
        self, law: PositionLaw, source: ReferenceSource, period: float, plausibility: Plausibility
    ) -> None:
        """Make it wait for the first measurement; *period* in s."""
        self.law, self.source, self.period = law, source, period
        self.plausibility, self.implausible = plausibility, 0
        self.timeout, self.safe, self.vent_time = 0.1, HOLD, 0.0
        self.state = WAITING
        self.pressures: Pressures | None = None
        self.chambers: Pressures | None = None  # Pa: commands that hold the measured pressures
        self.awaits_chamber = False  # whether to wait for such a measurement
        self.starts = 0
        self._seen: Measurement | None = None
        self._is_new = False
        self._used = self._usual = 0.0  # time of the last measurement used, usual interval, s
        self._pace = 1.0  # of the reference: 0 while it is held
        self.lost: float | None = None
        self.is_received = True
        self._left: Pressures = ()  # the pressures at that time, Pa
        self._vented = self._looked = 0.0  # s of venting since then, and the time of the last step
        self._has_left = False  # whether the rig gets no more commands
        self.time = 0.0

    @property
    def is_enabled(self) -> bool:
        """Whether it sends commands, or will do so with the first measurement."""
        return self.state != DISABLED

    def enable(self, is_enabled: bool) -> None:
        """Start again at the present position of the load, or stop all commands."""
        if is_enabled != self.is_enabled:
            self.state = WAITING if is_enabled else DISABLED
            self._seen = None
            self.plausibility.forget()

    def see(self, reading: Measurement) -> str:
        """Take in a measurement; return why it is not plausible, or '' if it is plausible.

        A measurement is ignored if it is not plausible or not newer than the last one, and one
        that is late does not correct the law. Control then continues by the model, and after the
        timeout as without measurements.
        """
        last = self._seen
        if last is not None and reading.time <= last.time:
            return ''
        passed = 0.0 if last is None else reading.time - last.time
        if last is not None and last.stamp is not None and reading.stamp is not None:
            # Delayed messages arrive together: their stamps, not their receipts, give the time.
            passed = max(reading.stamp - last.stamp, 0.0)
        fault = self.plausibility.fault_of(passed, reading.position, reading.velocity)
        if fault:
            self.implausible += 1
            return fault
        if self.plausibility.is_first and self.state == RUNNING:
            self.state = BLIND  # either this measurement or the one at the start is wrong
        self._seen, self._is_new = reading, True
        return ''

    def change(self, law: PositionLaw, source: ReferenceSource) -> str:
        """Continue with another law and reference, from the present position and pressure.

        Return a sentence if the present reference is out of the new reach, else ''.
        """
        sentence = ''
        if self.state == RUNNING:
            position = self.law.terms.position
            law.start(position, self.pressures)
            sentence = source.succeed(self.source, position)
        self.law, self.source = law, source
        return sentence

    def forget(self) -> None:
        """Start again at the next measurement, since the clock has jumped."""
        self._seen = None
        self.plausibility.forget()
        if self.is_enabled:
            self.state = WAITING

    def age(self, now: float) -> float | None:
        """Return the age of the newest measurement in s."""
        return None if self._seen is None else now - self._seen.time

    def tick(self, now: float) -> Pressures | None:
        """Return the gauge pressure in Pa to command from *now* on, None for no command."""
        if self.state == DISABLED:
            return None
        reading = self._seen
        if reading is None or now - reading.time > self.timeout:
            self.plausibility.forget()
            return self._stay_safe(now)
        is_running = self.state == RUNNING
        # The step of the loop may be late, too: the measurement is then as old.
        is_late = reading.late > LATE or now - reading.time > LATE + self.period
        if not is_running and is_late:
            return self._stay_safe(now)
        self.lost, self._has_left = None, False
        if not is_running:
            if self.awaits_chamber and self.chambers is None:
                return self.pressures if self.state == BLIND and self.safe == HOLD else None
            self._start(reading, now)
        passed = max(now - self.time, LEAST * self.period)
        dt = min(passed, MOST)
        self.time = now
        position, velocity = None, None
        if self._is_new and not is_late:
            position, velocity = reading.position, reading.velocity
            self._use(reading.time)
        self._is_new = False
        reference = self.source.follow(dt, passed - dt, self._pace_after(dt))
        # Only that of a new reading counts, which is late if the program was stopped.
        age = min(max(now - reading.time, -LONGEST_TIME), LONGEST_TIME)
        self.pressures = self.law.update(dt, reference, position, velocity, age)
        return self.pressures

    def _use(self, time: float) -> None:
        """Note that the law uses a measurement of *time* s."""
        interval, is_first = time - self._used, self._usual == 0.0
        self._usual += (1.0 if is_first else NEWEST) * (interval - self._usual)
        self._used = time

    def _pace_after(self, dt: float) -> float:
        """Return the pace of the reference after another *dt* s.

        It is held while measurements stay away for longer than usual. A rig that has stopped
        follows no command; when it catches up, it would move the load faster than the reference.
        """
        is_held = self.time - self._used > self._usual + LATE + self.period
        change = dt / STOPPING
        self._pace = max(self._pace - change, 0.0) if is_held else min(self._pace + change, 1.0)
        return self._pace

    def _start(self, reading: Measurement, now: float) -> None:
        """Start again at the present position and pressure of the load."""
        known = self.pressures if self.chambers is None else self.chambers
        self.law.start(reading.position, known)
        self.source.start(reading.position)
        self.time = now - self.period
        self._used, self._pace = reading.time - self._usual, 1.0
        self.state = RUNNING
        self.starts += 1

    def _stay_safe(self, now: float) -> Pressures | None:
        """Return the command without measurements: None before the first start."""
        if self.state == RUNNING:
            self.state = BLIND
        if self.state != BLIND or self.pressures is None:
            return None
        if self.safe == HOLD:
            return self.pressures
        if self.lost is None:
            self.lost, self._left = now, self.pressures
            self._vented, self._looked = 0.0, now
        if self.is_received:
            self._vented += now - self._looked
        self._looked = now
        self.pressures = self.vented(self._left, self._vented)
        is_over = self._has_left or self._vented > self.vent_time + VENTING
        return self.pressures if self.is_received and not is_over else None

    def vented(self, pressures: Pressures, time: float) -> Pressures:
        """Return the pressures in Pa that remain of *pressures* after *time* s of venting."""
        share = max(1.0 - time / self.vent_time, 0.0) if self.vent_time else 0.0
        return tuple(share * pressure for pressure in pressures)

    def leave(self) -> None:
        """Send no commands before the next measurement: the rig may have been replaced."""
        self._has_left = True


def warm_up(law: PositionLaw, reach: tuple[float, float], period: float) -> None:
    """Let *law* and trajectories compile and load all that they need, before control begins."""
    middle = 0.5 * (reach[0] + reach[1]) if isfinite(reach[0]) else 0.0
    for rest in ((), (0.0,), (0.0, 0.0)):  # each kind of interpolation
        ReferenceTrajectory(Reference(middle), Points.of([Point(1.0, middle, *rest)]), reach)
    law.start(middle)
    for _ in range(3):
        law.update(period, Reference(middle), middle)
