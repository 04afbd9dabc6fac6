# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Bring a load that sticks and slips to its goal by measured pushes.

If friction falls when the load begins to slide, every integral causes a limit cycle: the load
sticks next to the goal, is pulled until it breaks loose, slips past the goal and sticks on the
other side. Such breaks, in alternating directions, give the forces of this cycle: the middle
force, at which the load would stay at rest, and the force that breaks it loose. From then on the
load is pushed from the middle force until it breaks loose. The push is removed as soon as the
remaining slide will bring the load to the goal (after Popovic, Gorinevsky & Goldenberg 2000, who
fix the pushes beforehand). In the end the load rests at the middle force, without a resulting
force.
"""

from dataclasses import dataclass
from math import copysign, exp

from pam_ros.control.tuning import number


@dataclass(frozen=True)
class StictionTuning:
    """How stick-slip is distinguished from other motion, and how pushes are made."""

    tolerance: float = number(
        1.5, '', 'rest tolerances that a load which sticks may be off the goal: control, friction'
    )
    loose_displacement: float = number(
        60e-6,
        'm',
        'displacement that distinguishes a slip from a bent contact: three times the noise, and '
        'beyond the default presliding of 10 um',
    )
    loose_speed: float = number(
        4e-3, 'm/s', 'speed of a slip, above the noise of the filtered speed: control, friction'
    )
    see: float = number(0.008, 's', 'filter of the position: four samples at 500 Hz')
    see_speed: float = number(0.012, 's', 'filter of the speed: six samples')
    anchor: float = number(0.3, 's', 'filter of the sticking position: longer than a slip lasts')
    rest: float = number(0.06, 's', 'filter of the position at rest: 30 samples')
    turns: int = number(3, '', 'breaks in turn that are a limit cycle: fewer may be a disturbance')
    lasting: float = number(0.5, '', 'least ratio of the last break to the first one')
    dwell: float = number(0.08, 's', 'at rest before a slip that is a break: control, friction')
    calm: float = number(0.25, 's', 'after a push until the error is evaluated: a period of 4 Hz')
    quick: float = number(2.0, '1/s', 'loading in breaking forces a second, up to *near* of one')
    careful: float = number(0.6, '1/s', 'loading beyond that: control, friction at rest')
    near: float = number(0.75, '', 'breaking forces up to which loading is quick')
    too_much: float = number(2.0, '', 'breaking forces at which the friction has changed')
    reaction: float = number(
        0.03, 's', 'for which a slide continues after a push is removed: first value, then learned'
    )
    longest_reaction: float = number(0.3, 's', 'largest learned value: a period of 4 Hz')
    patience: int = number(6, '', 'pushes after which the tolerance doubles')
    relapse: float = number(1.6, '', 'tolerances up to which a load at its goal may drift')
    stuck: float = number(2.0, '', 'stiffness, in muscles, that counts as sticking')


class Stiction:
    """Gives the force to apply instead of that of the law, while it is active."""

    def __init__(self, tolerance: float, tuning: StictionTuning) -> None:
        """Take *tuning.tolerance* times the rest *tolerance*; all is in the joint's units."""
        self.tolerance, self._tuning = tuning.tolerance * tolerance, tuning
        self.start()

    def start(self) -> None:
        """Start again without knowledge of sticking."""
        self.is_active = False
        self._x = self._v = self._anchor = self._mean = 0.0
        self._is_new = True
        self._stuck = False
        self._dwelt = 0.0
        self._breaks: list[tuple[float, float, float]] = []  # side, force, position
        self._middle = self._breaking = 0.0
        self._force = 0.0
        self._side = 0.0  # direction of the push, 0 when there is none
        self._is_loose = False
        self._calm = 0.0
        self._reaction = self._tuning.reaction
        self._expected = self._speed = 0.0
        self._pushes = 0
        self._wide = self.tolerance
        self._is_content = False

    def follow(self, dt: float, error: float, force: float, stiffness: float) -> float | None:
        """Advance by *dt* s under a resting reference; return the force in N to apply, or None.

        *error* is the measured error in m, *force* the force of the law, and *stiffness* the
        apparent stiffness of the load over that of the muscle.
        """
        self._see(dt, -error)
        slipped = self._has_slipped()
        if not self.is_active:
            self._stuck = self._stuck or stiffness > self._tuning.stuck
            if slipped or self._has_slid_past():
                towards_goal = self._displacement * self._anchor < 0.0
                if self._stuck and self._dwelt > self._tuning.dwell and towards_goal:
                    self._note_break(force)
                self._anchor, self._dwelt = self._x, 0.0
            return self._force if self.is_active else None
        self._push(dt, slipped)
        return self._force

    def _see(self, dt: float, x: float) -> None:
        """Filter the position, its speed, and the position at which the load sticks."""
        if self._is_new:
            self._x = self._anchor = x
            self._is_new = False
        displacement = (1.0 - exp(-dt / self._tuning.see)) * (x - self._x)
        self._x += displacement
        self._v += (1.0 - exp(-dt / self._tuning.see_speed)) * (displacement / dt - self._v)
        if abs(self._v) < self._tuning.loose_speed:
            self._anchor += (1.0 - exp(-dt / self._tuning.anchor)) * (self._x - self._anchor)
        if abs(self._v) < 0.5 * self._tuning.loose_speed:
            self._dwelt += dt

    @property
    def _displacement(self) -> float:
        """Displacement in m from where the load has stuck."""
        return self._x - self._anchor

    @property
    def _is_displaced(self) -> bool:
        """Whether the load is farther from there than a contact bends."""
        return abs(self._displacement) > self._tuning.loose_displacement

    def _has_slipped(self) -> bool:
        """Return whether the load slips fast."""
        is_fast = abs(self._v) > self._tuning.loose_speed
        return self._is_displaced and is_fast and self._displacement * self._v > 0.0

    def _has_slid_past(self) -> bool:
        """Return whether a slow slide has brought the load past its goal."""
        return self._is_displaced and self._x * self._anchor < 0.0

    def _note_break(self, force: float) -> None:
        """Record a break; begin to push at the third one in a limit cycle that lasts."""
        side = copysign(1.0, self._displacement)
        self._stuck = False
        if self._breaks and self._breaks[-1][0] == side:
            self._breaks.clear()
        self._breaks.append((side, force, abs(self._anchor)))
        if len(self._breaks) < self._tuning.turns:
            return
        (_, _, first), (_, other, _), (_, _, last) = self._breaks[-self._tuning.turns :]
        if last > self._tuning.lasting * first and side * (force - other) > 0.0:
            self._middle = 0.5 * (force + other)
            self._breaking = 0.5 * abs(force - other)
            self._force, self._side, self._is_loose = force, side, True
            self.is_active = True

    def _push(self, dt: float, slipped: bool) -> None:
        """Load, wait for the slip and remove the push in time, or rest."""
        if self._side == 0.0:
            self._rest(dt)
            return
        ahead = self._side * (self._x + self._v * self._reaction)
        self._is_loose = self._is_loose or slipped
        if ahead >= 0.0 or (self._is_loose and self._v * self._side <= 0.0):
            self._expected, self._speed = self._x + self._v * self._reaction, self._v
            self._end_push()
            return
        if self._is_loose:
            return
        loaded = self._side * (self._force - self._middle)
        rate = (
            self._tuning.quick
            if loaded < self._tuning.near * self._breaking
            else self._tuning.careful
        )
        self._force += self._side * rate * self._breaking * dt
        if loaded > self._tuning.too_much * self._breaking:
            self.start()  # the friction has changed: the law continues

    def _end_push(self) -> None:
        self._force, self._side, self._is_loose = self._middle, 0.0, False
        self._calm = 0.0
        self._pushes += 1

    def _rest(self, dt: float) -> None:
        """Wait until the load rests, learn how long it slid, and push again if necessary."""
        self._calm += dt
        if self._calm < self._tuning.calm:
            self._anchor = self._mean = self._x
            return
        self._mean += (1.0 - exp(-dt / self._tuning.rest)) * (self._x - self._mean)
        if self._calm < self._tuning.calm + self._tuning.rest:
            return
        if self._speed != 0.0:
            # The time for which the speed lasted longer than expected corrects the next push.
            late = (self._mean - self._expected) / self._speed
            self._reaction = min(
                max(self._reaction + 0.5 * late, 0.0), self._tuning.longest_reaction
            )
            self._speed = 0.0
        if self._pushes % self._tuning.patience == 0 and self._pushes:
            self._wide = self.tolerance * 2.0 ** (self._pushes // self._tuning.patience)
        allowed = self._tuning.relapse * self._wide if self._is_content else self._wide
        self._is_content = abs(self._mean) <= allowed
        if not self._is_content:
            self._side = copysign(1.0, -self._mean)
