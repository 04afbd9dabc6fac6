# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Plots as a PNG file."""

import io
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from pam_ros.errors import PamError
from pam_ros.plot.colours import colour
from pam_ros.plot.panels import Panel
from pam_ros.plot.shown_units import choices, in_units
from pam_ros.plot.thinning import is_outlier, thinned
from pam_ros.plot.value_axis import value_axis
from pam_ros.report.style import stacked, styled

WIDTH, HEIGHT = 1080, 130  # px of the figure, and of one of its plots
FINE = 144  # dots per inch: twice as fine as the pixels
COLUMNS = 1000  # of time to which a line is thinned: about as many as a plot has pixels
MOST_NAMES = 8  # in one legend


def figure(panels: Sequence[Panel], start: float, end: float) -> Figure:
    """Return the *panels* one below the other, from *start* to *end* s.

    Pressures are in kPa, and positions in mm or deg if their unit is known. Samples that are
    outside an axis are counted at its edge, see :func:`pam_ros.plot.value_axis.value_axis`.
    """
    with styled():
        made, axes = stacked(WIDTH, (HEIGHT,) * len(panels))
        choice = choices(panels)[0]
        shown = [in_units(panel, choice) for panel in panels]
        for ax, panel in zip(axes, shown, strict=True):
            ax.set_title(panel.title)
            _set_range(ax, panel, start, end)
            for line in thinned(panel, start, end, COLUMNS).lines:
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


def _set_range(ax: Axes, panel: Panel, start: float, end: float) -> None:
    """Set the range of an axis, and mark the samples that are outside."""
    low, high, above, below = value_axis(panel.lines, start, end)
    ax.set_ylim(low, high)
    for count, sign, edge in ((above, '▲', high), (below, '▼', low)):
        if count:
            what = 'sample is' if count == 1 else 'samples are'
            ax.annotate(
                f'{sign} {count} {what} outside',
                (end, edge),
                (-4.0, -4.0 if edge == high else 4.0),
                textcoords='offset points',
                ha='right',
                va='top' if edge == high else 'bottom',
                fontsize='small',
            )
    for line in panel.lines:
        is_out = is_outlier(line) & ((line.value > high) | (line.value < low))
        for is_own, marker, edge in (
            (is_out & (line.value > high), '^', high),
            (is_out & (line.value < low), 'v', low),
        ):
            at = line.t[is_own]
            if at.size:
                edges = np.full(at.size, edge)
                ax.plot(at, edges, marker, color=colour(line.number), clip_on=False)


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
