# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The signature of an effect: what it changes on a rig, and the residual that it leaves.

A load of 10 kg hangs from the default muscle. It is simulated along one programme with the example
of the effect, and without it.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from pam_ros.effects.base import Effect
from pam_ros.report.style import COLOURS, FAINT, styled
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import Trajectory, simulate
from pam_ros.rig.standard_joints import single_muscle_joint

Array = NDArray[np.float64]

RATE = 200.0  # Hz
MASS = 10.0  # kg
# The programme: s and kPa of its corners. Steps, slow ramps down to no pressure, and a chirp.
REST = 5.0  # s before 0, which the pictures do not show: the load comes to rest
STEPS = ((1, 300), (3, 200), (5, 400), (7, 100), (9.5, 100))
RAMPS = ((9.5, 100), (15.5, 400), (18.5, 200), (20.5, 300), (26.5, 0), (29, 250))
CHIRP = (29.0, 37.0, 0.3, 2.5)  # s, s, Hz, Hz
CHIRP_KPA = (250.0, 100.0)  # mean and amplitude
ZOOM = (4.8, 8.8)  # s; one step up and one down

WITHOUT = {'color': FAINT, 'linewidth': 1.0, 'label': 'model without it'}
LEAST = 0.05  # mm; residuals below it are shown as none
DPI, COLOUR_COUNT = 108, 48


def programme() -> tuple[Array, Array]:
    """Return the stamps in s and the commands in Pa, both (n,)."""
    begin, end, slow, fast = CHIRP
    t = np.arange(round((REST + end) * RATE)) / RATE - REST
    at, levels = np.array(STEPS).T
    kpa = np.array([100.0, *levels])[np.searchsorted(at, t + 1e-9)[t < at[-1]]]
    ramps = np.interp(t[(t >= at[-1]) & (t < begin)], *np.array(RAMPS).T)
    since, growth = t[t >= begin] - begin, np.log(fast / slow) / (end - begin)
    mean, amplitude = CHIRP_KPA
    sweep = mean + amplitude * np.sin(2 * np.pi * slow * np.expm1(since * growth) / growth)
    return t, 1e3 * np.concatenate([kpa, ramps, sweep])


@dataclass(frozen=True)
class Signature:
    """The same programme with an effect and without it; positions in mm, over the time from 0."""

    t: Array
    command: Array
    with_it: Trajectory
    without: Trajectory

    @property
    def residual(self) -> Array:
        """The position with the effect minus the one without, in mm."""
        return 1e3 * (self.with_it.position - self.without.position)

    @property
    def rms(self) -> float:
        """The RMS of the residual in mm."""
        return float(np.sqrt(np.mean(self.residual[self.t >= 0.0] ** 2)))

    @property
    def largest(self) -> float:
        """The largest residual in mm."""
        return float(np.abs(self.residual[self.t >= 0.0]).max())


def signature_of(effect: Effect) -> Signature:
    """Return what *effect* changes along the programme."""
    t, command = programme()
    with_it, without = (
        simulate(single_muscle_joint(load=Mass(MASS), effects=effects), t, command)
        for effects in ([effect], [])
    )
    return Signature(t, command, with_it, without)


def figure_of(effect: Effect, shown: Signature) -> Figure:
    """Return the picture: two steps, and the residual over the command and over the time."""
    width, height = 760.0, 452.0
    t, kpa = shown.t, 1e-3 * shown.command
    figure = Figure(figsize=(width / 72, height / 72), dpi=72)

    def axes(left: float, top: float, wide: float, high: float) -> Axes:
        box = (left / width, 1 - (top + high) / height, wide / width, high / height)
        return figure.add_axes(box)

    with_it = {'color': COLOURS[0], 'label': f'with {effect.name}'}
    pressure, position = axes(50, 52, 330, 82), axes(50, 170, 330, 100)
    loop, residual = axes(440, 52, 306, 218), axes(50, 334, 696, 76)
    window = (t >= ZOOM[0]) & (t < ZOOM[1])
    pressure.set_title('pressure in the muscle [kPa]')
    position.set_title('position of the load [mm], over the time [s]')
    for run, style in ((shown.without, WITHOUT), (shown.with_it, with_it)):
        pressure.plot(t[window], 1e-3 * run.pressure[window], **style)
        position.plot(t[window], 1e3 * run.position[window], **style)
    pressure.tick_params(labelbottom=False)
    loop.set_title('residual [mm] over the command [kPa], slow ramps')
    slow = (t >= RAMPS[0][0]) & (t < RAMPS[-2][0])
    loop.plot(kpa[slow], shown.residual[slow], color=COLOURS[2])
    _show_zero(loop)
    residual.set_title('residual of the model without it [mm], over the time [s]')
    seen = t >= 0.0
    residual.plot(t[seen], shown.residual[seen], color=COLOURS[2])
    residual.set_xlim(0.0, CHIRP[1])
    _show_zero(residual)
    low, high = residual.get_ylim()
    residual.set_ylim(low, high + 0.25 * (high - low))  # room for the names of the parts
    for begin, text in ((0.0, 'steps'), (RAMPS[0][0], 'slow ramps'), (CHIRP[0], 'chirp')):
        residual.axvline(begin, color=FAINT, linewidth=0.6, linestyle=(0, (4, 3)))
        residual.annotate(
            text,
            (begin, 1.0),
            (4, -10),
            xycoords=('data', 'axes fraction'),
            textcoords='offset points',
            color=FAINT,
            fontsize=10,
        )
    figure.legend(*pressure.get_legend_handles_labels(), loc='upper left', ncols=2, frameon=False)
    return figure


def _show_zero(ax: Axes) -> None:
    """Extend the range to zero, and to what a sensor would notice."""
    low, high = ax.dataLim.intervaly
    low, high = min(low, -LEAST), max(high, LEAST)
    margin = 0.05 * (high - low)
    ax.set_ylim(low - margin, high + margin)
    ax.ticklabel_format(axis='y', useOffset=False)


def draw(effect: Effect, shown: Signature, path: Path) -> None:
    """Write the picture as a small PNG file."""
    with styled():
        figure_of(effect, shown).savefig(path, format='png', dpi=DPI, facecolor='white')
    with Image.open(path) as picture:
        small = picture.convert('RGB').quantize(COLOUR_COUNT)
    small.save(path, optimize=True)
