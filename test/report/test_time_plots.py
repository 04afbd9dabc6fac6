# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Plots over time: which stretch, which ground, which numbers."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from pam_ros.identification.wording import Scale
from pam_ros.report import style, time_plots
from pam_ros.report.diagnostics import Size
from pam_ros.report.time_plots import Curve

MM = Scale(1e3, 'mm')
CURVES = [Curve(0, 'nominal'), Curve(1, 're-tuned'), Curve(2, 'last')]


def test_overview_puts_runs_side_by_side(tested):
    _, _, runs = tested
    stretches = time_plots.whole(runs)
    ends = [(s.run.t[s.start] + s.shift, s.run.t[s.stop - 1] + s.shift) for s in stretches]
    assert ends[0][0] == 0.0
    for (_, before), (after, _) in pairwise(ends):
        assert 0.0 < after - before < 1.0


def test_close_up_is_where_the_models_differ_most_and_kept_back(tested):
    _, _, runs = tested
    close = time_plots.close_up(runs, 1, 2)
    assert close.run.is_test
    span = close.run.t[close.stop - 1] - close.run.t[close.start]
    assert span == pytest.approx(time_plots.CLOSE_UP, abs=0.02)
    gain = close.run.residual(1) ** 2 - close.run.residual(2) ** 2
    chosen = gain[close.start : close.stop].sum()
    length = close.stop - close.start
    others = [gain[i : i + length].sum() for i in range(0, gain.size - length, 100)]
    assert chosen >= np.quantile(others, 0.8)


def test_curves_and_residuals_are_drawn_in_the_display_unit(friction):
    _, _, runs = friction
    with style.styled():
        figure = time_plots.measured_and_simulated(
            time_plots.whole(runs), CURVES, MM, 'position', 5e-5, style.WIDE
        )
    above, below, alone = figure.axes
    measured = above.lines[0]
    assert measured.get_ydata().max() == pytest.approx(1e3 * runs[0].target.max())
    nominal = below.lines[0]
    assert nominal.get_ydata().min() == pytest.approx(1e3 * runs[0].residual(0).min())
    assert above.get_title('left') == 'position, mm'
    (last,) = (line for line in alone.lines if len(line.get_xdata()) > 2)
    assert last.get_ydata().max() == pytest.approx(1e3 * runs[0].residual(2).max())
    assert nominal.get_xdata()[-1] <= runs[0].t[-1]


def test_a_line_stands_where_effects_begin(tested):
    """In the overview in the run in which that is, and in the close-up if it is there."""
    _, _, runs = tested
    late = [replace(run, since=9.0) for run in runs[:2]] + [runs[2]]
    second = time_plots.whole(late)[1]
    assert [s.begins_at is None for s in time_plots.whole(late)] == [True, False, True]
    assert [s.begins_at for s in time_plots.whole(runs)] == [None, None, None]
    with style.styled():
        figure = time_plots.measured_and_simulated(
            time_plots.whole(late), CURVES, MM, 'position', 5e-5, style.WIDE
        )
    for ax in figure.axes:
        (line,) = (one for one in ax.lines if one.get_color() == style.SINCE)
        assert set(line.get_xdata()) == {9.0 + second.shift}
    part = time_plots.Stretch(late[1], 0, 50)
    assert part.begins_at is None


def test_errors_stand_at_their_rmse_with_their_interval():
    sizes = [
        (CURVES[0], Size(4e-3, 3e-3, 5e-3, 60.0, 1e-2), Size(5e-3, 4e-3, 6e-3, 60.0, 1e-2)),
        (CURVES[2], Size(6e-5, 5e-5, 7e-5, 99.0, 2e-4), Size(*5 * [float('nan')])),
    ]
    with style.styled():
        figure = time_plots.errors(sizes, 5e-5, MM, style.NARROW)
    dots = [line for line in figure.axes[0].lines if line.get_marker() == 'o']
    assert [line.get_xdata()[0] for line in dots] == pytest.approx([4.0, 5.0, 0.06])
    bars = [line for line in figure.axes[0].lines if len(line.get_xdata()) == 2]
    assert list(bars[0].get_xdata()) == pytest.approx([3.0, 5.0])
    low, high = figure.axes[0].get_xlim()
    assert low < 0.05
    assert high > 6.0
    names = {text.get_text(): text.get_position()[1] for text in figure.axes[0].texts}
    assert list(names) == [CURVES[0].label, CURVES[2].label]
    for label, row in zip(names, (dots[:2], dots[2:]), strict=True):
        assert all(0.0 < names[label] - dot.get_ydata()[0] < 0.6 for dot in row)
