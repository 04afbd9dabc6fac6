# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The nominal joint for a position law, in scalars: efforts, stiffness, damping."""

from collections.abc import Sequence

from pam_ros.control.muscle_model import MuscleModel
from pam_ros.effects.base import Compensation
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint
from pam_ros.rig.loads import Mass

Pressures = Sequence[float]


class JointPlace:
    """The muscles of a joint at its coordinate s.

    ``arm_slopes`` are the derivatives of their arms over s, ``gains`` the efforts per pressure of
    the muscles, arm dF/dp with its sign.
    """

    __slots__ = ('arm_slopes', 'gains', 'muscles', 's')

    def __init__(self, muscles: Sequence[MuscleModel], s: float) -> None:
        """Evaluate the *muscles* at s."""
        self.s = s
        self.muscles = [muscle.at(s) for muscle in muscles]
        self.arm_slopes = [muscle.arm_slope(s) for muscle in muscles]
        self.gains = tuple([place.arm * place.gain for place in self.muscles])


class ControlModel:
    """The nominal joint without memory: its equations at one instant.

    s is its coordinate, v its velocity, p the gauge pressures in the chambers in Pa, one a
    muscle. It includes the configured payload, length offset, slack, viscous damping and damping
    that depends on pressure; effects with a memory are in :mod:`pam_ros.control.compensation`.
    ``weight`` is the part of gravity that does not depend on the position.
    """

    def __init__(self, joint: Joint) -> None:
        """Take the numbers out of *joint*."""
        self.joint = joint
        self.inertia, self.moved_mass = joint.inertia, joint.moved_mass
        self.muscles = tuple(MuscleModel(joint, i) for i in range(len(joint.muscles)))
        self._load, self._numbers = joint.load.equations, joint.load.numbers
        self._swings = not isinstance(joint.load, Mass)
        self.weight = 0.0 if self._swings else self.gravity(0.0)
        self._viscous = _drag(joint)
        self._place = JointPlace(self.muscles, 0.0)

    @property
    def arms(self) -> float:
        """Sum of the muscles' arms at the coordinate 0: the effort if each pulls with 1 N."""
        return sum(abs(muscle.arm(0.0)) for muscle in self.muscles)

    @property
    def arm(self) -> float:
        """Mean of the muscles' arms at the coordinate 0."""
        return self.arms / len(self.muscles)

    def gravity(self, s: float) -> float:
        """Return the effort that holds the load against gravity."""
        return self.inertia * self._load.fall(s, self.moved_mass, self.inertia, self._numbers, 0)

    def gravity_stiffness(self, s: float) -> float:
        """Return the stiffness that gravity adds."""
        return self.inertia * self._load.fall_slope(
            s, self.moved_mass, self.inertia, self._numbers, 0
        )

    def at(self, s: float) -> JointPlace:
        """Return the muscles at the coordinate s.

        Those of the last call are kept, since a step needs them several times at its reference:
        they depend on nothing but s.
        """
        if s != self._place.s:
            self._place = JointPlace(self.muscles, s)
        return self._place

    def effort(self, p: Pressures, s: float) -> float:
        """Return the effort of the muscles on the joint at rest."""
        total = 0.0
        for muscle, pressure in zip(self.at(s).muscles, p, strict=True):
            total += muscle.arm * muscle.force(pressure)
        return total

    def stiffness(self, p: Pressures, s: float) -> float:
        """Return the stiffness that the muscles give the joint."""
        total, place = 0.0, self.at(s)
        for muscle, pressure, slope in zip(place.muscles, p, place.arm_slopes, strict=True):
            total += muscle.stiffness_on_joint(pressure, slope)
        return total

    def damping(self, p: Pressures, s: float, v: float) -> float:
        """Return the joint's damping: equation (4) and the configured effects of damping."""
        total = 0.0
        for muscle, pressure in zip(self.at(s).muscles, p, strict=True):
            total += muscle.damping_on_joint(pressure, v, self.inertia)
        return total + self._viscous

    def pull(self, p: Pressures, s: float, v: float) -> float:
        """Return the effort on the load: muscles, damping, and variable part of gravity."""
        total = damping = 0.0
        inertia = self.inertia
        for i, muscle in enumerate(self.muscles):
            effort, c = muscle.pull(p[i], s, v, inertia)
            total += effort
            damping += c
        total -= (damping + self._viscous) * v
        return total - self.gravity(s) if self._swings else total


def _drag(joint: Joint) -> float:
    """Return the damping of the effects on the joint that are part of the inverted model.

    These effects have no memory and are linear in the velocity.
    """
    drag, row = 0.0, joint.parameters()[at.JOINT].tolist()
    for effect in joint.present[at.JOINT]:
        if effect.compensation is Compensation.MODEL:
            drag += effect.equations.viscous_drag(row, joint.layout.parameter_at[effect.name])
    return drag
