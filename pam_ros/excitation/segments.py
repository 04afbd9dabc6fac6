# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The segments of which a programme can consist, with their waves and relative lengths."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from pam_ros.excitation import waves

Array = NDArray[np.float64]
AGAIN = (2, 5)  # part of the steps that are repeated at the end


@dataclass(frozen=True)
class Kind:
    """A segment: its share of the whole programme, what it shows, and its wave.

    ``wave(rate, duration, rng, fastest)`` returns levels between 0 and 1, (round(rate *
    duration),): rate and highest frequency in Hz, duration in s.
    """

    share: float
    text: str
    wave: Callable[[float, float, Generator, float], Array]


def _first_steps(rate: float, duration: float, rng: Generator, _: float) -> Array:
    """Return the beginning of the steps, with the levels that a new generator gives."""
    part, whole = AGAIN
    all_steps = waves.steps(rate, duration * whole / part, rng)
    return all_steps[: all_steps.size * part // whole]


SEGMENTS: Mapping[str, Kind] = MappingProxyType(
    {
        'steps': Kind(
            0.30,
            'lag, dead time, damping, creep',
            lambda rate, duration, rng, _: waves.steps(rate, duration, rng),
        ),
        'slow_triangle': Kind(
            0.24,
            'hysteresis, friction, the static law',
            lambda rate, duration, rng, _: waves.triangle(rate, duration, rng, minor_loops=True),
        ),
        # The plain triangle has less than half the path length: this makes it four times as fast.
        'fast_triangle': Kind(
            0.0275,
            'hysteresis against creep',
            lambda rate, duration, rng, _: waves.triangle(rate, duration, rng, minor_loops=False),
        ),
        'multisine': Kind(0.15, 'the whole range of frequencies', waves.multisine),
        'chirps': Kind(
            0.16,
            'damping over pressure, lag against dead time, mass',
            lambda rate, duration, _, fastest: waves.chirp(rate, duration, fastest),
        ),
        'steps_again': Kind(0.30 * AGAIN[0] / AGAIN[1], 'softening, warming, drift', _first_steps),
    }
)
