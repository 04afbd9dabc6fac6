# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A muscle: its constants, length, damping ratio and limits, checked when it is created."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.arguments import alike, array, number, refuse
from pam_ros.cached_property import cached_property
from pam_ros.constructors import RefusesUnknownNames
from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle import law
from pam_ros.muscle.constants import CONTRACTION_UNITS, PRESSURE_UNITS, Constants, to_si
from pam_ros.parameters import check_all, parameter_field

Array = NDArray[np.float64]
FAR_OFF = 20.0  # factor above or below the rated force at which the constants are refused


@dataclass(frozen=True)
class Muscle(metaclass=RefusesUnknownNames):
    """A fluidic muscle after Sárosi (2015).

    Fields are given by the user, constants in the units of their source. Methods use SI units:
    gauge Pa, contraction as a fraction of l0, N, N/m; arrays of finite numbers broadcast, and
    anything else raises ParameterError. The constructor raises ParameterError if the constants are
    not valid for a muscle: stiffness or pressure gain not positive somewhere in the working range
    (p_min..p_max, kappa_min..kappa_max), or a force far from the rated one.

    With a1 = a2 = a4 = 0 this is not a muscle but a force source a5 p + a6 that does not depend on
    the position: a drive whose input replaces the pressure, in its own unit.
    """

    a1: float = parameter_field(-4.35573, 'constant a1 of the force law', 'N/pressure_unit')
    a2: float = parameter_field(281.22370, 'constant a2 of the force law', 'N')
    a3: float = parameter_field(-0.32866, 'constant a3 of the force law', '1/contraction_unit')
    a4: float = parameter_field(
        -9.27035, 'constant a4 of the force law', 'N/(pressure_unit contraction_unit)'
    )
    a5: float = parameter_field(302.20107, 'constant a5 of the force law', 'N/pressure_unit')
    a6: float = parameter_field(-263.69185, 'constant a6 of the force law', 'N')
    pressure_unit: str = parameter_field(
        'bar', 'unit of pressure in a1, a4 and a5', choices=tuple(PRESSURE_UNITS), live=False
    )
    contraction_unit: str = parameter_field(
        'percent', 'unit of contraction in a3 and a4', choices=tuple(CONTRACTION_UNITS), live=False
    )
    zeta: float = parameter_field(
        0.15, "Lehr's damping ratio; not in the paper, a choice", '', low=0.0, high=5.0
    )
    l0: float = parameter_field(0.4, 'length of the muscle at rest', 'm', low=0.001, high=10.0)
    inside_diameter: float = parameter_field(
        0.02, 'inside diameter at rest', 'm', low=0.001, high=0.2, live=False
    )
    p_min: float = parameter_field(
        0.0, 'lowest gauge pressure; below 0: a vacuum', 'Pa', low=-101325.0, high=0.0
    )
    p_max: float = parameter_field(
        600e3, 'highest gauge pressure', 'Pa', low=0.0, high=5e6, above_low=True
    )
    kappa_min: float = parameter_field(
        -0.04, 'contraction at the largest permissible pretension', 'fraction', low=-0.5, high=0.0
    )
    kappa_max: float = parameter_field(
        0.25, 'largest permissible contraction', 'fraction', low=0.0, high=0.9, above_low=True
    )
    force_max: float = parameter_field(
        1500.0, 'rated lifting force', 'N', low=0.0, high=1e5, above_low=True
    )
    source: str = parameter_field('', 'source of the constants', live=False)

    def __post_init__(self) -> None:
        """Check every field, then the muscle that they describe."""
        check_all(self)
        if self.is_load_only:
            if self.zeta != 0.0:
                raise ParameterError(
                    f'zeta = {self.zeta:g} needs a muscle with stiffness: a1, a2 and a4 are 0, so '
                    'the force does not depend on contraction; give zeta 0'
                )
            return
        # The stiffness is affine in p and monotone in kappa: its least value is at a corner.
        p, kappa = np.meshgrid((self.p_min, self.p_max), (self.kappa_min, self.kappa_max))
        # Constants in the wrong units can overflow exp(), which the checks below find, too.
        with np.errstate(over='ignore', invalid='ignore'):
            self._refuse('stiffness k', self.stiffness(p, kappa), 'N/m', p, kappa)
            kappa = self._extremes_of_gain()
            self._refuse('pressure gain dF/dp', self.gain(kappa), 'N/Pa', 0.0 * kappa, kappa)
            strongest = float(self.force(self.p_max, 0.0))
        # A wrong unit of pressure changes no sign, but it changes the force by a factor of 100 or
        # more.
        if not self.force_max / FAR_OFF < strongest < self.force_max * FAR_OFF:
            raise ParameterError(
                f'the constants a1..a6 give {strongest:.4g} N at p_max = {self.p_max / 1e3:g} kPa '
                f'and contraction 0, which is far from force_max = {self.force_max:g} N: '
                'correct pressure_unit, the constants, or force_max'
            )

    def _extremes_of_gain(self) -> Array:
        """Return the contractions at which the gain can be least: the ends and a flat point."""
        a1, _, a3, a4, _, _ = self.si
        low, high = self.kappa_min, self.kappa_max
        flat = np.log(-a4 / (a1 * a3)) / a3 if a1 * a3 * a4 < 0.0 else low
        return np.array([low, high, min(max(flat, low), high)])

    def _refuse(self, what: str, values: Array, unit: str, p: Array, kappa: Array) -> None:
        worst = np.unravel_index(np.argmin(values), values.shape)
        if not (values[worst] > 0.0 and np.all(np.isfinite(values))):
            raise ParameterError(
                f'the constants a1..a6 do not describe a muscle: {what} = {values[worst]:.4g} '
                f'{unit} at {p[worst] / 1e3:g} kPa and contraction {kappa[worst]:g}; it must be '
                'positive for p_min..p_max and kappa_min..kappa_max (are the units right?)'
            )

    @property
    def is_load_only(self) -> bool:
        """Whether the force depends on pressure alone: a plain force source, no spring."""
        return self.a1 == 0.0 and self.a2 == 0.0 and self.a4 == 0.0

    @cached_property
    def si(self) -> Constants:
        """a1..a6 for p in Pa and contraction as a fraction."""
        given = (self.a1, self.a2, self.a3, self.a4, self.a5, self.a6)
        return to_si(given, self.pressure_unit, self.contraction_unit)

    def force(self, p: ArrayLike, kappa: ArrayLike) -> Array:
        """Return the static force in N, pulling positive: equation (1).

        *p* is gauge Pa and *kappa* the contraction as a fraction of l0; arrays broadcast, and the
        result has their common shape. A negative force is one with which the law would push.
        """
        return _array(law.force_v(*alike(p=p, kappa=kappa), *self.si))

    def stiffness(self, p: ArrayLike, kappa: ArrayLike) -> Array:
        """Return k = -dF/dkappa / l0 in N/m, positive: equation (2), sign corrected.

        *p* is gauge Pa and *kappa* the contraction as a fraction of l0; arrays broadcast.
        """
        a1, a2, a3, a4, _, _ = self.si
        return _array(law.stiffness_v(*alike(p=p, kappa=kappa), a1, a2, a3, a4, self.l0))

    def damping(self, p: ArrayLike, kappa: ArrayLike, mass: ArrayLike) -> Array:
        """Return c in N s/m for a load of *mass* kg: equation (4), sign corrected."""
        p, kappa, mass = alike(p=p, kappa=kappa, mass=mass)
        if (mass < 0.0).any():
            refuse('mass', float(mass.min()), 'at least 0 kg')
        return _array(law.damping_v(self.stiffness(p, kappa), mass, self.zeta))

    def gain(self, kappa: ArrayLike) -> Array:
        """Return dF/dp in N/Pa."""
        a1, _, a3, a4, a5, _ = self.si
        return _array(law.gain_v(array('kappa', kappa), a1, a3, a4, a5))

    def potential(self, p: ArrayLike, kappa: ArrayLike) -> Array:
        """Return the work in J that (1) does from kappa = 0 to *kappa* at constant pressure."""
        return _array(law.potential_v(*alike(p=p, kappa=kappa), *self.si, self.l0))

    def pressure_for_force(self, wanted: ArrayLike, kappa: ArrayLike) -> Array:
        """Return the gauge pressure in Pa for a wanted force in N: (1) solved for p.

        Raises RangeError if the gain dF/dp is not positive or the pressure would lie outside
        p_min..p_max; the message names the first such point.
        """
        f, kappa = np.broadcast_arrays(*alike(wanted=wanted, kappa=kappa))
        with np.errstate(divide='ignore', invalid='ignore'):
            p = law.pressure_for_force_v(f, kappa, *self.si)
        p = np.where(self.gain(kappa) > 0.0, p, np.nan)
        slack = 1e-9 * (self.p_max - self.p_min)  # accepts the ends in spite of rounding
        bad = ~((p >= self.p_min - slack) & (p <= self.p_max + slack))
        if np.any(bad):
            i = np.unravel_index(np.argmax(bad), bad.shape)
            low, high = self.force(np.array([self.p_min, self.p_max]), kappa[i])
            raise RangeError(
                f'a force of {f[i]:g} N at contraction {kappa[i]:g} is out of reach: '
                f'{self.p_min / 1e3:g} to {self.p_max / 1e3:g} kPa give {low:.4g} to '
                f'{high:.4g} N there'
            )
        return _array(np.clip(p, self.p_min, self.p_max))

    def equilibrium(self, p: float, load: float) -> float:
        """Return the contraction at which (1) holds *load* N at *p* Pa.

        The search covers the branch of the law with positive stiffness, from kappa_min - 0.1 to
        kappa_max + 0.25, at most 0.95, since a light load rests beyond the rated contraction.
        Raises RangeError if there is no such contraction.
        """
        p, load = number('p', p), number('load', load)
        low, high = self.kappa_min - 0.1, min(self.kappa_max + 0.25, 0.95)
        ends = self.force(p, np.array([low, high]))
        if self.is_load_only or not ends[0] >= load >= ends[1]:
            raise RangeError(
                f'no equilibrium: at {p / 1e3:g} kPa the muscle pulls {ends[0]:.4g} N at '
                f'contraction {low:g} and {ends[1]:.4g} N at {high:g}, the load is {load:.4g} N'
            )
        # Newton's method in a bracket. The force decreases and is convex, so that the method never
        # overshoots from the left end. An import of scipy would cost a node 0.3 s at its start.
        a1, a2, a3, a4, _, _ = self.si
        kappa = low
        for _ in range(100):
            excess = float(law.force_v(_array(p), _array(kappa), *self.si)) - load
            low, high = (kappa, high) if excess >= 0.0 else (low, kappa)
            slope = float(law.slope_v(p, kappa, a1, a2, a3, a4))
            step = excess / slope if slope < 0.0 else np.inf
            last, kappa = kappa, kappa - step
            if not low <= kappa <= high:
                kappa = 0.5 * (low + high)
            if abs(kappa - last) < 1e-15:
                break
        return kappa


def _array(values: Any) -> Array:
    return np.asarray(values, dtype=float)
