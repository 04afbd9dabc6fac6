# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a position sensor makes of a position: latency, offset, noise, quantisation."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from scipy.signal import lfilter

_BLOCK = 4096


class Sensor:
    """A position sensor.

    noise    standard deviation of the noise, m
    rho      correlation of the noise from one sample to the next: AR(1); 0 is white
    quantum  step of the reading, m (0: none)
    latency  age of the reading, s
    offset   added to every reading, m
    """

    def __init__(
        self,
        noise: float = 0.0,
        rho: float = 0.0,
        quantum: float = 0.0,
        latency: float = 0.0,
        offset: float = 0.0,
    ) -> None:
        self.noise, self.rho, self.quantum = noise, rho, quantum
        self.latency, self.offset = latency, offset
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Forget the past and start the noise of a seed."""
        self._rng = np.random.default_rng([seed, 2])
        self._past: deque[tuple[float, float]] = deque()
        self._block = np.zeros(0)
        self._next = 0
        self._last = self._rng.standard_normal() * self.noise

    def draw(self, count: int) -> np.ndarray:
        """Return the next `count` samples of noise, m, stationary from the first."""
        white = self._rng.standard_normal(count) * self.noise * math.sqrt(1.0 - self.rho**2)
        if self.rho == 0.0:
            return white
        out = lfilter([1.0], [1.0, -self.rho], white, zi=[self.rho * self._last])[0]
        self._last = out[-1]
        return out

    def read(self, t: float, y: float) -> float:
        """Return the reading at time t of a position that is now y, m."""
        if self.latency > 0.0:
            y = self._delayed(t, y)
        y += self.offset
        if self.noise > 0.0:
            if self._next == self._block.size:
                self._block, self._next = self.draw(_BLOCK), 0
            y += float(self._block[self._next])
            self._next += 1
        if self.quantum > 0.0:
            y = round(y / self.quantum) * self.quantum
        return y

    def read_all(self, t: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return readings at stamps t (n,) of positions y (n,); before the first, the first."""
        out = np.interp(t - self.latency, t, y) + self.offset
        if self.noise > 0.0:
            out = out + self.draw(t.size)
        if self.quantum > 0.0:
            out = np.round(out / self.quantum) * self.quantum
        return out

    def _delayed(self, t: float, y: float) -> float:
        """Position one latency ago, between the readings asked for."""
        past = self._past
        past.append((t, y))
        old = t - self.latency
        while len(past) > 1 and past[1][0] <= old:
            past.popleft()
        (t0, y0) = past[0]
        if old <= t0 or len(past) == 1:
            return y0
        (t1, y1) = past[1]
        return y0 + (y1 - y0) * (old - t0) / (t1 - t0)
