# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Plots as a PNG file."""

import io
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from matplotlib.figure import Figure

from pam_ros.errors import PamError
from pam_ros.plot.colours import colour
from pam_ros.plot.panels import Panel
from pam_ros.report.style import stacked, styled

WIDTH, HEIGHT = 1080, 130  # px of the figure, and of one of its plots
FINE = 144  # dots per inch: twice as fine as the pixels
MOST_NAMES = 8  # in one legend


def figure(panels: Sequence[Panel], start: float, end: float) -> Figure:
    """Return the *panels* one below the other, from *start* to *end* s."""
    with styled():
        made, axes = stacked(WIDTH, (HEIGHT,) * len(panels))
        for ax, panel in zip(axes, panels, strict=True):
            ax.set_title(panel.title)
            for line in panel.lines:
                ax.plot(
                    line.t,
                    line.value,
                    color=colour(line.number),
                    linewidth=3.2 if line.is_set_point else 1.2,
                    alpha=0.35 if line.is_set_point else 1.0,
                    drawstyle='steps-post' if line.is_held else 'default',
                    solid_capstyle='butt',
                    label=line.name,
                )
            handles, names = ax.get_legend_handles_labels()
            ax.legend(
                handles[-MOST_NAMES:],
                names[-MOST_NAMES:],
                loc='lower right',
                bbox_to_anchor=(1.0, 1.0),
                ncols=MOST_NAMES,
                frameon=False,
                borderpad=0.0,
                borderaxespad=0.3,
                handlelength=1.4,
            )
        axes[-1].set_xlim(start, end)
        axes[-1].set_xlabel('time, s')
    return made


def save(made: Figure, path: Path) -> None:
    """Write a figure as PNG, completely or not at all.

    Raises PamError if the file cannot be written.
    """
    stream = io.BytesIO()
    with styled():
        made.savefig(stream, format='png', dpi=FINE, facecolor='white')
    part = path.with_name(f'.{path.name}.part')
    try:
        part.write_bytes(stream.getvalue())
        part.replace(path)
    except OSError as error:
        with suppress(OSError):
            part.unlink()
        raise PamError(f'{path} cannot be written: {error.strerror}') from error
