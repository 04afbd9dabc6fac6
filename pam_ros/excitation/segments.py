# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The segments of which a programme can consist, with their levels and relative lengths.

In a joint of several muscles, the muscles move the joint together in the triangles and chirps,
muscles on opposite sides in opposite directions, as a controller commands them. In the steps and
the multisine each muscle has its own command, so that effects in one muscle are distinguished
from effects in another, and from effects on the joint.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from pam_ros.excitation import waves

Array = NDArray[np.float64]
Sides = Sequence[int]
AGAIN = (2, 5)  # part of the steps that are repeated at the end


@dataclass(frozen=True)
class Kind:
    """A segment: its share of the whole programme, what it shows, and its levels.

    ``levels(rate, duration, rng, fastest, sides)`` returns levels between 0 and 1,
    (round(rate * duration), muscles): rate and highest frequency in Hz, duration in s. *sides*
    has a number for each muscle: 1 if it moves the joint in the same direction as the first
    muscle, -1 if in the opposite direction.
    """

    share: float
    text: str
    levels: Callable[[float, float, Generator, float, Sides], Array]


def _steps(rate: float, duration: float, rng: Generator, _: float, sides: Sides) -> Array:
    """Return one staircase for all muscles, for each of them begun at another place.

    So only one muscle steps at a time, and muscles on opposite sides are at opposite ends at the
    same time, because the second half of the staircase is low where the first half is high.
    """
    stairs = waves.steps(rate, duration, rng)
    return np.column_stack(
        [
            _in_direction(np.roll(stairs, -round(i * stairs.size / len(sides))), i == 0 or s < 0)
            for i, s in enumerate(sides)
        ]
    )


def _first_steps(
    rate: float, duration: float, rng: Generator, fastest: float, sides: Sides
) -> Array:
    """Return the beginning of the steps, with the levels that a new generator gives."""
    part, whole = AGAIN
    all_steps = _steps(rate, duration * whole / part, rng, fastest, sides)
    return all_steps[: len(all_steps) * part // whole]


def _triangle(minor_loops: bool) -> Callable[[float, float, Generator, float, Sides], Array]:
    def levels(rate: float, duration: float, rng: Generator, _: float, sides: Sides) -> Array:
        wave = waves.triangle(rate, duration, rng, minor_loops=minor_loops)
        return np.column_stack([_in_direction(wave, s > 0) for s in sides])

    return levels


def _multisine(
    rate: float, duration: float, rng: Generator, fastest: float, sides: Sides
) -> Array:
    return waves.multisine(rate, duration, rng, fastest, len(sides))


def _chirps(rate: float, duration: float, _: Generator, fastest: float, sides: Sides) -> Array:
    """Return chirps in the directions of the muscles, with one mean level for all."""
    mean, sine = waves.chirp(rate, duration, fastest)
    return np.column_stack([mean + s * sine for s in sides])


def _in_direction(wave: Array, is_upward: bool) -> Array:
    return wave if is_upward else 1.0 - wave


SEGMENTS: Mapping[str, Kind] = MappingProxyType(
    {
        'steps': Kind(0.30, 'lag, dead time, damping, creep', _steps),
        'slow_triangle': Kind(0.24, 'hysteresis, friction, the static law', _triangle(True)),
        # The plain triangle has less than half the path length: this makes it four times as fast.
        'fast_triangle': Kind(0.0275, 'hysteresis against creep', _triangle(False)),
        'multisine': Kind(0.15, 'the whole range of frequencies', _multisine),
        'chirps': Kind(0.16, 'damping over pressure, lag against dead time, mass', _chirps),
        'steps_again': Kind(0.30 * AGAIN[0] / AGAIN[1], 'softening, warming, drift', _first_steps),
    }
)
