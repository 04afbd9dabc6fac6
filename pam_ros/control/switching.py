# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The switching term: it drives the sliding variable to zero against unknown disturbances."""

from pam_ros.control.limits import clamp


def boundary_layer(s: float, bandwidth: float, gain: float) -> float:
    """Return gain sat(s / Phi), Phi = gain / bandwidth, in m/s^2 (Slotine & Li 1991, 7.2)."""
    return clamp(bandwidth * s, -gain, gain)


class Surface:
    """The sliding variable s = e' + z with its integral part z, and its switching term.

    ``value`` is s of the last step, ``integral`` is z, which the law integrates; both in m/s, or
    in rad/s for a revolute joint.
    """

    def __init__(self) -> None:
        """Begin on the surface."""
        self.start()

    def start(self) -> None:
        """Start again, with nothing integrated."""
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

    def shift(self, change: float) -> None:
        """Change the integral part by *change* m/s, for an effort that must not jump."""
        self.integral += change

    def integrate(self, growth: float, cut: float) -> None:
        """Add *growth* m/s to the integral part, unless a limit would cut its effect.

        Anti-windup: if limits of pressure *cut* a part of the wanted effort, or outside of the
        boundary layer, where the switching term is at its limit, it may only change away from the
        limit.
        """
        if growth * cut <= 0.0 and growth * self._excess <= 0.0:
            self.integral += growth
