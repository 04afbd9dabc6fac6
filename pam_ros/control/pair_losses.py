# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What declared effects with a memory take from a pair's torque along the reference."""

from pam_ros.control.compensation import FED_FORWARD, Losses
from pam_ros.control.pair_model import PairModel
from pam_ros.control.signals import Reference
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.model import Load, RigModel


class PairLosses:
    """The torque in N m that declared effects of FED_FORWARD take, in the muscles and on the load.

    Those of the muscles run along their own ends, that of the load along the angle.
    """

    def __init__(self, rig: PairModel) -> None:
        """Take those that are present in *rig*."""
        self._rig = rig
        self._muscles = [Losses(muscle) for muscle in rig.muscles]
        on_load = {name: given for name, given in rig.model.effects.items() if name in FED_FORWARD}
        # Its coordinate is the angle, and its effects have the joint's units.
        self._load = Losses(RigModel(Muscle(), Load(1.0, 'horizontal'), on_load))

    def start(self, position: float, pressure: tuple[float, float]) -> None:
        """Begin anew after a long rest at *position* rad and *pressure* Pa."""
        for i, losses in enumerate(self._muscles):
            losses.start(self._rig.position(position, i), pressure[i])
        self._load.start(position, 0.5 * (pressure[0] + pressure[1]))

    def follow(self, dt: float, reference: Reference, pressure: tuple[float, float]) -> float:
        """Go on by *dt* s to *reference*, there with *pressure* Pa; return the torque."""
        lost = self._load.follow(dt, reference, 0.5 * (pressure[0] + pressure[1]), 0.0)
        for i, losses in enumerate(self._muscles):
            y, r = self._rig.position(reference.position, i), self._rig.arm(reference.position, i)
            pull = self._rig.force(pressure[i], reference.position, i)
            end = Reference(y, r * reference.velocity)
            lost += r * losses.follow(dt, end, pressure[i], pull)
        return lost
