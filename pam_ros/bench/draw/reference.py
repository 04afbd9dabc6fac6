# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""References that are drawn, with sizes in proportion to the reach of the joint."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from pam_ros.bench.draw.dice import Dice, digits

LEAST = 0.12  # share of the reach, of steps and motions
BEGIN = 1.0  # s, of the first motion
JUMPS = ('hold', 'step', 'staircase')


class Room(NamedTuple):
    """The positions, relative to the start, at which the load can be held; 0 is among them."""

    low: float
    high: float

    @property
    def width(self) -> float:
        """The difference of both."""
        return self.high - self.low

    @property
    def amplitude(self) -> float:
        """The largest amplitude of a sine."""
        return min(-self.low, self.high)


class Motion(NamedTuple):
    """A reference as in a scenario, and the time in s at which it is at rest, or may be judged."""

    content: dict[str, Any]
    end: float


def _level(dice: Dice, room: Room, at: float) -> float:
    """Return a position that differs from that *at* by LEAST of the reach."""
    least = LEAST * room.width
    below, above = max(at - least - room.low, 0.0), max(room.high - at - least, 0.0)
    if dice.between(0.0, below + above) < below:
        return dice.between(room.low, at - least)
    return dice.between(at + least, room.high)


def hold(dice: Dice, room: Room) -> Motion:
    """Return the position at the start."""
    return Motion({}, 0.0)


def step(dice: Dice, room: Room) -> Motion:
    """Return a step."""
    return Motion({'size': _level(dice, room, 0.0)}, BEGIN)


def staircase(dice: Dice, room: Room) -> Motion:
    """Return three to five steps."""
    levels, every = [0.0], dice.between(2.5, 4.0)
    for _ in range(dice.count(3, 5)):
        levels.append(_level(dice, room, levels[-1]))
    sizes = levels[1:]
    return Motion({'sizes': sizes, 'every': every}, BEGIN + every * (len(sizes) - 1))


def sine(dice: Dice, room: Room) -> Motion:
    """Return at least five periods of a sine, and at least 8 s."""
    amplitude = digits(room.amplitude * dice.between(0.1, 0.9))
    frequency = dice.decade(0.2, 2.5)
    content = {'amplitude': amplitude, 'frequency': frequency}
    return Motion(content, BEGIN + max(5.0 / frequency, 8.0))


def chirp(dice: Dice, room: Room) -> Motion:
    """Return a sweep from at most 0.3 Hz over three to four octaves."""
    low, time = dice.decade(0.1, 0.3), dice.between(12.0, 18.0)
    content = {
        'amplitude': digits(room.amplitude * dice.between(0.06, 0.5)),
        'frequency_low': low,
        'frequency_high': digits(low * dice.between(8.0, 16.0)),
        'sweep_time': time,
    }
    return Motion(content, BEGIN + time)


def minimum_jerk(dice: Dice, room: Room) -> Motion:
    """Return a motion of 0.5 to 3 s."""
    time = dice.decade(0.5, 3.0)
    return Motion({'size': _level(dice, room, 0.0), 'travel_time': time}, BEGIN + time)


def trajectory(dice: Dice, room: Room) -> Motion:
    """Return a path through four to eight points, 0.8 to 2.5 s apart."""
    times, positions = [BEGIN], [0.0]
    for _ in range(dice.count(4, 8)):
        times.append(digits(times[-1] + dice.between(0.8, 2.5)))
        positions.append(dice.between(room.low, room.high))
    return Motion({'times': times, 'positions': positions}, times[-1])


KINDS: Mapping[Callable[[Dice, Room], Motion], float] = {
    hold: 1.0,
    step: 2.0,
    staircase: 1.5,
    sine: 3.0,
    chirp: 1.0,
    minimum_jerk: 1.5,
    trajectory: 1.5,
}


def draw_score(dice: Dice, kind: str) -> str:
    """Return the score that decides for a *kind* of reference.

    Motions from rest to rest are judged by the way or by the end.
    """
    if kind in JUMPS:
        return 'error_at_rest'
    return 'rms_error' if kind in ('sine', 'chirp') or dice.chance(0.5) else 'error_at_rest'
