# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What happened in one run of a controller in a scenario."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Trial:
    """The states, references and commands of one joint, in all n periods of a run.

    ``t`` (n,) are the times in s from the first state on, at a constant period. ``position`` (n,)
    are the true positions of the joint, without errors of the sensor, and ``reference`` (n,) the
    desired ones, in m or rad. ``pressure`` (n, muscles) are the commands in Pa that answered the
    states, as they were sent. ``limits`` (2, muscles) are p_min and p_max in Pa. ``answer`` (n,)
    are the wall times in s from sending a state to receiving its command, NaN for a state that was
    not sent or not answered. ``changes`` (m,) are the times in s at which the rig changed, such as
    its load. ``outages`` (k, 2) are the times in s of the begin and the end of each outage of the
    rig, in which it sent no states and took no commands; one without an end is infinite there.
    ``forces`` (j, 4) are the sinusoidal forces on the load: begin and end in s, frequency in Hz
    and amplitude in N; if there are any, ``alone`` (n,) is the position of the rig at constant
    pressures.
    """

    t: Array
    position: Array
    reference: Array
    pressure: Array
    limits: Array
    answer: Array
    changes: Array
    is_revolute: bool = False
    outages: Array = field(default_factory=lambda: np.empty((0, 2)))
    forces: Array = field(default_factory=lambda: np.empty((0, 4)))
    alone: Array = field(default_factory=lambda: np.empty(0))

    @property
    def error(self) -> Array:
        """Reference - position (n,) in m or rad."""
        return self.reference - self.position

    @property
    def period(self) -> float:
        """The period in s."""
        return float(self.t[1] - self.t[0])
