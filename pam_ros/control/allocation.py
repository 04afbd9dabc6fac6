# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Allocation: the pressures of the muscles for an effort, and for a stiffness if possible.

Muscles that pull in the same direction are a side, and have one pressure. With one side the effort
determines the pressure, and with it the stiffness. With two antagonistic sides, effort and
stiffness are both affine in the two pressures, so that desired values of both give two linear
equations for the pressures (:mod:`pam_ros.rig.pair`): co-contraction is their common mode. If the
limits of pressure do not allow both, the effort has priority.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import NamedTuple

from pam_ros.control.limits import MARGIN, Limits, clamp
from pam_ros.control.model import ControlModel
from pam_ros.control.muscle_model import MusclePlace
from pam_ros.control.stretch import PLACES, stretch
from pam_ros.errors import ParameterError, RangeError
from pam_ros.rig import pair, statics
from pam_ros.rig.pair import Line


class Split(NamedTuple):
    """Pressures of the muscles in Pa, and the part of the effort that they cannot give."""

    pressures: tuple[float, ...]
    short: float


class Allocation(ABC):
    """The pressures of the muscles of one joint.

    ``ranges`` are the lowest and highest pressure of each muscle in Pa. ``reach`` is the range of
    coordinates at which the load can be held, with a MARGIN of the range of pressure left at both
    ends. Raises ParameterError if there is no such range.
    """

    can_stiffen = False  # whether a stiffness can be chosen in addition to the effort
    reach: tuple[float, float]

    def __init__(self, model: ControlModel, limits: Limits) -> None:
        """Take the muscles' ranges within *limits*."""
        self.model = model
        self.ranges = tuple(limits.range_for(muscle) for muscle in model.joint.muscles)

    @abstractmethod
    def split(self, effort: float, stiffness: float, s: float) -> Split:
        """Return the pressures that give *effort*, and *stiffness* as nearly as possible."""

    @abstractmethod
    def rates(
        self, dt: float, foreseen: float, rate: float, stiffness: float, s: float
    ) -> tuple[float, ...]:
        """Return the rates of the pressures, Pa/s, while the joint moves along its reference.

        *foreseen* is the effort that the reference needs, and *rate* the required rate of the
        muscles' efforts at constant length; the spring along the reference is added to it.
        """

    def gains(self, s: float) -> tuple[float, ...]:
        """Return the effort per pressure of each muscle, arm dF/dp with its sign."""
        return self.model.at(s).gains

    def least(self, s: float) -> tuple[float, ...]:
        """Return the lowest pressures in Pa that have an effect at s."""
        return tuple(low for low, _ in self.ranges)

    @abstractmethod
    def available(self) -> float:
        """Return by how much the effort changes over the range of pressure, at mid travel."""

    @abstractmethod
    def stiffness_range(self, s: float) -> tuple[float, float]:
        """Return the least and the greatest stiffness that are possible while the load rests."""

    def start(self) -> None:
        """Start again without pressures of a former step."""
        return

    def refuse_stiffness(self, stiffness: float, s: float) -> None:
        """Raise RangeError, with the range, for a stiffness that is not possible at s."""
        low, high = self.stiffness_range(s)
        if not low <= stiffness <= high:
            unit = self.model.joint.transmission.equations
            raise RangeError(
                f'co-contraction {stiffness:.6g} {unit.effort_unit}/{unit.unit} is out of reach: '
                f'at {s:.4g} {unit.unit} this joint can have a stiffness of {low:.4g} to '
                f'{high:.4g} {unit.effort_unit}/{unit.unit}'
            )


class OneSide(Allocation):
    """Muscles that all pull in the same direction, with one pressure: that for the effort.

    It is not clamped to the limits. If slack is configured, it is not below the pressure at which
    the muscles become slack.
    """

    def __init__(self, model: ControlModel, limits: Limits) -> None:
        """Find the reach."""
        super().__init__(model, limits)
        self._may_be_slack = any(muscle.may_be_slack for muscle in model.muscles)
        self.reach = self._reach()

    def split(self, effort: float, stiffness: float, s: float) -> Split:
        """Return the pressure for *effort*, which determines the stiffness, too."""
        muscles = self.model.at(s).muscles
        if len(muscles) == 1:
            # The inverse of the force law itself, since the sums below round differently.
            return self._taut((muscles[0].pressure_for(effort / muscles[0].arm),), s)
        rest = gain = 0.0
        for muscle in muscles:
            rest += muscle.arm * muscle.force_law(0.0)
            gain += muscle.arm * muscle.gain
        return self._taut(((effort - rest) / gain,) * len(muscles), s)

    def _taut(self, pressures: tuple[float, ...], s: float) -> Split:
        """Return *pressures* not below those at which the muscles become slack, if configured.

        A lower pressure has no effect, and would have to rise first before they pull again.
        """
        if not self._may_be_slack:
            return Split(pressures, 0.0)
        least = self.least(s)
        taut = tuple(max(p, low) for p, low in zip(pressures, least, strict=True))
        cut = (p - q for p, q in zip(pressures, taut, strict=True))
        return Split(taut, sum(g * each for g, each in zip(self.gains(s), cut, strict=True)))

    def least(self, s: float) -> tuple[float, ...]:
        """Return the pressures in Pa at which the muscles become slack, or their lowest ones."""
        slack = min(muscle.slack_pressure() for muscle in self.model.at(s).muscles)
        return tuple(max(low, slack) for low, _ in self.ranges)

    def rates(
        self, dt: float, foreseen: float, rate: float, stiffness: float, s: float
    ) -> tuple[float, ...]:
        """Return the rate of the effort over the gain."""
        gains = self.gains(s)
        return (rate / sum(gains),) * len(gains)

    def available(self) -> float:
        """Return gain times range of pressure where the muscles are contracted by half."""
        total = 0.0
        for model, muscle in zip(self.model.muscles, self.model.joint.muscles, strict=True):
            y = 0.0 if muscle.is_load_only else 0.5 * muscle.kappa_max * muscle.l0
            arm = abs(model.arm(0.0))
            gain = MusclePlace(model, arm, y).gain
            total += arm * gain * (muscle.p_max - max(muscle.p_min, 0.0))
        return total

    def stiffness_range(self, s: float) -> tuple[float, float]:
        """Return the present stiffness as both the least and the greatest."""
        p = self.split(self.model.gravity(s), 0.0, s).pressures
        k = self.model.stiffness(p, s)
        return k, k

    def _reach(self) -> tuple[float, float]:
        joint = self.model.joint
        if joint.is_driven:
            return -float('inf'), float('inf')
        low = max(range_[0] for range_ in self.ranges)
        high = min(range_[1] for range_ in self.ranges)
        spare = MARGIN * (high - low)
        ends = [statics.equilibrium(joint, p) for p in (low + spare, high - spare)]
        bounds = statics.span(joint)
        found = max(min(ends), bounds[0]), min(max(ends), bounds[1])
        if self._may_be_slack:
            # If the force law would need a push, only gravity returns the load: an arm cannot be
            # held below the angle at which it hangs, nor a cart on a level track by one side.
            pressures = low + spare, high - spare
            found = stretch(found, lambda s: self._is_pulled(s, pressures)) or found[::-1]
        if found[0] >= found[1]:
            unit = joint.transmission.equations.unit
            these = 'the muscle permits' if len(joint.muscles) == 1 else 'the muscles permit'
            raise ParameterError(
                f'the load cannot be held anywhere: {low / 1e3:g} to {high / 1e3:g} kPa hold it '
                f'at {min(ends):.4g} to {max(ends):.4g} {unit}, {these} {bounds[0]:.4g} to '
                f'{bounds[1]:.4g} {unit}'
            )
        return found

    def _is_pulled(self, s: float, pressures: tuple[float, float]) -> bool:
        """Return whether the muscles can hold the load at s with pressures that have an effect."""
        model = self.model
        low, high = pressures
        least = tuple(max(low, p) for p in self.least(s))
        ends = sorted(model.effort(p, s) for p in (least, (high,) * len(model.muscles)))
        return ends[0] <= model.gravity(s) <= ends[1]


class TwoSides(Allocation):
    """Antagonistic muscles: those that a positive coordinate shortens, and the others."""

    can_stiffen = True

    def __init__(self, model: ControlModel, limits: Limits) -> None:
        """Find the sides and the reach."""
        super().__init__(model, limits)
        signs = [muscle.arm(0.0) > 0.0 for muscle in model.muscles]
        self._side_of = [0 if is_positive else 1 for is_positive in signs]
        self._sides = tuple(
            [i for i, side in enumerate(self._side_of) if side == which] for which in (0, 1)
        )
        one, two = (
            (max(self.ranges[i][0] for i in side), min(self.ranges[i][1] for i in side))
            for side in self._sides
        )
        self._within: tuple[pair.Limits, pair.Limits] = one, two
        (a, b), (c, d) = one, two
        spare = MARGIN * (b - a), MARGIN * (d - c)
        self._spare: tuple[pair.Limits, pair.Limits] = (
            (a + spare[0], b - spare[0]),
            (c + spare[1], d - spare[1]),
        )
        self._place = float('nan')
        self._lines: tuple[Line, Line]
        self._pulls: tuple[pair.Limits, pair.Limits]  # at the same place
        self._before: tuple[float, ...] | None = None
        self.reach = self._reach()

    def start(self) -> None:
        """Start again without pressures of a former step."""
        self._before = None

    def lines(self, s: float) -> tuple[Line, Line]:
        """Return effort and stiffness over pressure of both sides."""
        if s != self._place:  # a step asks for them at its reference several times
            one, two = (self._line(side, s) for side in self._sides)
            self._place, self._lines = s, (one, two)
            self._pulls = self._pulling(self._lines, self._within)
        return self._lines

    def _line(self, side: Sequence[int], s: float) -> Line:
        a = b = c = d = 0.0
        place = self.model.at(s)
        for i in side:
            muscle, turn, high = place.muscles[i], place.arm_slopes[i], self.ranges[i][1]
            r, force, gain = muscle.arm, muscle.force_law(0.0), muscle.gain
            soft, stiff = muscle.stiffness(0.0), muscle.stiffness(high)
            a += r * force
            b += r * gain
            c += r * r * soft - turn * force
            d += r * r * (stiff - soft) / high - turn * gain
        return Line(a, b, c, d)

    def _pulling(
        self, lines: tuple[Line, Line], ranges: tuple[pair.Limits, pair.Limits]
    ) -> tuple[pair.Limits, pair.Limits]:
        """Return the pressures of both sides at which they pull."""
        (one, two), ((a, b), (c, d)) = lines, ranges
        return (clamp(one.slack, a, b), b), (clamp(two.slack, c, d), d)

    def split(self, effort: float, stiffness: float, s: float) -> Split:
        """Return the pressures that give *effort*, and *stiffness* as nearly as possible.

        Pressures are within the limits and no muscle pushes.
        """
        one, two = lines = self.lines(s)
        within = self._pulls
        low, high = pair.piece(one, two, effort, within)
        if low <= high:
            p = clamp(pair.pressures(one, two, effort, stiffness)[0], low, high)
            q = clamp(pair.other(one, two, effort, p), *within[1])
            return Split(self._to_muscles(p, q), 0.0)
        ends = _ends(lines, within)
        p, q = ends[1] if effort > _given(lines, ends[1]) else ends[0]
        return Split(self._to_muscles(p, q), effort - _given(lines, (p, q)))

    def _to_muscles(self, p: float, q: float) -> tuple[float, ...]:
        return tuple([q if side else p for side in self._side_of])

    def rates(
        self, dt: float, foreseen: float, rate: float, stiffness: float, s: float
    ) -> tuple[float, ...]:
        """Return the rates of the predicted pressures since the previous step.

        If a limit holds one of them, the other one therefore changes faster.
        """
        ahead = self.split(foreseen, stiffness, s).pressures
        before, self._before = self._before or ahead, ahead
        return tuple([(now - then) / dt for now, then in zip(ahead, before, strict=True)])

    def available(self) -> float:
        """Return the greatest minus the least effort in the middle of the reach."""
        lines = self.lines(0.5 * (self.reach[0] + self.reach[1]))
        least, most = _ends(lines, self._pulls)
        return _given(lines, most) - _given(lines, least)

    def stiffness_range(self, s: float) -> tuple[float, float]:
        """Return the least and the greatest stiffness that are possible while the load rests.

        A MARGIN of the pressure is left. Both are equal if s is out of reach.
        """
        one, two = lines = self.lines(s)
        effort = self.model.gravity(s)
        low, high = pair.piece(one, two, effort, self._pulling(lines, self._spare))
        if low > high:
            low = high = self.split(effort, 0.0, s).pressures[self._sides[0][0]]
        k = sorted(pair.stiffness_at(one, two, effort, p) for p in (low, high))
        return k[0], k[1]

    def _reach(self) -> tuple[float, float]:
        low, high = statics.span(self.model.joint)
        places = [low + (high - low) * k / PLACES for k in range(PLACES + 1)]
        held = [self._is_held(s) for s in places]
        if not any(held):
            raise ParameterError(
                'the load cannot be held anywhere: check the limits of pressure, the load, and '
                'the mounting of the muscles (contraction_1, contraction_2)'
            )
        # The range without gaps that is nearest to the coordinate 0.
        middle = min((abs(s), k) for k, s in enumerate(places) if held[k])[1]
        first = last = middle
        while first > 0 and held[first - 1]:
            first -= 1
        while last < PLACES and held[last + 1]:
            last += 1
        return places[first], places[last]

    def _is_held(self, s: float) -> bool:
        one, two = lines = self.lines(s)
        within = self._pulling(lines, self._spare)
        low, high = pair.piece(one, two, self.model.gravity(s), within)
        return low <= high


def _given(lines: tuple[Line, Line], p: tuple[float, float]) -> float:
    return sum(line.a + line.b * each for line, each in zip(lines, p, strict=True))


def _ends(
    lines: tuple[Line, Line], within: tuple[pair.Limits, pair.Limits]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the pressures of the least and of the greatest effort."""
    (a, b), (c, d) = (
        (low, high) if line.b > 0.0 else (high, low)
        for line, (low, high) in zip(lines, within, strict=True)
    )
    return (a, c), (b, d)


def allocation_of(model: ControlModel, limits: Limits) -> Allocation:
    """Return the allocation for the muscles of a nominal joint."""
    signs = {muscle.arm(0.0) > 0.0 for muscle in model.muscles}
    return OneSide(model, limits) if len(signs) == 1 else TwoSides(model, limits)
