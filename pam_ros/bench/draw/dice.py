# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Random numbers with few digits, so that the files that have them are readable."""

from collections.abc import Mapping
from math import exp, log
from typing import Any, TypeVar

import numpy as np

T = TypeVar('T')


def digits(value: float) -> float:
    """Return *value* with four significant digits."""
    return float(f'{value:.4g}')


class Dice:
    """A source of random numbers with four significant digits, the same for the same *key*."""

    def __init__(self, *key: int) -> None:
        """Begin a sequence that belongs to these whole numbers, each at least 0."""
        self._rng = np.random.default_rng(key)

    def between(self, low: float, high: float) -> float:
        """Return a number that is uniform from *low* to *high*."""
        return digits(self._rng.uniform(low, high))

    def decade(self, low: float, high: float) -> float:
        """Return a number whose logarithm is uniform, from *low* to *high*, both above 0."""
        return digits(exp(self._rng.uniform(log(low), log(high))))

    def signed(self, low: float, high: float) -> float:
        """Return a number whose absolute value is uniform, of either sign."""
        return self.between(low, high) * (1.0 if self.chance(0.5) else -1.0)

    def count(self, low: int, high: int) -> int:
        """Return a whole number from *low* to *high*, both included."""
        return int(self._rng.integers(low, high + 1))

    def chance(self, probability: float) -> bool:
        """Return true with this *probability*."""
        return bool(self._rng.random() < probability)

    def one_of(self, weights: Mapping[T, float]) -> T:
        """Return a key, each with a probability in proportion to its value."""
        keys = list(weights)
        shares = np.array([weights[key] for key in keys], float)
        return keys[int(self._rng.choice(len(keys), p=shares / shares.sum()))]

    def some_of(self, weights: Mapping[T, float], count: int) -> list[T]:
        """Return so many different keys, each drawn with a probability in proportion to its value.

        There are fewer if there are not so many keys.
        """
        left: dict[Any, float] = dict(weights)
        found: list[T] = []
        while left and len(found) < count:
            found.append(self.one_of(left))
            del left[found[-1]]
        return found
