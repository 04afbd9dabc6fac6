# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The static force of a muscle over contraction and pressure, as data sheets draw it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.arguments import array, instance, refuse_shape
from pam_ros.muscle.muscle import Muscle

Array = NDArray[np.float64]
POINTS, CURVES = 101, 7


@dataclass(frozen=True, eq=False)
class ForceMap:
    """The force of a muscle by the force law (1), in N, pulling positive.

    ``contraction`` (n,) is a fraction of the length at rest, ``pressure`` (m,) is gauge Pa, and
    ``force`` (m, n) has a row for each pressure. A negative force is one with which the muscle
    would push: the law has it, a real muscle is slack there.
    """

    contraction: Array
    pressure: Array
    force: Array

    def plot(self, axes: Any = None) -> Any:
        """Draw the force over the contraction, a curve for each pressure; return the axes.

        *axes* are those of matplotlib to draw into; if None, a new figure of pyplot is made.
        """
        if axes is None:
            from matplotlib import pyplot as plt

            axes = plt.subplots(layout='constrained')[1]
        for pressure, force in zip(self.pressure, self.force, strict=True):
            axes.plot(100.0 * self.contraction, force, label=f'{1e-3 * pressure:g} kPa')
        axes.axhline(0.0, color='0.6', linewidth=0.8)
        axes.set_xlabel('contraction [%]')
        axes.set_ylabel('force [N]')
        axes.legend(title='pressure', frameon=False)
        return axes


def force_map(
    muscle: Muscle, contraction: ArrayLike | None = None, pressure: ArrayLike | None = None
) -> ForceMap:
    """Return the force of *muscle* at each *contraction* and each *pressure*.

    *contraction* (n,) is a fraction of the length at rest (default: 101 from ``kappa_min`` to
    ``kappa_max`` of the muscle), *pressure* (m,) is gauge Pa (default: 7 from ``p_min`` to
    ``p_max``). Raises ParameterError for other shapes and for numbers that are not finite.
    """
    instance('muscle', muscle, Muscle, 'a Muscle')
    if contraction is None:
        contraction = np.linspace(muscle.kappa_min, muscle.kappa_max, POINTS)
    if pressure is None:
        pressure = np.linspace(muscle.p_min, muscle.p_max, CURVES)
    kappa, p = _row('contraction', contraction), _row('pressure', pressure)
    return ForceMap(kappa, p, muscle.force(p[:, None], kappa))


def _row(name: str, values: ArrayLike) -> Array:
    """Return *values* as (n,), one number for a single one."""
    found = np.atleast_1d(array(name, values))
    if found.ndim != 1 or not found.size:
        refuse_shape(name, found, '(n,), at least one number')
    return found
