# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Switching terms: they drive the sliding variable to zero against unknown disturbances."""

from math import sqrt

from pam_ros.control.limits import clamp


def boundary_layer(s: float, bandwidth: float, gain: float) -> float:
    """Return gain sat(s / Phi), Phi = gain / bandwidth, in m/s^2 (Slotine & Li 1991, 7.2)."""
    return clamp(bandwidth * s, -gain, gain)


class SuperTwisting:
    """The super-twisting algorithm (Levant 1993), stepped without chatter.

        s' = -k1 sqrt|s| sign s + w + d,    w' = -k2 sign s

    The root is taken of s at the end of the step, and sign s is replaced by s / (k2 dt^2) where
    a whole step of w would overshoot (after the implicit schemes of Brogliato, Polyakov & Efimov
    2020). At rest w is -d of the step before, and |s| is the change of d since then, times dt.
    """

    def __init__(self) -> None:
        """Begin with w = 0."""
        self.w = 0.0

    def step(self, s: float, dt: float, k1: float, k2: float, cut: float = 0.0) -> float:
        """Return the term in m/s^2 that acts against *s* m/s for the next *dt* s.

        *cut* is the part of the last wanted effort that the limits cut off; w does not add to it.
        """
        first = dt * k1
        root = 0.5 * (sqrt(first * first + 4.0 * abs(s)) - first)
        if s * cut <= 0.0:
            self.w -= min(max(s / dt, -dt * k2), dt * k2)
        return (k1 * root if s > 0.0 else -k1 * root) - self.w


class Surface:
    """The sliding variable s = e' + z with its integral part z, and its switching terms.

    ``value`` is s of the last step, ``integral`` is z, which the law integrates; both in m/s, or
    in rad/s for a revolute joint.
    """

    def __init__(self) -> None:
        """Begin on the surface."""
        self._twisting = SuperTwisting()
        self.start()

    def start(self) -> None:
        """Start again, with nothing integrated."""
        self._twisting.w = 0.0
        self._bandwidth = 0.0  # of the last step, 1/s
        self._excess = 0.0  # bandwidth s minus its value after saturation, m/s^2
        self.integral = self.value = 0.0

    def drive(self, error_rate: float, bandwidth: float, gain: float) -> float:
        """Return the acceleration of the boundary layer; the *bandwidth* in 1/s may change."""
        if self._bandwidth:
            # The integral represents a force, which must not jump with the bandwidth.
            self.integral *= self._bandwidth / bandwidth
        self._bandwidth = bandwidth
        self.value = error_rate + self.integral
        term = boundary_layer(self.value, bandwidth, gain)
        self._excess = bandwidth * self.value - term
        return term

    def twist(self, error_rate: float, dt: float, k1: float, k2: float, cut: float = 0.0) -> float:
        """Return the acceleration of super-twisting for the next *dt* s; *cut* as in its step."""
        self.value = error_rate + self.integral
        return self._twisting.step(self.value, dt, k1, k2, cut)

    def integrate(self, growth: float, cut: float) -> None:
        """Add *growth* m/s to the integral part, unless a limit would cut its effect.

        Anti-windup: if limits of pressure *cut* a part of the wanted effort, or outside of the
        boundary layer, where the switching term is at its limit, it may only change away from the
        limit.
        """
        if growth * cut <= 0.0 and growth * self._excess <= 0.0:
            self.integral += growth
