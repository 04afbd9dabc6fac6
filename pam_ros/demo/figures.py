# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's figures 5 and 6 from a recorded run, and its pressure steps."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from pam_ros.demo.paper import SPRING_FORCE
from pam_ros.demo.run import PublishedRun
from pam_ros.report.style import COLOURS, FAINT, INK, stacked, styled
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint

WIDTH = 760
MODEL, MEASURED = COLOURS[2], COLOURS[0]


def save(figure: Figure, path: Path) -> None:
    """Write a figure as PNG, with twice the resolution of a screen."""
    with styled():
        figure.savefig(path, format='png', dpi=144, facecolor='white')


def figure_5(run: PublishedRun, model: Joint) -> Figure:
    """Draw stiffness, damping ratio and damping coefficient over contraction.

    Lines are equations (2) and (4) over the working range. Dots are the values that were published
    while the released load of *run* oscillated.
    """
    muscle, load = model.muscle, model.load
    p = float(run.pressure[-1])
    kappa = np.linspace(0.0, muscle.kappa_max, 201)
    k, c = muscle.stiffness(p, kappa), muscle.damping(p, kappa, load.mass)
    seen = slice(None, None, max(1, len(run.t) // 400))
    at = 100.0 * run.position[seen] / muscle.l0
    k_seen, c_seen = run.stiffness[seen], run.damping[seen]
    panels = (
        (
            'damping ratio ζ [-]',
            np.full_like(kappa, muscle.zeta),
            0.5 * c_seen / np.sqrt(load.mass * k_seen),
        ),
        ('stiffness k [N/m]', k, k_seen),
        ('damping coefficient c [N s/m]', c, c_seen),
    )
    with styled():
        figure, axes = stacked(WIDTH, (110, 170, 170))
        for ax, (title, line, dots) in zip(axes, panels, strict=True):
            ax.set_title(title)
            ax.plot(100.0 * kappa, line, color=MODEL, label='equations (2) and (4)')
            ax.plot(at, dots, '.', color=MEASURED, markersize=4, label='published by pam_sim')
            ax.set_ylim(0.0, 1.12 * max(float(line.max()), float(dots.max())))
        axes[0].set_ylim(0.0, 2.0 * muscle.zeta or 1.0)
        axes[0].legend(loc='upper right', ncols=2, frameon=False)
        axes[-1].set_xlabel('contraction [%]')
        axes[-1].set_xlim(0.0, 100.0 * muscle.kappa_max)
        axes[-1].xaxis.set_major_locator(MultipleLocator(5.0))
        _headline(figure, f'Figure 5 of the paper: {p / 1e3:.0f} kPa and {load.mass:g} kg')
    return figure


def figure_6(run: PublishedRun, model: Joint) -> Figure:
    """Draw acceleration, velocity and spring force of the released load over time."""
    load = model.load
    panels = (
        ('acceleration [m/s²]', run.acceleration(model), 0.0),
        ('velocity [m/s]', run.velocity, 0.0),
        ('spring force F_spring [N]', run.force, float(statics.weight(model, 0.0))),
    )
    with styled():
        figure, axes = stacked(WIDTH, (150, 150, 150))
        for ax, (title, values, rest) in zip(axes, panels, strict=True):
            ax.set_title(title)
            ax.axhline(rest, color=FAINT, linewidth=0.8, linestyle=(0, (4, 3)))
            ax.plot(run.t - run.t[0], values, color=MODEL)
        axes[-1].annotate(
            f'at rest {run.force[-1]:.1f} N (paper: {SPRING_FORCE:g} N)',
            (1.0, float(run.force[-1])),
            (-6, 10),
            xycoords=('axes fraction', 'data'),
            textcoords='offset points',
            ha='right',
            color=INK,
        )
        if run.force.min() < 0.0:
            axes[-1].text(
                0.99,
                0.93,
                "below 0 the paper's law pushes, where a real muscle goes slack",
                transform=axes[-1].transAxes,
                ha='right',
                va='top',
                color=FAINT,
            )
        axes[-1].set_xlabel('time [s]')
        axes[-1].set_xlim(0.0, round(float(run.t[-1] - run.t[0]), 1))
        axes[-1].xaxis.set_major_locator(MultipleLocator(0.5))
        p = float(run.pressure[-1])
        _headline(
            figure,
            f'Figure 6 of the paper: {p / 1e3:.0f} kPa and {load.mass:g} kg, released',
        )
    return figure


def figure_steps(runs: Sequence[PublishedRun], model: Joint) -> Figure:
    """Draw pressure, contraction and spring force over a series of pressure steps."""
    l0, load = model.muscle.l0, model.load
    start = runs[0].t[0]
    with styled():
        figure, axes = stacked(WIDTH, (100, 180, 150))
        for run in runs:
            t, p = run.t - start, float(run.pressure[-1])
            kappa = 100.0 * model.muscle.equilibrium(p, float(statics.weight(model, 0.0)))
            axes[0].plot(t, run.pressure / 1e3, color=MODEL)
            axes[1].plot(
                t[[0, -1]], [kappa, kappa], color=FAINT, linewidth=0.8, linestyle=(0, (4, 3))
            )
            axes[1].plot(t, 100.0 * run.position / l0, color=MODEL)
            axes[1].annotate(
                f'{kappa:.1f} %', (t[-1], kappa), (-4, 4), textcoords='offset points', ha='right'
            )
            axes[2].plot(t, run.force, color=MODEL)
        axes[2].axhline(
            float(statics.weight(model, 0.0)), color=FAINT, linewidth=0.8, linestyle=(0, (4, 3))
        )
        for ax, title in zip(
            axes,
            ('pressure [kPa]', 'contraction [%], dashed: equation (1) = m g', 'spring force [N]'),
            strict=True,
        ):
            ax.set_title(title)
        axes[0].set_ylim(0.0, 1.1 * model.muscle.p_max / 1e3)
        axes[-1].set_xlabel('time [s]')
        axes[-1].set_xlim(0.0, runs[-1].t[-1] - start)
        _headline(figure, f'Pressure steps with {load.mass:g} kg')
    return figure


def _headline(figure: Figure, text: str) -> None:
    """Put *text* above the first plot, to the right, next to its title."""
    ax = figure.axes[0]
    ax.set_title(text, loc='right', color=INK, fontweight='bold')
