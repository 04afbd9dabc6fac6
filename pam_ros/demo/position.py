# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Results of the demonstration's position control: series, table, figure."""

from dataclasses import dataclass, fields

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pam_ros.errors import PamError
from pam_ros.report.style import COLOURS, FAINT, INK, stacked, styled

Array = NDArray[np.float64]
WIDTH = 760
SETTLED = 0.1e-3  # m within which a step counts as settled
LAST = 0.5  # s at the end of a step over which the error is evaluated


@dataclass(frozen=True)
class PositionRun:
    """Series (n,), one sample per stamp, all in SI: s, m, m, m/s, Pa."""

    t: Array
    reference: Array
    position: Array
    surface: Array
    pressure: Array

    @property
    def error(self) -> Array:
        """Reference less position, m."""
        return self.reference - self.position

    def between(self, begin: float, end: float) -> 'PositionRun':
        """Return the part from *begin* up to *end* s."""
        inside = (self.t >= begin) & (self.t < end)
        return PositionRun(*(getattr(self, item.name)[inside] for item in fields(self)))

    def departure(self, begin: float, least: float) -> float:
        """Return the time in s at which the reference is *least* m away from its value at *begin*.

        Raises PamError if it stays there, and if samples are missing.
        """
        gaps = np.diff(self.t)
        if np.any(gaps > 1.5 * np.median(gaps)):
            raise PamError('messages of the controller were lost: is the machine overloaded?')
        rest = self.reference[self.t <= begin][-1]
        gone = (self.t > begin) & (np.abs(self.reference - rest) > least)
        if not np.any(gone):
            raise PamError(f'the reference stays at {rest:.6g} m from {begin:.3f} s on')
        return float(self.t[np.argmax(gone)])


def settling(step: PositionRun, goal: float) -> float:
    """Return the time in s after which the load stays within SETTLED of *goal* m, inf if never."""
    off = np.flatnonzero(np.abs(step.position - goal) > SETTLED)
    if not off.size:
        return 0.0
    if off[-1] == step.t.size - 1:
        return float('inf')
    return float(step.t[off[-1] + 1] - step.t[0])


def table(steps: list[tuple[float, PositionRun]], sine: PositionRun) -> str:
    """Return a table of the results: each of the *steps* is a goal in m and its run."""
    lines = [f'{"set-point":<24}{"settles in":>12}{"error at rest":>16}{"pressure range":>17}']
    for goal, step in steps:
        rest = step.between(step.t[-1] - LAST, np.inf)
        lines.append(
            f'{1e3 * goal:.1f} mm'.ljust(24)
            + f'{settling(step, goal):.2f} s'.rjust(12)
            + f'{1e6 * np.max(np.abs(goal - rest.position)):.1f} um'.rjust(16)
            + f'{1e-3 * np.ptp(rest.pressure):.2f} kPa'.rjust(17)
        )
    rms = np.sqrt(np.mean(sine.error**2))
    swing = 0.5 * np.ptp(sine.reference)
    lines.append(f'sine of {1e3 * swing:.1f} mm: error {1e6 * rms:.1f} um RMS')
    return '\n'.join(lines)


def figure(run: PositionRun, headline: str) -> Figure:
    """Draw position, error, pressure and sliding variable over time."""
    t = run.t - run.t[0]
    with styled():
        drawn, axes = stacked(WIDTH, (180, 120, 120, 120))
        axes[0].plot(t, 1e3 * run.reference, color=FAINT, linewidth=2.5, label='reference')
        axes[0].plot(t, 1e3 * run.position, color=COLOURS[2], label='position')
        axes[0].margins(y=0.2)
        axes[0].legend(loc='lower right', ncols=2, frameon=False)
        for ax, title, values in (
            (axes[1], 'error [mm]', 1e3 * run.error),
            (axes[2], 'pressure [kPa]', 1e-3 * run.pressure),
            (axes[3], 'sliding variable [mm/s]', 1e3 * run.surface),
        ):
            ax.set_title(title)
            ax.plot(t, values, color=COLOURS[0])
        for ax in (axes[1], axes[3]):
            ax.axhline(0.0, color=FAINT, linewidth=0.8, linestyle=(0, (4, 3)))
        axes[0].set_title('position [mm]')
        axes[0].set_title(headline, loc='right', color=INK, fontweight='bold')
        axes[-1].set_xlabel('time [s]')
        axes[-1].set_xlim(0.0, float(t[-1]))
    return drawn
