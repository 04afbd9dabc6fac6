# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What all position laws have: the model, the allocation, and the path to each muscle."""

from pam_ros.arguments import instance
from pam_ros.control.allocation import allocation_of
from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.joint_settings import JointSettings, defaults_of
from pam_ros.control.limits import Limiter, Limits
from pam_ros.control.model import ControlModel
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.signals import Pressures, Terms
from pam_ros.rig.joint import Joint
from pam_ros.sizes import tuned_sizes_of


class JointLaw:
    """A law for one joint; ``terms`` holds the results of its last step.

    ``joint`` is the nominal joint; ``model`` and ``allocation`` compute the pressures of an effort
    and a stiffness.
    """

    def __init__(
        self,
        joint: Joint,
        gains: JointSettings,
        limits: Limits | None,
        co_contraction: CoContraction | None,
        quickest: float,
    ) -> None:
        """Take the nominal joint; only its effects without an onset are used.

        *quickest* is the shortest time constant in s to which a lag of the pressure is reduced.
        Raises ParameterError for arguments of another type, and for gains of the other kind of
        joint.
        """
        self.joint = joint = instance('joint', joint, Joint, 'a Joint').at_start
        limits = instance('limits', Limits() if limits is None else limits, Limits, 'Limits')
        if co_contraction is None:
            own = defaults_of(CoContraction, tuned_sizes_of(joint), revolute=joint.is_revolute)
            co_contraction = CoContraction(**own)
        self._co_contraction: CoContraction = instance(
            'co_contraction', co_contraction, CoContraction, 'a CoContraction'
        )
        gains.require(revolute=joint.is_revolute)
        self.terms = Terms()
        self.model = ControlModel(joint)
        self.allocation = allocation_of(self.model, limits)
        self._paths = [PressurePath(joint, i, quickest) for i in range(len(self.model.muscles))]
        self._limiters = [
            Limiter(low, high, limits.pressure_rate) for low, high in self.allocation.ranges
        ]

    @property
    def _commands(self) -> Pressures:
        """The last commands in Pa."""
        return tuple(limiter.last for limiter in self._limiters)

    def _at_rest(self, position: float, stiffness: float) -> Pressures:
        """Return the commands in Pa that hold the load at *position*, according to the model."""
        effort = self.model.gravity(position)
        chambers = self.allocation.split(effort, stiffness, position).pressures
        return tuple(
            path.command_at_rest(p) for path, p in zip(self._paths, chambers, strict=True)
        )

    def _note_pressures(self, commands: Pressures, chambers: Pressures, stiffness: float) -> None:
        """Set the terms of the *commands*, of the desired *stiffness* and of the resulting one."""
        terms = self.terms
        terms.pressures = commands
        if self.allocation.can_stiffen:
            terms.co_contraction = stiffness
            terms.stiffness = self.model.stiffness(chambers, terms.position)
