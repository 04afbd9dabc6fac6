# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The lines in the log of ``pam_sim`` about effects that begin to act while it runs."""

from itertools import pairwise
from typing import Any

from pam_ros.rig.changes import appeared
from pam_ros.settings.scene import SimulationSetup
from pam_ros.simulator.plant import Plant


class Onsets:
    """Logs one line for each effect that has begun to act; checked once a second."""

    def __init__(self, logger: Any, plant: Plant) -> None:
        """Write to *logger*, of rclpy."""
        self._logger, self._plant = logger, plant
        self._last = 0.0  # simulated s of the last check
        self._setup, self._begins = plant.setup, begins(plant.setup)

    def look(self) -> None:
        """Write a line for each effect that has begun to act since the last call."""
        now, setup = self._plant.time, self._plant.setup
        if setup is not self._setup:
            self._setup, self._begins = setup, begins(setup)
        last = self._last if self._last <= now else 0.0  # simulated time started again
        self._last = now
        for time, name in self._begins:
            if last < time <= now:
                self._logger.info(f'{name} acts from {time:g} s of simulated time on')


def begins(setup: SimulationSetup) -> list[tuple[float, str]]:
    """Return when effects begin after the start, in s, and their names, in the order of time."""
    found = []
    muscles = iter(setup.muscle_names)
    for joint, joint_name in zip(setup.joints, setup.joint_names, strict=True):
        rows = [joint_name, *(next(muscles) for _ in joint.actuators)]
        is_one = len(setup.muscles) == 1
        for (_, before), (time, after) in pairwise(joint.stages):
            for row, effects in zip(rows, appeared(before, after), strict=True):
                whose = '' if is_one else f'{row}.'
                found += [(time, f'{whose}effects.{effect.name}') for effect in effects]
    return sorted(found)
