# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Thinned curves and SVG parts."""

import re
import xml.etree.ElementTree as ET

import matplotlib as mpl
import numpy as np
import pytest

from pam_ros.report import style


def test_envelope_keeps_every_extreme_and_the_order_of_time():
    rng = np.random.default_rng(0)
    t = np.arange(50_000) / 1000.0
    y = np.sin(t) + 0.1 * rng.standard_normal(t.size)
    y[31_234], y[12_345] = 9.0, -9.0
    at, thin = style.envelope(t, y, 500)
    assert at.size == thin.size == 1000
    assert np.all(np.diff(at) > 0.0)
    assert (thin.max(), thin.min()) == (9.0, -9.0)
    assert at[np.argmax(thin)] == pytest.approx(31.234, abs=0.1)
    edges = np.linspace(0, t.size, 501).astype(int)
    for k in (0, 99, 499):
        part = y[edges[k] : edges[k + 1]]
        assert sorted(thin[2 * k : 2 * k + 2]) == [part.min(), part.max()]


def test_envelope_leaves_short_curves_alone():
    t = np.arange(100.0)
    assert np.array_equal(style.envelope(t, t**2, 50)[1], t**2)


def drawn(name):
    with style.styled():
        figure, ax = style.panel()
        ax.plot([0.0, 1.0], [0.0, 2.0])
        ax.set_xlabel('lag, s')
        return style.svg(figure, name, 'a line')


def test_svg_is_one_element_with_ids_of_its_own():
    ids = []
    for name in ('a', 'b'):
        root = ET.fromstring(drawn(name))
        assert root.tag.endswith('svg')
        assert root.get('viewBox') == f'0 0 {style.NARROW} 258'
        assert root.get('aria-label') == 'a line'
        assert '>lag, s</text>' in drawn(name)
        ids.append({e.get('id') for e in root.iter() if e.get('id')})
        assert all(i.startswith(f'{name}-') for i in ids[-1])
        text = ET.tostring(root, 'unicode')
        used = set(re.findall(r'(?:url\(#|href="#)([^)"]+)', text))
        assert used
        assert used <= ids[-1]
    assert not ids[0] & ids[1]


def test_figures_do_not_depend_on_what_the_user_has_set():
    plain = drawn('a')
    own = {
        'figure.constrained_layout.use': True,
        'axes.facecolor': '#123456',
        'lines.marker': 'o',
        'text.usetex': True,
        'axes.xmargin': 0.3,
    }
    with mpl.rc_context(own):
        assert drawn('a') == plain
        assert mpl.rcParams['lines.marker'] == 'o'


@pytest.mark.parametrize(('low', 'high'), [(0.0, 0.0), (0.31, 0.42), (1e-6, 3e-2), (2.0, 900.0)])
def test_log_axis_has_a_decade_at_least_and_labels_in_plain_numbers(low, high):
    with style.styled():
        figure, ax = style.panel()
        ax.plot([1.0, 2.0], [low or 0.3, high or 0.3])
        ax.set_yscale('log')
        style.log_axis(ax.yaxis)
        figure.canvas.draw()
        bottom, top = ax.get_ylim()
        labels = [
            label.get_text()
            for label in ax.get_yticklabels()
            if bottom <= label.get_position()[1] <= top
        ]
    assert top / bottom >= 10.0 * (1.0 - 1e-9)
    assert len(labels) == len(set(labels)) >= 2
    assert not any('mathdefault' in label for label in labels)


def test_ticks_are_plain():
    assert style.plain_tick(-0.25, 0) == '−0.25'
    assert style.plain_tick(1500.0, 0) == '1500'
    assert style.plain_tick(1e-6, 0) == '1·10⁻⁶'
