# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A muscle of a joint for a position law: force, stiffness, damping and their inverse.

A step of a law needs several of them at the same coordinate. So a :class:`MusclePlace` stores the
quantities that depend on the coordinate alone, above all the exponential of the force law.
"""

from collections.abc import Callable
from math import exp, inf

from pam_ros.compiled import plain
from pam_ros.effects.base import Compensation, EffectEquations
from pam_ros.muscle import law
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint

# The force law in plain Python: the steps of a controller must not wait for a compiler.
_force_at, _slope_at, _damping = plain(law.force_at), plain(law.slope_at), plain(law.damping)
_gain_at, _pressure_at = plain(law.gain_at), plain(law.pressure_at)
PUSH = 1e6  # N: more than any muscle pushes; the slack effect reduces it to a slack muscle's force


class MuscleModel:
    """One muscle of the nominal joint without memory: its equations at one instant.

    s is the joint's coordinate. It includes the effects without memory: length offset, slack,
    damping that depends on pressure. Its numbers do not change.
    """

    def __init__(self, joint: Joint, i: int) -> None:
        """Take the numbers of muscle i out of *joint*."""
        muscle = joint.muscles[i]
        self.a = muscle.si
        self.l0, self.zeta = muscle.l0, muscle.zeta
        self.row = joint.parameters()[at.MUSCLE + i].tolist()
        self.muscles = len(joint.muscles)
        self._i, self._at_zero = i, joint.at_zero[i]
        self._constants = (*muscle.si, muscle.l0, muscle.zeta, joint.at_zero[i])
        geometry, self._numbers = joint.transmission.equations, joint.transmission.numbers
        self._travel, self._arm = geometry.travel, geometry.arm
        self._arm_slope = geometry.arm_slope
        present = joint.present[at.MUSCLE + i]
        offsets = joint.layout.parameter_at
        self.contractions: list[tuple[Callable[..., float], int]] = []
        self.dampings: list[tuple[Callable[..., float], int]] = []
        self.forces: list[tuple[EffectEquations, int]] = []
        for effect in present:
            j = offsets[effect.name]
            if effect.equations.contraction is not None:
                self.contractions.append((effect.equations.contraction, j))
            if effect.equations.damping is not None:
                self.dampings.append((effect.equations.damping, j))
            if effect.equations.force is not None and effect.compensation is Compensation.MODEL:
                self.forces.append((effect.equations, j))

    @property
    def may_be_slack(self) -> bool:
        """Whether an effect is configured that changes the force law, such as slack."""
        return bool(self.forces)

    def arm(self, s: float) -> float:
        """Return the moment arm: the change of the contraction with the coordinate."""
        return self._arm(s, self._i, self._numbers, 0)

    def arm_slope(self, s: float) -> float:
        """Return the derivative of the arm over the coordinate."""
        return self._arm_slope(s, self._i, self._numbers, 0)

    def at(self, s: float) -> 'MusclePlace':
        """Return the muscle at the coordinate s."""
        i, numbers = self._i, self._numbers
        y = self._at_zero + self._travel(s, i, numbers, 0)
        return MusclePlace(self, self._arm(s, i, numbers, 0), y)

    def pull(self, p: float, s: float, v: float, inertia: float) -> tuple[float, float]:
        """Return the effort and the damping that it gives the joint, with *inertia*, at s and v.

        These are ``arm force`` and ``damping_on_joint`` of the place at s. An observer needs both
        at several new coordinates a step, at each of them once: so no place is created.
        """
        i, numbers = self._i, self._numbers
        a1, a2, a3, a4, a5, a6, l0, zeta, at_zero = self._constants
        arm = self._arm(s, i, numbers, 0)
        contraction = kappa = (at_zero + self._travel(s, i, numbers, 0)) / l0
        for function, j in self.contractions:
            kappa = function(kappa, self.row, j)
        e = exp(a3 * kappa)
        f = _force_at(e, p, kappa, a1, a2, a4, a5, a6)
        for equations, j in self.forces:
            f = equations.resting_force(f, p, kappa, self.row, j)
        k = -_slope_at(e, p, a1, a2, a3, a4) / l0
        c = _damping(k, inertia / (self.muscles * arm * arm), zeta)
        for function, j in self.dampings:
            c = function(c, p, contraction, arm * v, self.row, j)
        return arm * f, arm * arm * c


class MusclePlace:
    """A muscle at one coordinate of the joint; p is the gauge pressure in its chamber in Pa.

    arm
        moment arm: the change of the contraction with the coordinate
    contraction, kappa
        contraction as a fraction; effective contraction, with the length offset
    gain
        dF/dp in N/Pa
    """

    __slots__ = ('_e', '_muscle', 'arm', 'contraction', 'gain', 'kappa')

    def __init__(self, muscle: MuscleModel, arm: float, y: float) -> None:
        """Take a *muscle* with this moment *arm*, contracted by *y* m."""
        a1, _, a3, a4, a5, _ = muscle.a
        self.contraction = kappa = y / muscle.l0
        for function, j in muscle.contractions:
            kappa = function(kappa, muscle.row, j)
        self._muscle, self.arm, self.kappa = muscle, arm, kappa
        self._e = e = exp(a3 * kappa)
        self.gain = _gain_at(e, kappa, a1, a4, a5)

    # Along its own line ------------------------------------------------------------------------

    def force_law(self, p: float) -> float:
        """Return equation (1) in N, which is affine in the pressure, even if it is negative."""
        a1, a2, _, a4, a5, a6 = self._muscle.a
        return _force_at(self._e, p, self.kappa, a1, a2, a4, a5, a6)

    def force(self, p: float) -> float:
        """Return the static force in N: equation (1), with slack if that is configured."""
        return self._slack(self.force_law(p), p)

    def _slack(self, f: float, p: float) -> float:
        muscle = self._muscle
        for equations, j in muscle.forces:
            f = equations.resting_force(f, p, self.kappa, muscle.row, j)
        return f

    def slack_pressure(self) -> float:
        """Return the pressure in Pa below which the muscle is slack; -inf if it never is."""
        if not self._muscle.forces:
            return -inf
        return self.pressure_for(self._slack(-PUSH, 0.0))

    def stiffness(self, p: float) -> float:
        """Return k in N/m: equation (2), sign corrected."""
        muscle = self._muscle
        a1, a2, a3, a4, _, _ = muscle.a
        return -_slope_at(self._e, p, a1, a2, a3, a4) / muscle.l0

    def pressure_for(self, force: float) -> float:
        """Return the pressure in Pa for a *force* in N: (1) solved for p, not clamped."""
        _, a2, _, _, _, a6 = self._muscle.a
        return _pressure_at(self._e, force, self.gain, a2, a6)

    # On the coordinate of the joint ------------------------------------------------------------

    def damping_on_joint(self, p: float, v: float, inertia: float) -> float:
        """Return the damping that it gives the joint, which moves at v.

        It is equation (4) with the configured effects of damping. *inertia* is that of the joint,
        of which each muscle moves its share.
        """
        muscle, arm = self._muscle, self.arm
        c = _damping(self.stiffness(p), inertia / (muscle.muscles * arm * arm), muscle.zeta)
        for function, j in muscle.dampings:
            c = function(c, p, self.contraction, arm * v, muscle.row, j)
        return arm * arm * c

    def stiffness_on_joint(self, p: float, arm_slope: float) -> float:
        """Return the stiffness that it gives the joint, in N/m or N m/rad.

        *arm_slope* is the derivative of the arm over the coordinate.
        """
        stiffness = self.arm * self.arm * self.stiffness(p)
        return stiffness - arm_slope * self.force(p) if arm_slope else stiffness
