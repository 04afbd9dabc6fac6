# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The health of a running control loop, for its log and its diagnostics."""

from collections.abc import Callable

from pam_ros.control.loop import BLIND, RUNNING, WAITING, Loop
from pam_ros.health import controller
from pam_ros.health.health import Health
from pam_ros.health.reports import Reports
from pam_ros.health.tracking import Tracking
from pam_ros.settings.control import ControlSetup
from pam_ros.timing.interruption import steady_ns
from pam_ros.timing.loop_pacing import LoopPacing
from pam_ros.timing.pace import SECOND
from pam_ros.timing.ticker import Punctuality


class LoopHealth:
    """Says what a loop waits for, whether it keeps its rate, and how well it controls.

    ``fault`` is the reason why the law was stopped, ``blindness`` why the last joint state was not
    usable; '' if there is none.
    """

    def __init__(
        self,
        loop: Loop,
        setup: Callable[[], ControlSetup],
        pacing: LoopPacing,
        reports: Reports,
    ) -> None:
        """Watch *loop*, which has the settings of *setup*() and the *pacing*."""
        self._loop, self._setup, self._pacing, self._reports = loop, setup, pacing, reports
        self.fault = self.blindness = ''
        self._tracking = Tracking()
        self._commanded = 0  # since the last report

    def count_command(self) -> None:
        """Count a command that is sent."""
        self._commanded += 1

    def record_step(self) -> None:
        """Take the last step of the loop into account."""
        self._tracking.record(self._loop)

    def note_lateness(self, late: float) -> None:
        """Note that a joint state arrived *late* s late."""
        self._reports.delay(late)
        if late > self._setup().settings.state_timeout:
            self.blindness = controller.late(late)

    def trouble(self) -> str:
        """Return why the loop does not control, '' if it does."""
        did = self._setup().settings.on_timeout
        return controller.trouble(self._loop, did, self._unusable(), self.fault)

    def _unusable(self) -> str:
        """Return why the joint states that arrive are not usable, '' if they are."""
        stamp = self._pacing.repeated_stamp
        return self.blindness or ('' if stamp is None else controller.repeated(stamp))

    def log_missing_states(self) -> None:
        """Log once what control waits for, and once when it continues."""
        loop, now, why = self._loop, steady_ns() / SECOND, self.trouble()
        if loop.state in (WAITING, RUNNING):
            self._reports.wait(why, now)
        if loop.state in (BLIND, RUNNING):
            self._reports.miss(why, now, loop.timeout, loop.starts)

    def control(self) -> Health:
        """Return the health of the control since the last call."""
        self.log_missing_states()
        self._reports.follow(self._tracking.warning)
        received = self._reports.received(self._pacing.age, self._unusable())
        return controller.control(self._loop, self._setup(), received, self.fault)

    def timing(self, kept: Punctuality) -> Health:
        """Return the health of the rate, of which *kept* is the report since the last call."""
        commanded, self._commanded = self._commanded, 0
        return controller.timing(kept, commanded, self._pacing.wanted_rate)
