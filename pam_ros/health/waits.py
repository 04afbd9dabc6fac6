# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The lines in the log of ``pam_sim`` about a clock and about commands that are missing."""

import math
from typing import Any

from pam_ros.health.absence import Absence
from pam_ros.health.health import Level
from pam_ros.simulator.plant import Plant
from pam_ros.timing.interruption import steady_ns
from pam_ros.timing.pace import SECOND

RAMP = 0.5  # s of simulated time in which commands may still be those of a ramp from 0


class Waits:
    """Logs a line when the clock or a command is missing, and a line when it is received again.

    Checked once a second.
    """

    def __init__(self, logger: Any, plant: Plant, topic: str) -> None:
        """Write to *logger*, of rclpy; *topic* is the full name of the topic of commands."""
        self._plant, self._topic = plant, topic
        self._clock = Absence(logger, '/clock is received: simulated time passes')
        self._turn = Absence(logger, 'commands are received: simulated time passes', 0.0)
        self._first = Absence(logger, f'commands are received on {topic}')
        self._next = Absence(logger, 'commands are received again', 0.0, Level.WARN)
        self._high = Absence(logger, 'commands are higher now', RAMP, Level.WARN)

    def look(self, no_clock: str | None, no_turn: str) -> None:
        """Check the clock and, in lockstep, the commands: a sentence if missing, else ''.

        *no_clock* is None if the simulator does not follow a clock.
        """
        now = steady_ns() / SECOND
        if no_clock is None:
            self._clock.forget()
        else:
            self._clock.look(no_clock, now)
        # A controller that is sometimes slow is back only if the next check finds it, too.
        self._turn.look(no_turn, now, 0.5)

    def look_for_commands(self, missing: str) -> None:
        """Check for the first command, for the next one if they stopped, and for their unit.

        *missing* is a sentence on commands that have stopped, '' if all muscles are commanded.
        Both waits are measured in simulated time, like the timeout.
        """
        plant = self._plant
        is_commanded = not all(map(math.isnan, plant.commanded_at))
        first = (
            '' if is_commanded else f'waits for commands on {self._topic}: pressures do not change'
        )
        self._first.look(first, plant.time)
        if is_commanded:
            timeout = plant.setup.settings.command_timeout
            self._next.look(missing, plant.time, timeout, plant.timeouts)
            self._high.look(plant.low_commands, plant.time)
