# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""bench.html has all results and the plots of the trials, and is whole in a real browser."""

import re

import numpy as np
import pytest

from pam_ros.bench.outcome import Status
from pam_ros.bench.page import headline, page
from pam_ros.bench.plots import OUTAGE
from pam_ros.bench.trial import Trial
from support.outcomes import results_of

LONG = 'a_controller_with_a_long_name.v2'
TABLE = {
    'step': {'pid': [3e-5, 3.2e-5], LONG: [1e-5, 1.1e-5], 'mine': [Status.DIED, 2e-5]},
    'scores': {'pid': [0.02, 0.02], LONG: [0.01, 0.01], 'mine': [Status.DIED, Status.SILENT]},
}
PROGRAMS = {name: f'python3 /a/long/path/of/a/program/{name}.py <&>' for name in TABLE['step']}


def trial(muscles, *, revolute=False):
    t = np.arange(3000) / 500.0
    reference = 0.05 + 0.02 * (t > 1.0)
    position = 0.05 + 0.02 * -np.expm1(-np.maximum(t - 1.0, 0.0) / 0.2)
    pressure = 3e5 + 1e5 * np.sin(3.0 * t)[:, None] * np.arange(1, muscles + 1)
    limits = np.repeat([[0.0], [6e5]], muscles, axis=1)
    none = np.full(t.size, 1e-4)
    outages = np.array([[2.0, 2.5], [5.0, np.inf]])[: 2 * revolute]
    return Trial(
        t, position, reference, pressure, limits, none, np.array([3.0]), revolute, outages
    )


@pytest.fixture(scope='module')
def results():
    return results_of(TABLE, revolute={'scores'}, real_time={'mine'}, others={'rms_error': 1e-3})


@pytest.fixture(scope='module')
def html(results):
    trials = {
        ('step', 'pid'): trial(1),
        ('step', LONG): trial(1),
        ('scores', 'pid'): trial(2, revolute=True),
    }
    return page(results, PROGRAMS, trials)


def test_the_page_has_all_of_it(html, results):
    text = ' '.join(
        re.sub(r'<svg.*?</svg>|<style>.*?</style>|<[^>]+>', ' ', html, flags=re.S).split()
    )
    assert headline(results) == f'{LONG} is best in 2 of 2 scenarios'
    assert headline(results) in text
    assert '12 runs, with 2 seeds of the sensor noise each. 3 of them failed.' in text
    assert 'mine died (seed 0): its process ended with exit code 1' in text
    assert 'python3 /a/long/path/of/a/program/mine.py &lt;&amp;&gt;' in text
    assert 'in real time' in text
    assert 'error at rest [mm] 0.0310 worst 0.0320 0.0105 best worst 0.0110' in text
    assert 'error at rest [mrad] 20.0 worst 20.0 10.0 best' in text
    assert all(score.text in text for score in results.scores)
    assert html.count('<svg class="plot"') == 3
    # An id of a scenario is not one of a part of the page.
    ids = re.findall(r'<section id="([^"]+)"', html)
    assert len(ids) == len(set(ids)) == 6


def test_the_axes_of_all_controllers_are_equal(html):
    first, second, other = re.findall(r'<svg class="plot".*?</svg>', html, flags=re.S)

    def labels(svg):
        return re.findall(r'<text[^>]*>([^<]+)</text>', svg)

    assert labels(first) == labels(second) != labels(other)
    assert 'error [mm]' in labels(first)
    assert 'error [mrad]' in labels(other)


def test_outages_are_shaded_in_each_plot_of_their_scenario(html):
    first, second, other = re.findall(r'<svg class="plot".*?</svg>', html, flags=re.S)
    assert [one.count(f'fill: {OUTAGE}') for one in (first, second, other)] == [0, 0, 6]
    assert html.count('outage of the rig') == 1


def test_nothing_is_missing_or_overlapping_in_a_browser(html, look):
    for width, found in look(html).items():
        assert found['problems'] == {name: [] for name in found['problems']}, width
        assert found['plots'] == ['s0-0', 's0-1', 's1-0']


@pytest.mark.parametrize(
    ('table', 'expected'),
    [
        ({'step': {'pid': [1e-5]}}, 'pid in 1 scenario'),
        ({'step': {'pid': [1e-5], 'b': [1e-5]}}, '2 controllers in 1 scenario'),
        ({'step': {'pid': [1e-5], 'b': [2e-5]}}, 'pid is best in 1 of 1 scenario'),
    ],
)
def test_the_heading_of_other_results(table, expected):
    assert headline(results_of(table)) == expected
