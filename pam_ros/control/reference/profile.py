# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The quickest motion to rest at zero within bounds of velocity, acceleration and jerk.

It starts from any position, velocity and acceleration, goes to a peak velocity, keeps it, and
comes to rest. Each change of velocity has at most three pieces of constant jerk. The distance of
the motion grows with the peak velocity, which is found by bisection.
"""

from math import copysign, sqrt
from typing import NamedTuple

HALVINGS = 60


class MotionLimits(NamedTuple):
    """Largest velocity m/s, acceleration m/s^2 and jerk m/s^3."""

    velocity: float
    acceleration: float
    jerk: float


class Piece(NamedTuple):
    """A constant jerk in m/s^3 for a while in s."""

    jerk: float
    duration: float


def change(
    velocity: float, acceleration: float, wanted: float, bounds: MotionLimits
) -> list[Piece]:
    """Return the pieces to the *wanted* velocity, with no acceleration at the end."""
    j, most = bounds.jerk, bounds.acceleration
    # The direction depends on the velocity that is reached if the acceleration is removed at once.
    straight = velocity + acceleration * abs(acceleration) / (2.0 * j)
    sign = 1.0 if wanted >= straight else -1.0
    gain, a = sign * (wanted - velocity), sign * acceleration
    peak = sqrt(max(j * gain + 0.5 * a * a, 0.0))
    along = 0.0
    if peak > most:
        peak = most
        # A start above the bound slows down to it, and covers distance meanwhile.
        first = (peak * peak - a * a) / (2.0 * j) * (1.0 if a <= peak else -1.0)
        along = max((gain - first - peak * peak / (2.0 * j)) / peak, 0.0)
    up = peak - a
    return [
        Piece(sign * copysign(j, up), abs(up) / j),
        Piece(0.0, along),
        Piece(-sign * j, peak / j),
    ]


def advance(state: tuple[float, float, float], jerk: float, t: float) -> tuple[float, ...]:
    """Return position, velocity and acceleration after *t* s of constant *jerk*."""
    x, v, a = state
    return (
        x + t * (v + t * (0.5 * a + t * jerk / 6.0)),
        v + t * (a + 0.5 * t * jerk),
        a + t * jerk,
    )


def _via_peak(
    state: tuple[float, float, float], peak: float, bounds: MotionLimits
) -> tuple[list[Piece], list[Piece], float]:
    """Return the pieces to a *peak* velocity and from there to rest, and their end position."""
    to = change(state[1], state[2], peak, bounds)
    back = change(peak, 0.0, 0.0, bounds)
    now: tuple[float, ...] = state
    for jerk, duration in (*to, *back):
        now = advance((now[0], now[1], now[2]), jerk, duration)
    return to, back, now[0]


def to_rest(state: tuple[float, float, float], bounds: MotionLimits) -> list[Piece]:
    """Return the pieces from *state* (m, m/s, m/s^2) to rest at 0."""
    for peak in (bounds.velocity, -bounds.velocity):
        to, back, end = _via_peak(state, peak, bounds)
        if end * peak <= 0.0:
            # The motion ends before the goal: the missing distance is covered at this velocity.
            return [*to, Piece(0.0, -end / peak), *back]
    low, high = -bounds.velocity, bounds.velocity
    for _ in range(HALVINGS):
        peak = 0.5 * (low + high)
        to, back, end = _via_peak(state, peak, bounds)
        low, high = (peak, high) if end < 0.0 else (low, peak)
    return [*to, *back]


class JerkLimitedMotion:
    """A motion along such pieces, step by step; at rest at 0 when it is over."""

    def __init__(self) -> None:
        """Rest at 0."""
        self.state = (0.0, 0.0, 0.0)
        self.jerk = 0.0
        self._pieces: list[Piece] = []

    def begin(self, state: tuple[float, float, float], bounds: MotionLimits) -> None:
        """Start from *state* (m, m/s, m/s^2) within *bounds*."""
        self.state = state
        self._pieces = to_rest(state, bounds)

    def follow(self, dt: float) -> tuple[float, float, float]:
        """Advance by *dt* s and return the state there."""
        self.jerk = 0.0
        while self._pieces and dt > 0.0:
            jerk, duration = self._pieces[0]
            t = min(duration, dt)
            x, v, a = advance(self.state, jerk, t)
            self.state, self.jerk = (x, v, a), jerk
            dt -= t
            if t < duration:
                self._pieces[0] = Piece(jerk, duration - t)
            else:
                del self._pieces[0]
        if not self._pieces:
            self.state, self.jerk = (0.0, 0.0, 0.0), 0.0
        return self.state
