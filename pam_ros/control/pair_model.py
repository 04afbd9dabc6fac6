# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An antagonistic pair as a law sees it: torque, stiffness, their inverse, what can be had."""

from typing import NamedTuple

from pam_ros.control.inner_model import InnerModel
from pam_ros.control.limits import MARGIN, Limits
from pam_ros.errors import ParameterError, RangeError
from pam_ros.rig import pair
from pam_ros.rig.joint_model import JointModel
from pam_ros.rig.model import Load, RigModel
from pam_ros.rig.pair import Line

PLACES = 400  # of the travel at which the reach is looked for


class Split(NamedTuple):
    """Pressures of both muscles in Pa, and the torque in N m that they cannot give."""

    pressures: tuple[float, float]
    short: float


class PairModel:
    """The declared joint without memory: what holds at one instant.

    s is the angle in rad, p the gauge pressures in Pa in both chambers, v in rad/s. The muscles'
    damping and slack, the load's viscous friction and payload are in; effects with a memory are
    fed forward elsewhere. ``muscles`` are the rigs of each muscle alone, with its share of the
    inertia.

    ``reach`` are the angles at which the load can be held, with a MARGIN of the range of pressure
    left at both ends of both muscles and none pushing. Raises ParameterError where there is none.
    """

    weight = 0.0  # gravity depends on the angle, and is part of the pull

    def __init__(self, model: JointModel, limits: Limits | None = None) -> None:
        """Take the numbers out of *model*."""
        limits = limits or Limits()
        self.model = model
        self.mass = model.inertia
        self.moved_mass = model.moved_mass
        self.muscles = tuple(
            RigModel(a.muscle, Load(1.0, 'horizontal'), a.effects) for a in model.actuators
        )
        self.ranges = tuple(limits.range_for(muscle) for muscle in self.muscles)
        self._joint, self._g = model.joint, model.geometry
        self._inner = tuple(InnerModel(muscle) for muscle in self.muscles)
        for i, inner in enumerate(self._inner):
            arm = self._joint.arm(0.0, i, self._g)
            inner.mass = self.mass / (len(self._inner) * arm * arm)
        self._spare = tuple(
            (low + MARGIN * (high - low), high - MARGIN * (high - low))
            for low, high in self.ranges
        )
        self._slack = [a.effects.get('slack', {}).get('share', 0.0) for a in model.actuators]
        self._viscous = model.effects.get('viscous_friction', {}).get('coefficient', 0.0)
        self._place, self._lines = 0.0, (self._line(0.0, 0), self._line(0.0, 1))
        self.reach = self._reach()

    def position(self, s: float, i: int) -> float:
        """Return where muscle i is, in m."""
        return self._joint.position(s, i, self._g)

    def arm(self, s: float, i: int) -> float:
        """Return how fast muscle i shortens with the angle, in m/rad."""
        return self._joint.arm(s, i, self._g)

    def gravity(self, s: float) -> float:
        """Return the torque in N m that holds the load against gravity."""
        return self.mass * self._joint.fall(s, self.moved_mass, self.mass, self._g)

    def gravity_stiffness(self, s: float) -> float:
        """Return the stiffness in N m/rad that gravity adds."""
        return self.mass * self._joint.fall_slope(s, self.moved_mass, self.mass, self._g)

    def lines(self, s: float) -> tuple[Line, Line]:
        """Return effort and stiffness over pressure of both muscles."""
        if s != self._place:  # a step asks for them at its reference several times
            self._place, self._lines = s, (self._line(s, 0), self._line(s, 1))
        return self._lines

    def _line(self, s: float, i: int) -> Line:
        inner, r, y = self._inner[i], self.arm(s, i), self.position(s, i)
        high = self.ranges[i][1]
        k, stiffest = inner.stiffness(0.0, y), inner.stiffness(high, y)
        square = r * r
        return Line(
            r * inner.force(0.0, y),
            r * inner.gain(y),
            square * k,
            square * (stiffest - k) / high,
        )

    def force(self, p: float, s: float, i: int) -> float:
        """Return what muscle i pulls at rest in N; where it is declared slack, no push."""
        force = self._inner[i].force(p, self.position(s, i))
        return force if force > 0.0 else (1.0 - self._slack[i]) * force

    def effort(self, p: tuple[float, float], s: float) -> float:
        """Return what the muscles pull the joint with at rest, N m."""
        return sum(self.arm(s, i) * self.force(each, s, i) for i, each in enumerate(p))

    def stiffness(self, p: tuple[float, float], s: float) -> float:
        """Return the stiffness in N m/rad that the muscles give the joint."""
        one, two = self.lines(s)
        return one.c + one.d * p[0] + two.c + two.d * p[1]

    def damping(self, p: tuple[float, float], s: float, v: float) -> float:
        """Return the joint's damping in N m s/rad."""
        total = self._viscous
        for i, inner in enumerate(self._inner):
            r = self.arm(s, i)
            total += r * r * inner.damping(p[i], self.position(s, i), r * v)
        return total

    def pull(self, p: tuple[float, float], s: float, v: float) -> float:
        """Return the torque in N m on the load: muscles, damping and gravity."""
        total = -self.gravity(s) - self._viscous * v
        for i, inner in enumerate(self._inner):
            r = self.arm(s, i)
            y, w = self.position(s, i), r * v
            total += r * (self.force(p[i], s, i) - inner.damping(p[i], y, w) * w)
        return total

    # The inverse -----------------------------------------------------------------------------

    @staticmethod
    def _within(
        lines: tuple[Line, Line], ranges: tuple[pair.Limits, ...]
    ) -> tuple[pair.Limits, pair.Limits]:
        """Return the pressures of both muscles at which they pull."""
        one, two = (
            (min(max(low, line.slack), high), high)
            for line, (low, high) in zip(lines, ranges, strict=True)
        )
        return one, two

    def split(self, effort: float, stiffness: float, s: float) -> Split:
        """Return the pressures that give *effort*, and *stiffness* as nearly as can be.

        Explicit: see :mod:`pam_ros.rig.pair`. Pressures are within the limits and no muscle
        pushes; where the limits do not leave both, the effort comes first.
        """
        one, two = lines = self.lines(s)
        within = self._within(lines, self.ranges)
        low, high = pair.piece(one, two, effort, within)
        if low <= high:
            p = min(max(pair.pressures(one, two, effort, stiffness)[0], low), high)
            q = min(max(pair.other(one, two, effort, p), within[1][0]), within[1][1])
            return Split((p, q), 0.0)
        ends = self._ends(lines, within)
        p, q = ends[1] if effort > self._given(lines, ends[1]) else ends[0]
        return Split((p, q), effort - self._given(lines, (p, q)))

    @staticmethod
    def _given(lines: tuple[Line, Line], p: tuple[float, float]) -> float:
        return sum(line.a + line.b * each for line, each in zip(lines, p, strict=True))

    @staticmethod
    def _ends(
        lines: tuple[Line, Line], within: tuple[pair.Limits, pair.Limits]
    ) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the pressures of the least and of the greatest effort."""
        (a, b), (c, d) = (
            (low, high) if line.b > 0.0 else (high, low)
            for line, (low, high) in zip(lines, within, strict=True)
        )
        return (a, c), (b, d)

    def efforts(self, s: float) -> tuple[float, float]:
        """Return the least and the greatest torque in N m that the muscles can give at s."""
        lines = self.lines(s)
        least, most = self._ends(lines, self._within(lines, self.ranges))
        return self._given(lines, least), self._given(lines, most)

    def stiffness_range(self, s: float) -> tuple[float, float]:
        """Return the least and the greatest stiffness in N m/rad that can be had while it rests.

        With the MARGIN left; equal where s is out of reach.
        """
        one, two = lines = self.lines(s)
        effort = self.gravity(s)
        low, high = pair.piece(one, two, effort, self._within(lines, self._spare))
        if low > high:
            low = high = self.split(effort, 0.0, s).pressures[0]
        k = sorted(pair.stiffness_at(one, two, effort, p) for p in (low, high))
        return k[0], k[1]

    def refuse_stiffness(self, stiffness: float, s: float) -> None:
        """Raise RangeError, with the range, for a stiffness that cannot be had at s rad."""
        low, high = self.stiffness_range(s)
        if not low <= stiffness <= high:
            raise RangeError(
                f'co-contraction {stiffness:.6g} N m/rad is out of reach: at {s:.4g} rad this '
                f'joint can have a stiffness of {low:.4g} to {high:.4g} N m/rad'
            )

    def _reach(self) -> tuple[float, float]:
        low, high = self.model.travel
        places = [low + (high - low) * k / PLACES for k in range(PLACES + 1)]
        held = [self._is_held(s) for s in places]
        if not any(held):
            raise ParameterError(
                'the load cannot be held anywhere: mend the limits of pressure, the load, or how '
                'the muscles are hung up (contraction_1, contraction_2)'
            )
        # The stretch in one piece that is nearest to 0.
        middle = min(
            (abs(s), k) for k, (s, is_held) in enumerate(zip(places, held, strict=True)) if is_held
        )[1]
        first = last = middle
        while first > 0 and held[first - 1]:
            first -= 1
        while last < PLACES and held[last + 1]:
            last += 1
        return places[first], places[last]

    def _is_held(self, s: float) -> bool:
        one, two = lines = self.lines(s)
        low, high = pair.piece(one, two, self.gravity(s), self._within(lines, self._spare))
        return low <= high
