# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The rig as a position law sees it: force, stiffness, damping and their inverse, as scalars."""

from collections.abc import Callable
from math import exp

from pam_ros.compiled import plain
from pam_ros.muscle import law
from pam_ros.rig.model import RigModel

# The law's own source: a controller steps in Python and must not wait for a compiler.
_force_at, _slope_at, _gain = plain(law.force_at), plain(law.slope_at), plain(law.gain)
_damping, _pressure_for_force = plain(law.damping), plain(law.pressure_for_force)


def _at(model: RigModel, place: str) -> list[tuple[Callable[..., float], int]]:
    """Return the functions that the present effects have at a place, with their offsets."""
    offsets = model.layout.parameter_at
    return [
        (getattr(effect, place), offsets[effect.name])
        for effect in model.present
        if getattr(effect, place) is not None
    ]


class InnerModel:
    """The declared rig without memory: what holds at one instant.

    y is in m, contraction positive, p gauge Pa in the chamber, v in m/s. Declared payload, length
    offset, viscous and pressure-dependent damping are in; effects with a memory are in
    :mod:`pam_ros.control.compensation`.
    """

    def __init__(self, model: RigModel) -> None:
        """Take the numbers out of *model*."""
        muscle = model.muscle
        self.a = muscle.si
        self.l0, self.zeta = muscle.l0, muscle.zeta
        self.p_low, self.p_high = max(muscle.p_min, 0.0), muscle.p_max
        self.mass = model.moved_mass
        self.weight = model.weight
        self._row = model.row().tolist()
        self._contraction = _at(model, 'contraction')
        self._damping = _at(model, 'damping')
        viscous = model.effects.get('viscous_friction', {})
        self._viscous = viscous.get('coefficient', 0.0)

    def contraction(self, y: float) -> float:
        """Return the contraction that the muscle feels, a fraction."""
        kappa = y / self.l0
        for function, j in self._contraction:
            kappa = function(kappa, self._row, j)
        return kappa

    def force(self, p: float, y: float) -> float:
        """Return the static pull in N: equation (1)."""
        a1, a2, a3, a4, a5, a6 = self.a
        kappa = self.contraction(y)
        return _force_at(exp(a3 * kappa), p, kappa, a1, a2, a4, a5, a6)

    def gain(self, y: float) -> float:
        """Return dF/dp in N/Pa."""
        a1, _, a3, a4, a5, _ = self.a
        return _gain(self.contraction(y), a1, a3, a4, a5)

    def stiffness(self, p: float, y: float) -> float:
        """Return k in N/m: equation (2), sign mended."""
        a1, a2, a3, a4, _, _ = self.a
        return -_slope_at(exp(a3 * self.contraction(y)), p, a1, a2, a3, a4) / self.l0

    def pressure_for(self, force: float, y: float) -> float:
        """Return the pressure in Pa that pulls with *force* N: (1) solved for p, not clamped."""
        return _pressure_for_force(force, self.contraction(y), *self.a)

    def pull(self, p: float, y: float, v: float) -> float:
        """Return the force in N that the muscle has at speed v: static less damping."""
        a1, a2, a3, a4, a5, a6 = self.a
        kappa = self.contraction(y)
        e = exp(a3 * kappa)
        k = -_slope_at(e, p, a1, a2, a3, a4) / self.l0
        return _force_at(e, p, kappa, a1, a2, a4, a5, a6) - self._damping_of(k, p, y, v) * v

    def damping(self, p: float, y: float, v: float) -> float:
        """Return c in N s/m: equation (4) and the declared effects of damping."""
        return self._damping_of(self.stiffness(p, y), p, y, v)

    def _damping_of(self, k: float, p: float, y: float, v: float) -> float:
        c = _damping(k, self.mass, self.zeta)
        for function, j in self._damping:
            c = function(c, p, y / self.l0, v, self._row, j)
        return c + self._viscous
