# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The constants of a self-made McKibben muscle from the geometry of its braid.

A braid of inextensible threads around a cylinder at p Pa pulls, by virtual work, with the force

    F = pi r^2 p (a (1 - k kappa)^2 - b),    a = 3 / tan(angle)^2,    b = 1 / sin(angle)^2

(Chou and Hannaford 1996 for k = 1; Tondu and Lopez 2000 with k for the ends, which stay narrow).
The force law (1) of Sárosi (2015) has an exponential and a straight line instead of the parabola.
For a given a3 they are fitted to the parabola by least squares, from contraction 0 to the greatest
permitted one.
"""

from dataclasses import dataclass
from math import pi, radians, sin, sqrt, tan
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.arguments import alike
from pam_ros.cached_property import cached_property
from pam_ros.constructors import RefusesUnknownNames
from pam_ros.errors import ParameterError
from pam_ros.muscle.constants import CONSTANTS, Constants
from pam_ros.muscle.muscle import Muscle
from pam_ros.parameters import check_all, described, parameter_field

Array = NDArray[np.float64]
# a3 times the greatest contraction. The smaller its size, the closer an exponential follows a
# parabola, but the larger are a1 and a4, which then cancel each other. With 0.9 the error is below
# 0.5 % of the greatest force, and each of them is about as large as the force.
BEND = -0.9
POINTS = 401  # number of contractions in the fit


@dataclass(frozen=True)
class Braid(metaclass=RefusesUnknownNames):
    """The braid of a McKibben muscle at rest, without pressure and load.

    ``radius`` is in m, ``angle`` in degrees from the axis, ``end_factor`` a number from 1 to 2.
    ``bladder`` describes not the geometry but a stiffness, which the law of the braid does not
    contain. It reduces the force by bladder (1 - exp(a3 kappa)) at all pressures. Without a
    measurement its value is very uncertain: give it a wide prior in an identification
    (``--uncertain a2=1000%``).

    Raises ParameterError for a value that is not allowed.
    """

    radius: float = parameter_field(
        0.01, 'radius of the braid at rest', 'm', low=5e-4, high=0.2, live=False
    )
    angle: float = parameter_field(
        20.0,
        'angle between the threads of the braid and the axis of the muscle at rest',
        'deg',
        low=1.0,
        high=54.0,
        live=False,
    )
    end_factor: float = parameter_field(
        1.0,
        'factor of the contraction for the ends, which stay narrow; 1: as wide as the middle',
        low=1.0,
        high=2.0,
        live=False,
    )
    bladder: float = parameter_field(
        10.0,
        'force with which the bladder resists large contractions',
        'N',
        low=1e-3,
        high=1e4,
        live=False,
    )

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)

    @cached_property
    def _ab(self) -> tuple[float, float]:
        angle = radians(self.angle)
        return 3.0 / tan(angle) ** 2, 1.0 / sin(angle) ** 2

    def force(self, p: ArrayLike, kappa: ArrayLike) -> Array:
        """Return the force of the braid in N at p Pa gauge, without the bladder.

        Arrays broadcast; kappa is the contraction as a fraction of the length at rest.
        """
        p, kappa = alike(p=p, kappa=kappa)
        return np.asarray(p * self._per_pressure(kappa), dtype=float)

    def _per_pressure(self, kappa: Array) -> Array:
        a, b = self._ab
        force: Array = pi * self.radius**2 * (a * (1.0 - self.end_factor * kappa) ** 2 - b)
        return force

    @property
    def greatest_contraction(self) -> float:
        """Contraction from which the braid no longer pulls: its angle is 54.7 degrees there."""
        a, b = self._ab
        return (1.0 - sqrt(b / a)) / self.end_factor

    def constants(self, kappa_max: float) -> Constants:
        """Return a1..a6 in SI units, fitted for contractions from 0 to *kappa_max*.

        Raises ParameterError for a *kappa_max* at which the braid no longer pulls.
        """
        if not 0.0 < kappa_max < self.greatest_contraction:
            raise ParameterError(
                f'kappa_max = {kappa_max:g} is not allowed: this braid no longer pulls '
                f'from a contraction of {self.greatest_contraction:.3g} on; give less'
            )
        kappa = np.linspace(0.0, kappa_max, POINTS)
        a3 = BEND / kappa_max
        columns = np.stack([np.exp(a3 * kappa), kappa, np.ones_like(kappa)], axis=1)
        found = np.linalg.lstsq(columns, self._per_pressure(kappa), rcond=None)[0]
        a1, a4, a5 = (float(x) for x in found)
        return a1, self.bladder, a3, a4, a5, -self.bladder

    def misfit(self, constants: Constants, kappa_min: float, kappa_max: float) -> float:
        """Return the greatest error of the force law relative to the greatest force of the braid.

        Both are without the bladder, for contractions from *kappa_min* to *kappa_max*.
        *constants* are those of the force law in SI units, see :meth:`constants`.
        """
        a1, _, a3, a4, a5, _ = constants
        kappa = np.linspace(kappa_min, kappa_max, POINTS)
        braid = self._per_pressure(kappa)
        law = a1 * np.exp(a3 * kappa) + a4 * kappa + a5
        return float(np.max(np.abs(law - braid)) / np.max(np.abs(braid)))

    def fields(self, p_max: float, kappa_min: float, kappa_max: float) -> dict[str, Any]:
        """Return the properties of a muscle with this braid, by the names of the fields of Muscle.

        *p_max* in Pa and the contractions are the limits of the muscle. ``source`` states the
        geometry, and the greatest difference between the force law and that of the braid. Raises
        ParameterError as :meth:`constants` does.
        """
        constants = self.constants(kappa_max)
        source = (
            f'braid of radius {self.radius:g} m and {self.angle:g} deg, end factor '
            f'{self.end_factor:g}; law of Tondu and Lopez 2000, within '
            f'{100.0 * self.misfit(constants, kappa_min, kappa_max):.2g} % of its greatest force'
        )
        return {
            **dict(zip(CONSTANTS, constants, strict=True)),
            'pressure_unit': 'Pa',
            'contraction_unit': 'fraction',
            'inside_diameter': 2.0 * self.radius,
            'force_max': float(self.force(p_max, 0.0)),
            'source': source,
        }

    def muscle(self, **fields: Any) -> Muscle:
        """Return a muscle with this braid; *fields* are other fields of Muscle.

        By default its inside diameter is that of the braid, its rated force the one at ``p_max``
        and contraction 0, and its ``source`` the geometry with the greatest difference between
        both laws. Raises ParameterError as :meth:`constants` and Muscle do, and if *fields*
        contains constants or their units.
        """
        for name in (*CONSTANTS, 'pressure_unit', 'contraction_unit'):
            if name in fields:
                raise ParameterError(f'{name} follows from the braid: it cannot be given as well')
        about = described(Muscle)
        p_max, low, high = (
            float(about[name][2].check(name, fields.get(name, about[name][1]), float))
            for name in ('p_max', 'kappa_min', 'kappa_max')
        )
        return Muscle(**{**self.fields(p_max, low, high), **fields})
