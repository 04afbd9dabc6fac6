# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A trajectory as a goal: whether a joint keeps to its path, and whether it reaches its end.

The rules are those of ``control_msgs/FollowJointTrajectory``, and where it leaves a choice, those
of the ``joint_trajectory_controller`` of ros2_control.
"""

from dataclasses import dataclass
from enum import Enum
from math import isfinite
from typing import NamedTuple

from pam_ros.control.reference.trajectory import ReferenceTrajectory
from pam_ros.control.signals import Reference
from pam_ros.errors import RangeError

ANY = -1.0  # a tolerance that permits every error, as 0 does: no other default is configured


class Outcome(Enum):
    """How a goal ends by itself, with the name of its ``error_code`` in the result."""

    REACHED = 'SUCCESSFUL'
    OFF_PATH = 'PATH_TOLERANCE_VIOLATED'
    MISSED = 'GOAL_TOLERANCE_VIOLATED'


class GoalOutcome(NamedTuple):
    """How a goal ended, and a sentence with the numbers that decided it."""

    outcome: Outcome
    text: str


@dataclass(frozen=True)
class Tolerance:
    """Largest errors of position and velocity, in m and m/s or rad and rad/s.

    0 and -1 permit every error. Raises RangeError for other values that are not above 0.
    """

    position: float = 0.0
    velocity: float = 0.0

    def __post_init__(self) -> None:
        """Check both values."""
        for name in ('position', 'velocity'):
            value = getattr(self, name)
            if not (isfinite(value) and (value >= 0.0 or value == ANY)):
                raise RangeError(
                    f'a tolerance of the {name} of {value:g} is not allowed: give a number above '
                    '0, or 0 or -1 for none'
                )

    def excess(self, error: Reference, unit: str) -> str:
        """Return which error is larger than it, in words with its *unit*; '' for none."""
        checks = (
            ('position', error.position, self.position, unit),
            ('velocity', error.velocity, self.velocity, f'{unit}/s'),
        )
        for name, value, most, of in checks:
            if most > 0.0 and not abs(value) <= most:
                return f'the error of the {name} is {value:.4g} {of}, more than {most:g} {of}'
        return ''


@dataclass(frozen=True)
class Tolerances:
    """What a goal asks for: *path* holds from the start of its trajectory to its end.

    From its end on, the goal is reached as soon as *end* holds, and missed if it does not within
    *goal_time_tolerance* s; with 0 s there is no limit. Raises RangeError for a time below 0.
    """

    path: Tolerance = Tolerance()
    end: Tolerance = Tolerance()
    goal_time_tolerance: float = 0.0

    def __post_init__(self) -> None:
        """Check the goal_time_tolerance."""
        if not self.goal_time_tolerance >= 0.0:
            raise RangeError(
                f'a goal_time_tolerance of {self.goal_time_tolerance:g} s is not allowed: give 0 '
                'or more'
            )


class Goal:
    """A trajectory that begins at *start* s, by the clock of the loop that follows it.

    Its coordinate is in *unit*, m or rad.
    """

    def __init__(
        self, trajectory: ReferenceTrajectory, start: float, unit: str, asked: Tolerances
    ) -> None:
        """Make it with the tolerances that are *asked* for."""
        self._trajectory, self._start, self._unit, self._asked = trajectory, start, unit, asked

    def since(self, now: float) -> float:
        """Return the time in s since the start of the trajectory, negative before it."""
        return now - self._start

    def target(self, now: float) -> Reference:
        """Return the desired state at *now* s, without an approach to the trajectory."""
        return self._trajectory.at(self.since(now))

    def judge(self, now: float, position: float, velocity: float) -> GoalOutcome | None:
        """Return how the goal ends at *now* s with the joint in this state; None if it goes on."""
        since, target = self.since(now), self.target(now)
        error = Reference(target.position - position, target.velocity - velocity)
        over = since - self._trajectory.duration
        if since < 0.0:
            return None
        if over < 0.0:
            excess = self._asked.path.excess(error, self._unit)
            text = f'{excess}, {since:.3g} s after the start'
            return GoalOutcome(Outcome.OFF_PATH, text) if excess else None
        after = f'{over:.3g} s after the end of the trajectory'
        excess = self._asked.end.excess(error, self._unit)
        if not excess:
            return GoalOutcome(Outcome.REACHED, f'reached {after}')
        if self._asked.goal_time_tolerance and over > self._asked.goal_time_tolerance:
            return GoalOutcome(Outcome.MISSED, f'{excess}, {after}')
        return None
