# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The style of the plots of a report, and their conversion to SVG inside a page.

Figures are sized in CSS pixels, 1:1 on the page, so that their text has the size of the page's.
"""

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator
from numpy.typing import NDArray

from pam_ros.identification.wording import number

Array = NDArray[np.float64]

INK, FAINT, GRID = '#1f2328', '#59636e', '#e4e7eb'
MEASURED = '#9aa4af'
# Distinct for every kind of colour vision, and by their lightness in print (Okabe and Ito).
COLOURS = ('#c8500a', '#b8860b', '#0b62a8')
DASHES: tuple[Any, ...] = ((0, (4, 1.5)), (0, (1.5, 1)), 'solid')
NOISE = '#7a4fa3'
# The noise is pale in each plot, as a band or as a line: line styles distinguish the models.
NOISE_LINE: dict[str, Any] = {'color': NOISE, 'linewidth': 4.0, 'alpha': 0.35}
HELD_OUT = '#eef3f8'
SINCE = '#b3124a'

WIDE, NARROW = 1080, 356
_PIXEL = 1.0 / 72.0  # inches: an SVG of matplotlib has 72 units an inch
_SIZE = 11.5

_RC: Any = {
    'svg.fonttype': 'none',
    'svg.hashsalt': 'pam_ros',
    'font.size': _SIZE,
    'font.family': 'DejaVu Sans',
    'axes.linewidth': 0.8,
    'axes.edgecolor': FAINT,
    'axes.labelcolor': FAINT,
    'axes.labelsize': _SIZE,
    'axes.titlesize': _SIZE,
    'axes.titlecolor': FAINT,
    'axes.titlepad': 7.0,
    'axes.titlelocation': 'left',
    'axes.spines.top': False,
    'axes.spines.right': False,
    'axes.grid': True,
    'axes.axisbelow': True,
    'axes.unicode_minus': True,
    'grid.color': GRID,
    'grid.linewidth': 0.8,
    'xtick.color': FAINT,
    'ytick.color': FAINT,
    'xtick.labelsize': 11.0,
    'ytick.labelsize': 11.0,
    'xtick.major.size': 3.0,
    'ytick.major.size': 0.0,
    'lines.linewidth': 1.2,
    'lines.solid_joinstyle': 'round',
    'path.simplify': True,
    'path.simplify_threshold': 0.2,
}


@contextmanager
def styled() -> Iterator[None]:
    """Draw figures in the style of the page within this context, whatever the user has set."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_RC)
        yield


def stacked(width: int, heights: tuple[int, ...]) -> tuple[Figure, list[Axes]]:
    """Return a figure of *width* px with one plot above the other, of these *heights* in px.

    They share the horizontal axis; its label has room below the last one.
    """
    left, right, top, bottom, between = 56, 14, 26, 42, 34
    total = top + sum(heights) + between * (len(heights) - 1) + bottom
    figure = Figure(figsize=(width * _PIXEL, total * _PIXEL), dpi=72)
    FigureCanvasSVG(figure)
    axes: list[Axes] = []
    y = float(total - top)
    for height in heights:
        y -= height
        box = (left / width, y / total, (width - left - right) / width, height / total)
        axes.append(figure.add_axes(box, sharex=axes[0] if axes else None))
        y -= between
    for ax in axes[:-1]:
        ax.tick_params(labelbottom=False)
    for ax in axes:
        ax.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
        ax.yaxis.set_major_formatter(FuncFormatter(plain_tick))
        ax.xaxis.set_major_locator(MaxNLocator(6 if width < 600 else 11, steps=[1, 2, 5, 10]))
        ax.xaxis.set_major_formatter(FuncFormatter(plain_tick))
    return figure, axes


def panel(height: int = 190) -> tuple[Figure, Axes]:
    """Return a figure with one plot, as wide as a telephone or a third of a page."""
    figure, axes = stacked(NARROW, (height,))
    return figure, axes[0]


def plain_tick(value: float, _: int) -> str:
    """Return the label of a tick: no more digits than needed, never an offset."""
    text = f'{value:.10g}'
    if 'e' in text:
        return number(value, 2)
    return text.replace('-', '−')


def log_axis(axis: Any) -> None:
    """Give a logarithmic axis of at least one decade labels in plain numbers."""
    low, high = axis.get_view_interval()
    short = np.log10(high / low)
    if short < 1.0:
        grow = 10.0 ** (0.5 * (1.0 - short))
        axis.axes.set(**{f'{axis.axis_name}lim': (low / grow, high * grow)})
    axis.set_major_locator(LogLocator(subs=(1.0,) if short > 1.6 else (1.0, 2.0, 5.0), numticks=7))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(plain_tick))


def svg(figure: Figure, name: str, text: str) -> str:
    """Return *figure* as an SVG element for use in a page.

    Its ids begin with *name*, which must be unique in the page; *text* describes the figure for
    readers who cannot see it.
    """
    stream = io.StringIO()
    figure.savefig(
        stream, format='svg', metadata={'Date': None, 'Creator': None}, transparent=True
    )
    whole = stream.getvalue()
    body = whole[whole.index('<svg') :]
    body = re.sub(r'<metadata>.*?</metadata>\s*', '', body, flags=re.DOTALL)
    body = re.sub(r'<style type="text/css">.*?</style>', '', body, flags=re.DOTALL)
    body = re.sub(r'\bid="', f'id="{name}-', body)
    body = body.replace('url(#', f'url(#{name}-').replace('href="#', f'href="#{name}-')
    width, height = figure.get_size_inches() * 72.0
    head = (
        f'<svg class="plot" viewBox="0 0 {width:g} {height:g}" role="img" '
        f'aria-label="{text}" data-name="{name}" xmlns="http://www.w3.org/2000/svg" '
        'xmlns:xlink="http://www.w3.org/1999/xlink">'
    )
    return head + body[body.index('>') + 1 :].strip()


def envelope(t: Array, values: Array, columns: int) -> tuple[Array, Array]:
    """Return a curve thinned to its least and greatest value in each of *columns* parts.

    If it is drawn over as many pixels, it looks like the whole curve.
    """
    if t.size <= 4 * columns:
        return t, values
    edges = np.linspace(0, t.size, columns + 1).astype(int)
    order = np.minimum.reduceat, np.maximum.reduceat
    low, high = (pick(values, edges[:-1]) for pick in order)
    middle = 0.5 * (t[edges[:-1]] + t[edges[1:] - 1])
    # Low first if the curve rises, high first if it falls: this avoids a sawtooth.
    rises = values[edges[1:] - 1] >= values[edges[:-1]]
    first, second = np.where(rises, low, high), np.where(rises, high, low)
    quarter = 0.25 * (t[edges[1:] - 1] - t[edges[:-1]])
    at = np.stack([middle - quarter, middle + quarter], axis=1).ravel()
    return at, np.stack([first, second], axis=1).ravel()
