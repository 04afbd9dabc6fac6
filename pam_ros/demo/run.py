# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The published series of a run of the simulated rig, in arrays."""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from pam_ros.rig import statics
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PublishedRun:
    """Series (n,), one sample per stamp, all in SI; contraction positive.

    t s, position m, velocity m/s, pressure Pa gauge, force N (of the muscle, without its
    damping), stiffness N/m, damping N s/m.
    """

    t: Array
    position: Array
    velocity: Array
    pressure: Array
    force: Array
    stiffness: Array
    damping: Array

    def between(self, begin: float, end: float) -> 'PublishedRun':
        """Return the part from *begin* up to *end* s."""
        return self._where((self.t >= begin) & (self.t < end))

    def without_repetitions(self) -> 'PublishedRun':
        """Return the run without the samples that have the stamp of the one before."""
        return self._where(np.diff(self.t, prepend=-np.inf) > 0.0)

    def _where(self, kept: NDArray[np.bool_]) -> 'PublishedRun':
        return PublishedRun(*(getattr(self, item.name)[kept] for item in fields(self)))

    def acceleration(self, joint: Joint) -> Array:
        """Return y'' in m/s^2 by equation (3) from the published values."""
        pull = self.force - self.damping * self.velocity
        weight = float(statics.weight(joint, 0.0))
        return np.asarray((pull - weight) / joint.inertia)
