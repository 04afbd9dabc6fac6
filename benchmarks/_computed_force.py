# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A baseline: computed force with an extended-state observer, without switching or learning.

The effort is the one with which the error of the nominal model obeys e'' + 2 w e' + w^2 e = 0,
minus the estimated disturbance: feedback linearisation with active disturbance rejection (Han
2009; the triple pole of the observer after Gao 2003, "Scaling and bandwidth-parameterization").
"""

from pam_ros.control.allocation import allocation_of
from pam_ros.control.limits import Limits
from pam_ros.control.model import ControlModel
from pam_ros.control.observer import Observer
from pam_ros.control.signals import Pressures, Reference, Terms
from pam_ros.rig.joint import Joint


class ComputedForce:
    """The law for one joint, with the bandwidths of observer and error in rad/s."""

    def __init__(self, joint: Joint, observer: float = 100.0, error: float = 30.0) -> None:
        """Make it; see :meth:`start`."""
        self.model = ControlModel(joint)
        self.allocation = allocation_of(self.model, Limits())
        self.terms = Terms()
        self._observer = Observer(self.model)
        self._fast, self._w = observer, error
        self._pressures: Pressures = ()

    def start(self, position: float, pressures: Pressures) -> None:
        """Begin at rest; the force that the model lacks for this rest is the first disturbance."""
        model = self.model
        self._observer.start(position, model.gravity(position) - model.effort(pressures, position))
        self._pressures = pressures

    def update(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        velocity: float | None = None,
        age: float = 0.0,
    ) -> Pressures:
        """Return the gauge pressures in Pa to command, *dt* s after the last call."""
        model, seen = self.model, self._observer
        seen.predict(dt, self._pressures)
        if position is not None:
            seen.correct(position, dt, self._fast, self._fast)
        s, v, a, _ = reference
        error, rate = s - seen.position, v - seen.velocity
        effort = model.inertia * (a + 2.0 * self._w * rate + self._w * self._w * error)
        effort += model.damping(self._pressures, seen.position, seen.velocity) * seen.velocity
        effort += model.gravity(seen.position) - seen.disturbance
        wanted = self.allocation.split(effort, 0.0, seen.position).pressures
        self._pressures = tuple(
            min(max(p, low), high)
            for p, (low, high) in zip(wanted, self.allocation.ranges, strict=True)
        )
        self.terms.error = error
        return self._pressures
