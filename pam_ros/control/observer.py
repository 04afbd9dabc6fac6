# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Estimate velocity and disturbance from position: an extended-state observer.

The disturbance is a third state without dynamics of its own (Han 2009, "From PID to active
disturbance rejection control"). The force of the model is fed through, so that the disturbance is
only what the model lacks.
"""

from math import ceil, exp

from pam_ros.control.model import ControlModel, Pressures

SUBSTEP = 1e-3  # s, longest: the physics step at which the model is known to be exact


class Observer:
    """Position, velocity and disturbance of the load, from measured positions.

    In m, m/s and N, or rad, rad/s and N m. The disturbance is the effort in the positive direction
    that the model lacks. The poles are real: two at the *velocity* bandwidth, one at the
    *disturbance* bandwidth, both in rad/s and free to change at any step. In a motion that the
    model does not predict, the velocity lags by 2/velocity s, the disturbance by 1/disturbance +
    2/velocity s. In a motion that the model predicts there is no lag.
    """

    def __init__(self, model: ControlModel) -> None:
        """Start at rest at 0; see :meth:`start`."""
        self.model = model
        self.start(0.0, 0.0)

    def start(self, position: float, disturbance: float) -> None:
        """Start again, at rest."""
        self.position, self.velocity, self.disturbance = position, 0.0, disturbance

    def correct(self, position: float, dt: float, velocity: float, disturbance: float) -> None:
        """Take in a measured *position*, *dt* s after the last one, with these bandwidths.

        The gains place the three discrete poles exactly for the chain of integrators that remains
        after the feed-through of the model.
        """
        slow, fast = exp(-disturbance * dt), exp(-velocity * dt)
        first = slow + 2.0 * fast
        second = 2.0 * slow * fast + fast * fast
        third = slow * fast * fast
        l1 = 1.0 - third
        l3 = (1.0 - first + second - third) / (dt * dt)
        l2 = (3.0 - first - l1 - 0.5 * l3 * dt * dt) / dt
        surprise = position - self.position
        self.position += l1 * surprise
        self.velocity += l2 * surprise
        self.disturbance += l3 * surprise * self.model.inertia

    def predict(self, dt: float, pressures: Pressures, known: float = 0.0) -> None:
        """Advance by *dt* s with chambers at *pressures* Pa and a *known* effort on the load."""
        pull, inertia = self.model.pull, self.model.inertia
        steps = max(ceil(dt / SUBSTEP - 1e-6), 1)
        h = dt / steps
        y, v = self.position, self.velocity
        given = self.disturbance + known - self.model.weight
        for _ in range(steps):
            a = (pull(pressures, y, v) + given) / inertia
            y += h * (v + 0.5 * h * a)
            v += h * a
        self.position, self.velocity = y, v
