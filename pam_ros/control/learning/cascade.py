# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Three equal poles in series, for several signals at once."""

from collections.abc import Sequence
from math import exp


class Cascade:
    """Filters each signal three times with the same bandwidth.

    ``stages`` are the outputs of the first, the second and the third pole, of each signal. They
    are plain numbers: for some ten signals the calls of numpy take longer than the sums.
    """

    def __init__(self, start: Sequence[float]) -> None:
        """Begin as after a long time with the signals *start*."""
        self.stages = [(value, value, value) for value in start]

    @property
    def output(self) -> list[float]:
        """The signals after all three poles."""
        return [third for _, _, third in self.stages]

    def follow(self, dt: float, bandwidth: float, signals: Sequence[float]) -> None:
        """Advance by *dt* s with these *signals* at the input; *bandwidth* is in rad/s."""
        share = 1.0 - exp(-bandwidth * dt)
        stages = []
        for signal, (one, two, three) in zip(signals, self.stages, strict=True):
            first = one + share * (signal - one)
            second = two + share * (first - two)
            stages.append((first, second, three + share * (second - three)))
        self.stages = stages
