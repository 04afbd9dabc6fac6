# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A muscle of a joint for a position law: force, stiffness, damping and their inverse."""

from collections.abc import Callable
from math import exp, inf

from pam_ros.compiled import plain
from pam_ros.effects.base import Compensation, EffectEquations
from pam_ros.muscle import law
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint

# The Python source of the force law: the steps of a controller must not wait for a compiler.
_force_at, _slope_at, _gain = plain(law.force_at), plain(law.slope_at), plain(law.gain)
_damping, _pressure_for_force = plain(law.damping), plain(law.pressure_for_force)
PUSH = 1e6  # N: more than any muscle pushes; what slack leaves of it is the force of a slack one


class MuscleModel:
    """One muscle of the nominal joint without memory: what holds at one instant.

    s is the joint's coordinate, y the muscle's contraction in m, p gauge Pa in its chamber, v
    and w the velocities of s and y. It includes the effects without memory: length offset, slack,
    damping that depends on pressure.
    """

    def __init__(self, joint: Joint, i: int) -> None:
        """Take the numbers of muscle i out of *joint*."""
        muscle = joint.muscles[i]
        self.a = muscle.si
        self.l0, self.zeta = muscle.l0, muscle.zeta
        self._row = joint.parameters()[at.MUSCLE + i].tolist()
        self._i, self._at_zero = i, joint.at_zero[i]
        self._geometry, self._numbers = joint.transmission.equations, joint.transmission.numbers
        self._muscles = len(joint.muscles)
        present = joint.present[at.MUSCLE + i]
        offsets = joint.layout.parameter_at
        self._contraction: list[tuple[Callable[..., float], int]] = []
        self._dampings: list[tuple[Callable[..., float], int]] = []
        self._forces: list[tuple[EffectEquations, int]] = []
        for effect in present:
            j = offsets[effect.name]
            if effect.equations.contraction is not None:
                self._contraction.append((effect.equations.contraction, j))
            if effect.equations.damping is not None:
                self._dampings.append((effect.equations.damping, j))
            if effect.equations.force is not None and effect.compensation is Compensation.MODEL:
                self._forces.append((effect.equations, j))

    @property
    def may_be_slack(self) -> bool:
        """Whether an effect is configured that changes the force law, such as slack."""
        return bool(self._forces)

    # Where it is -----------------------------------------------------------------------------

    def position(self, s: float) -> float:
        """Return the muscle's contraction in m at the coordinate s."""
        return self._at_zero + self._geometry.travel(s, self._i, self._numbers, 0)

    def arm(self, s: float) -> float:
        """Return the moment arm: the change of the contraction with the coordinate."""
        return self._geometry.arm(s, self._i, self._numbers, 0)

    def arm_slope(self, s: float) -> float:
        """Return the derivative of the arm over the coordinate."""
        return self._geometry.arm_slope(s, self._i, self._numbers, 0)

    def contraction(self, y: float) -> float:
        """Return the effective contraction, with the length offset, a fraction."""
        kappa = y / self.l0
        for function, j in self._contraction:
            kappa = function(kappa, self._row, j)
        return kappa

    # Along its own line ------------------------------------------------------------------------

    def force_law(self, p: float, y: float) -> float:
        """Return equation (1) in N, which is affine in the pressure, even if it is negative."""
        a1, a2, a3, a4, a5, a6 = self.a
        kappa = self.contraction(y)
        return _force_at(exp(a3 * kappa), p, kappa, a1, a2, a4, a5, a6)

    def force(self, p: float, y: float) -> float:
        """Return the static force in N: equation (1), with slack if that is configured."""
        return self._slack(self.force_law(p, y), p, self.contraction(y))

    def _slack(self, f: float, p: float, kappa: float) -> float:
        for equations, j in self._forces:
            f = equations.resting_force(f, p, kappa, self._row, j)
        return f

    def slack_pressure(self, y: float) -> float:
        """Return the pressure in Pa below which the muscle is slack; -inf if it never is."""
        if not self._forces:
            return -inf
        return self.pressure_for(self._slack(-PUSH, 0.0, self.contraction(y)), y)

    def gain(self, y: float) -> float:
        """Return dF/dp in N/Pa."""
        a1, _, a3, a4, a5, _ = self.a
        return _gain(self.contraction(y), a1, a3, a4, a5)

    def stiffness(self, p: float, y: float) -> float:
        """Return k in N/m: equation (2), sign corrected."""
        a1, a2, a3, a4, _, _ = self.a
        return -_slope_at(exp(a3 * self.contraction(y)), p, a1, a2, a3, a4) / self.l0

    def pressure_for(self, force: float, y: float) -> float:
        """Return the pressure in Pa for a *force* in N: (1) solved for p, not clamped."""
        return _pressure_for_force(force, self.contraction(y), *self.a)

    def damping(self, p: float, y: float, w: float, mass: float) -> float:
        """Return c in N s/m: equation (4) for *mass* kg, and the configured effects of damping."""
        return self._damping_of(self.stiffness(p, y), p, y, w, mass)

    def _damping_of(self, k: float, p: float, y: float, w: float, mass: float) -> float:
        c = _damping(k, mass, self.zeta)
        for function, j in self._dampings:
            c = function(c, p, y / self.l0, w, self._row, j)
        return c

    # As the joint feels it ---------------------------------------------------------------------

    def pull(self, p: float, s: float, v: float, inertia: float) -> tuple[float, float]:
        """Return the effort and the damping that it gives the joint at the coordinate s.

        *inertia* is that of the joint, of which each muscle moves its share.
        """
        a1, a2, a3, a4, a5, a6 = self.a
        arm, y = self.arm(s), self.position(s)
        kappa = self.contraction(y)
        e = exp(a3 * kappa)
        k = -_slope_at(e, p, a1, a2, a3, a4) / self.l0
        f = self._slack(_force_at(e, p, kappa, a1, a2, a4, a5, a6), p, kappa)
        c = self._damping_of(k, p, y, arm * v, inertia / (self._muscles * arm * arm))
        return arm * f, arm * arm * c

    def stiffness_on_joint(self, p: float, s: float) -> float:
        """Return the stiffness that it gives the joint, N/m or N m/rad."""
        arm, y = self.arm(s), self.position(s)
        stiffness = arm * arm * self.stiffness(p, y)
        slope = self.arm_slope(s)
        return stiffness - slope * self.force(p, y) if slope else stiffness
