# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What declared effects with a memory take from the muscle's force along the reference.

Friction, hysteresis and creep are fed forward: their own equations, those of the simulator, run
along the motion that the load shall make. Driven by the reference alone they can neither
destabilise the loop nor amplify noise; where the load does not follow, the observer sees the
difference.
"""

import numpy as np

from pam_ros.control.signals import Reference
from pam_ros.effects.base import Effect
from pam_ros.rig.model import RigModel, start_row

FED_FORWARD = ('hysteresis', 'creep', 'coulomb_friction')
IN_MODEL = ('length_offset', 'payload', 'viscous_friction', 'pressure_dependent_damping')
IN_PATH = ('dead_time', 'pressure_offset', 'pressure_lag')


def left_to_feedback(model: RigModel) -> tuple[str, ...]:
    """Return the declared effects that no part of a controller compensates ahead."""
    known = (*FED_FORWARD, *IN_MODEL, *IN_PATH)
    return tuple(effect.name for effect in model.present if effect.name not in known)


class Losses:
    """The force in N that declared effects of FED_FORWARD take along the reference."""

    def __init__(self, model: RigModel) -> None:
        """Take those that are present in *model*."""
        layout = model.layout
        self._model = model
        self._row = model.row()
        self._effects: list[tuple[Effect, int, int]] = [
            (effect, layout.state_at[effect.name], layout.parameter_at[effect.name])
            for effect in model.present
            if effect.name in FED_FORWARD
        ]
        self._x = self._xn = np.zeros(layout.width)
        self.force = 0.0
        self.start(0.0, 0.0)

    def start(self, position: float, pressure: float) -> None:
        """Begin anew after a long rest at *position* m and *pressure* Pa."""
        for _ in range(2):  # effects may be compiled when they are first called: not in flight
            self._x = start_row(self._model.layout, self._row, pressure, position, 0.0)
            self._xn = self._x.copy()
            self.follow(1e-6, Reference(position), pressure, 0.0)
        self.force = 0.0

    def follow(self, dt: float, reference: Reference, pressure: float, pull: float) -> float:
        """Go on by *dt* s to *reference*, there *pull* N at *pressure* Pa; return the force."""
        if not self._effects:
            return 0.0
        kappa = reference.position / self._model.muscle.l0
        f, outside = pull, 0.0
        v = reference.velocity
        for effect, i, j in self._effects:
            at = (v, 0.0, dt, self._x, i, self._xn, self._row, j)
            if effect.force is not None:
                f = effect.force(f, pressure, kappa, *at)
            if effect.outside is not None:
                outside = effect.outside(outside, pressure, reference.position, *at)
        self._x[:] = self._xn
        self.force = pull - f - outside
        return self.force
