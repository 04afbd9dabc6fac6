# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The desired stiffness of a joint with antagonistic muscles, and how it is approached."""

from dataclasses import dataclass

from pam_ros.constructors import RefusesUnknownNames
from pam_ros.control.allocation import Allocation
from pam_ros.control.reference.profile import JerkLimitedMotion, MotionLimits
from pam_ros.parameters import check_all, parameter_field

RISE = 0.05  # s, to reach the rate, and also its slope: some three samples of a 50 Hz topic


@dataclass(frozen=True)
class CoContraction(metaclass=RefusesUnknownNames):
    """The desired stiffness of a joint, and how fast it may change.

    In N/m, or N m/rad of a revolute joint.
    """

    co_contraction: float = parameter_field(
        0.0,
        'stiffness that the muscles give the joint until a value is received on '
        'co_contraction_reference; 0: the middle of the range at the middle of the reach',
        'N/m',
        low=0.0,
        high=1e6,
    )
    co_contraction_rate: float = parameter_field(
        100.0,
        'rate at which another stiffness is approached',
        'N/(m s)',
        low=0.0,
        high=1e6,
        above_low=True,
    )

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)

    def wanted(self, allocation: Allocation) -> float:
        """Return the stiffness to begin with, in N/m, or N m/rad for a revolute joint.

        *allocation* is that of the joint. 0 if the effort determines the stiffness, as with
        one muscle; the middle of the possible range if ``co_contraction`` is 0. Raises RangeError
        if ``co_contraction`` is not possible in the middle of the reach.
        """
        if not allocation.can_stiffen:
            return 0.0
        middle = 0.5 * (allocation.reach[0] + allocation.reach[1])
        if self.co_contraction == 0.0:
            low, high = allocation.stiffness_range(middle)
            return 0.5 * (low + high)
        allocation.refuse_stiffness(self.co_contraction, middle)
        return self.co_contraction


class StiffnessReference:
    """Moves the stiffness to the value that was set last, within bounds; N/m or N m/rad."""

    def __init__(self, goal: float, rate: float) -> None:
        """Rest at *goal*; approach others at *rate* a second."""
        self.goal, self.rate = goal, rate
        self._offset = JerkLimitedMotion()
        self._is_new = False

    @property
    def stiffness(self) -> float:
        """The desired stiffness now."""
        return self.goal + self._offset.state[0]

    @property
    def is_moving(self) -> bool:
        """Whether the stiffness has not reached the goal yet."""
        return self._is_new or any(self._offset.state)

    def start(self, stiffness: float) -> None:
        """Start again at rest at *stiffness*, and approach the goal."""
        self._offset.state = (stiffness - self.goal, 0.0, 0.0)
        self._is_new = True

    def set_goal(self, goal: float) -> None:
        """Approach another *goal*."""
        x, v, a = self._offset.state
        self._offset.state = (x + self.goal - goal, v, a)
        self.goal = goal
        self._is_new = True

    def set_rate(self, rate: float) -> None:
        """Approach the goal at another *rate* a second, from the next goal on."""
        self.rate = rate

    def follow(self, dt: float) -> float:
        """Return the stiffness after another *dt* s."""
        if self._is_new:
            # The profile is computed once a step, however often the goal is set.
            slope = self.rate / RISE
            self._offset.begin(self._offset.state, MotionLimits(self.rate, slope, slope / RISE))
            self._is_new = False
        self._offset.follow(dt)
        return self.stiffness
