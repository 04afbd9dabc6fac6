# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Results of the demonstration's antagonistic joint: series, table, figure."""

from dataclasses import dataclass, fields

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pam_ros.report.style import COLOURS, FAINT, INK, stacked, styled

Array = NDArray[np.float64]
WIDTH = 760
STILL = 1e-6  # rad; a reference at rest moves less than this
LAST = 0.2  # s at the end of a set-point over which the stiffness is evaluated


@dataclass(frozen=True)
class JointRun:
    """Series (n,), one sample per stamp, all in SI: s, rad, rad, Pa, Pa, N m/rad, N m/rad.

    ``angle`` is measured; ``stiffness`` is that of the rig, ``co_contraction`` is its set-point.
    """

    t: Array
    reference: Array
    angle: Array
    pressure_1: Array
    pressure_2: Array
    co_contraction: Array
    stiffness: Array

    @property
    def error(self) -> Array:
        """Reference less angle, rad."""
        return self.reference - self.angle

    @property
    def departure(self) -> float:
        """The time in s at which the reference leaves its first value."""
        return float(self.t[np.argmax(np.abs(self.reference - self.reference[0]) > STILL)])

    def with_stiffness(self, wanted: float) -> 'JointRun':
        """Return the part in which the present set-point of the stiffness is *wanted* N m/rad."""
        return self._where(np.abs(self.co_contraction - wanted) < 1e-6 * wanted)

    def _where(self, inside: NDArray[np.bool_]) -> 'JointRun':
        return JointRun(*(getattr(self, item.name)[inside] for item in fields(self)))

    def between(self, begin: float, end: float) -> 'JointRun':
        """Return the part from *begin* up to *end* s."""
        return self._where((self.t >= begin) & (self.t < end))


def table(parts: list[tuple[str, JointRun]]) -> str:
    """Return a table of error and stiffness in each of the *parts*, by their names."""
    lines = [f'{"":<26}{"amplitude":>10}{"error RMS":>13}{"largest":>12}{"N m/rad":>12}{"set":>8}']
    for name, part in parts:
        error = np.degrees(part.error)
        last = part.between(part.t[-1] - LAST, np.inf)
        lines.append(
            f'{name:<26}'
            + f'{0.5 * np.degrees(np.ptp(part.reference)):.1f} deg'.rjust(10)
            + f'{np.sqrt(np.mean(error**2)):.3f} deg'.rjust(13)
            + f'{np.max(np.abs(error)):.3f} deg'.rjust(12)
            + f'{np.mean(last.stiffness):.2f}'.rjust(12)
            + f'{np.mean(last.co_contraction):.2f}'.rjust(8)
        )
    return '\n'.join(lines)


def figure(run: JointRun, headline: str) -> Figure:
    """Draw angle, error, both pressures and the stiffness over time."""
    t = run.t - run.t[0]
    with styled():
        drawn, axes = stacked(WIDTH, (180, 110, 140, 120))
        angle, error, pressure, stiffness = axes
        angle.plot(t, np.degrees(run.reference), color=FAINT, linewidth=2.5, label='reference')
        angle.plot(t, np.degrees(run.angle), color=COLOURS[2], label='angle')
        angle.margins(y=0.25)
        error.plot(t, np.degrees(run.error), color=COLOURS[0], linewidth=0.8)
        error.axhline(0.0, color=FAINT, linewidth=0.8, linestyle=(0, (4, 3)))
        pressure.plot(t, 1e-3 * run.pressure_1, color=COLOURS[0], label='first muscle')
        pressure.plot(t, 1e-3 * run.pressure_2, color=COLOURS[2], label='second muscle')
        pressure.margins(y=0.25)
        stiffness.plot(
            t, run.co_contraction, color=FAINT, linewidth=2.5, label='set (co-contraction)'
        )
        stiffness.plot(t, run.stiffness, color=COLOURS[2], label='of the rig')
        stiffness.margins(y=0.3)
        for ax, title in (
            (angle, 'angle [degrees]'),
            (error, 'error [degrees]'),
            (pressure, 'pressure [kPa]'),
            (stiffness, 'stiffness of the joint [N m/rad]'),
        ):
            ax.set_title(title)
            if ax is not error:
                ax.legend(loc='upper right', ncols=2, frameon=False)
        angle.set_title(headline, loc='right', color=INK, fontweight='bold')
        stiffness.set_xlabel('time [s]')
        stiffness.set_xlim(0.0, float(t[-1]))
    return drawn
