# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The reference of the load: rest, set positions or a trajectory, always without a jump."""

from copy import deepcopy
from math import isfinite
from typing import NamedTuple

from pam_ros.control.limits import clamp, range_text, refuse_unreachable
from pam_ros.control.reference.points import Points
from pam_ros.control.reference.shaping import Shape, Shaper
from pam_ros.control.reference.trajectory import ReferenceTrajectory
from pam_ros.control.signals import Reference
from pam_ros.errors import RangeError

# s between a start and a target: without it, the target would count as a sample of a motion, with
# a velocity.
INSTANT = 1e-6


MOST_WAITING = 1000  # trajectories that can wait for their start


class _Waiting(NamedTuple):
    """A trajectory that begins after *wait* s."""

    trajectory: ReferenceTrajectory
    wait: float


class ReferenceSource:
    """Makes one reference from all targets that are set; the newest target counts."""

    def __init__(self, shape: Shape, reach: tuple[float, float], unit: str = 'm') -> None:
        """Make it for a load that can be held within *reach* (lowest, highest), in *unit*.

        Raises ParameterError where *shape* is in the other unit, m or rad.
        """
        shape.require(revolute=unit == 'rad')
        self.reach, self.unit = reach, unit
        self._shaper = Shaper(shape)
        self._trajectory: ReferenceTrajectory | None = None
        self._since = 0.0  # s since the start of this trajectory
        self._next: list[_Waiting] = []  # trajectories that begin later, in this order
        self.targets = 0  # how many have been set: whoever set one knows whether it still counts
        self._start = 0.5 * (reach[0] + reach[1]) if isfinite(reach[0]) else 0.0

    @property
    def reference(self) -> Reference:
        """The desired position now; within the reach, or between it and the start position."""
        reference = self._shaper.reference
        low, high = min(self.reach[0], self._start), max(self.reach[1], self._start)
        if low <= reference.position <= high:
            return reference
        # A stream of positions is extrapolated, which can go beyond the positions that were set.
        return Reference(min(max(reference.position, low), high))

    @property
    def is_on_trajectory(self) -> bool:
        """Whether a trajectory is followed, or waits for its start."""
        return self._trajectory is not None or bool(self._next)

    def start(self, position: float) -> None:
        """Hold the load at *position* m; the target before does not matter."""
        self._trajectory, self._next = None, []
        self._start = position
        self._shaper.start(position)
        self.targets += 1

    def reaches(self, position: float) -> bool:
        """Return whether the load can be held at *position* m."""
        return self.reach[0] <= position <= self.reach[1]

    def succeed(self, before: 'ReferenceSource', position: float) -> str:
        """Continue after the source *before*, whose reach may differ, with the load at *position*.

        Return a sentence if its reference is out of the new reach, else ''. The reference remains
        where it is if both reaches contain it. Otherwise the load may not have followed it, and a
        reference that remained there would throw the load when it can follow again: the reference
        starts at the load, and goes to the nearest position within reach.
        """
        now, target = before.reference.position, before.target
        if before.reaches(now) and self.reaches(now):
            self.start(now)
            return ''
        self.start(position)
        if not before.reaches(now) and not before.reaches(target):
            return ''  # control began at a load that rests out of reach: it stays there
        self.follow(INSTANT)
        self.set_target(clamp(position, *self.reach))
        if self.reaches(now):
            return ''
        return (
            f'reference {now:.6g} {self.unit} is out of reach with the changed parameters: '
            f'{range_text(self.reach, self.unit)}; the reference starts at the position of the '
            f'load, {position:.6g} {self.unit}'
        )

    @property
    def target(self) -> float:
        """The position to which the reference goes, or that of the trajectory now, m."""
        if self._trajectory is not None:
            return self._trajectory.at(self._since).position
        return self._shaper.target

    def set_shape(self, shape: Shape) -> None:
        """Continue within other bounds; ParameterError as for a new one."""
        shape.require(revolute=self.unit == 'rad')
        self._shaper.set_shape(shape)

    def set_target(self, position: float, ago: float = 0.0) -> None:
        """Take a target in m that was set *ago* s ago; raises RangeError out of reach."""
        if not isfinite(position):
            raise RangeError(
                f'reference {position} is not a valid position: '
                f'{range_text(self.reach, self.unit)}'
            )
        refuse_unreachable(position, self.reach, self.unit)
        self._next = []
        if self._trajectory is not None:
            self._leave()
        self._shaper.take(position, ago)
        self.targets += 1

    def stop(self) -> None:
        """Come to rest as soon as the bounds allow."""
        self._leave()
        self.targets += 1

    def play(self, points: Points, wait: float = 0.0) -> ReferenceTrajectory:
        """Follow *points* after *wait* s, or from a place between them if *wait* is negative.

        Until then the present motion continues, also through trajectories that begin before. Those
        that would begin later are replaced. Returns the trajectory through the points. Raises
        RangeError for points that give no motion within reach, and if too many trajectories wait;
        then nothing changes.
        """
        before = [one for one in self._next if one.wait < wait]
        if len(before) == MOST_WAITING:
            raise RangeError(
                f'{MOST_WAITING} trajectories wait for their start: give no more before one begins'
            )
        trajectory = ReferenceTrajectory(self._ahead(wait, before), points, self.reach, self.unit)
        if wait > 0.0:
            self._next = [*before, _Waiting(trajectory, wait)]
        else:
            self._next = []
            self._begin(trajectory, -wait)
        self.targets += 1
        return trajectory

    def _ahead(self, wait: float, before: list['_Waiting']) -> Reference:
        """Return the reference after *wait* s; trajectories *before* that time begin meanwhile."""
        if wait <= 0.0:
            return self.reference
        if before:
            return before[-1].trajectory.at(wait - before[-1].wait)
        if self._trajectory is not None:
            return self._trajectory.at(self._since + wait)
        return deepcopy(self._shaper).follow(wait)

    def _begin(self, trajectory: ReferenceTrajectory, since: float) -> None:
        """Follow *trajectory*, which began *since* s ago."""
        self._trajectory, self._since = trajectory, since
        self._shaper.join(trajectory.at(since))

    def _begin_due(self, dt: float) -> None:
        """Let *dt* s pass for the trajectories that wait, and begin those that are due."""
        self._next = [one._replace(wait=one.wait - dt) for one in self._next]
        while self._next and self._next[0].wait <= 0.0:
            due = self._next.pop(0)
            self._begin(due.trajectory, -due.wait)

    def _leave(self) -> None:
        """Come to rest as soon as the bounds allow."""
        self._trajectory, self._next = None, []
        self._shaper.stop()

    def follow(self, dt: float, late: float = 0.0, pace: float = 1.0) -> Reference:
        """Return the reference after another *dt* s.

        *late* s passed before that without a step. The trajectory continued in this time, as those
        of the other joints of the robot do; the reference catches up within the bounds.

        *pace*, 0 to 1, slows the approach to a target; 0 holds it. A trajectory, and a target that
        is set again and again as one that moves, have times of their own and are not slower: the
        reference would have to catch up, and would be faster than was wanted.
        """
        self._follow_present(dt, late, pace)
        if self._next:
            self._begin_due(dt + late)
        return self.reference

    def _follow_present(self, dt: float, late: float, pace: float) -> None:
        """Advance by *dt* s along the trajectory or the approach that is followed at present."""
        if self._trajectory is None:
            self._shaper.follow(dt, pace)
            return
        self._since += dt + late
        now = self._trajectory.at(self._since)
        if late > 0.0:
            self._shaper.join(now)
        self._shaper.along(dt, now, pace)
        if self._since >= self._trajectory.duration:
            self._shaper.rest_at(now.position)
            self._trajectory = None
