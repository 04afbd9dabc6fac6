# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Switching terms: what drives the sliding variable to zero against what is not known."""

from math import sqrt


def boundary_layer(s: float, bandwidth: float, gain: float) -> float:
    """Return gain sat(s / Phi), Phi = gain / bandwidth, in m/s^2 (Slotine & Li 1991, 7.2)."""
    return min(max(bandwidth * s, -gain), gain)


class SuperTwisting:
    """The super-twisting algorithm (Levant 1993), stepped implicitly.

        s' = -k1 sqrt|s| sign s + w + d,    w' = -k2 sign s

    The term is found from the s that it leads to at the end of the step (implicit Euler:
    Brogliato, Polyakov & Efimov 2020), for which there is a closed form: so it does not chatter in
    discrete time, and is zero where s is.
    """

    def __init__(self) -> None:
        """Begin with w = 0."""
        self.w = 0.0

    def step(self, s: float, dt: float, k1: float, k2: float) -> float:
        """Return the term in m/s^2 that acts against *s* m/s for the next *dt* s."""
        b = s + dt * self.w
        rest = abs(b) - dt * dt * k2
        if rest <= 0.0:
            self.w = -s / dt
            return s / dt
        sign = 1.0 if b > 0.0 else -1.0
        root = 0.5 * (-dt * k1 + sqrt(dt * dt * k1 * k1 + 4.0 * rest))
        self.w -= dt * k2 * sign
        return k1 * root * sign - self.w
