# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""report.html in a real browser, at the width of a desk and of a telephone."""

from pathlib import Path

import pytest

from pam_ros.report.numbers import numbers
from pam_ros.report.page import page
from pam_ros.report.runs import runs_of
from support import results


@pytest.mark.needs_numba
def test_nothing_is_missing_overlapping_or_sticking_out(html, look):
    for width, found in look(html).items():
        assert found['width'] in (width, width - 15)  # a scroll bar takes its place
        assert found['problems'] == {name: [] for name in found['problems']}, width
        ending = '-1080' if width > 1000 else '-356'
        assert [n for n in found['plots'] if n.startswith(('rmse', 'overview', 'close-up'))] == [
            f'{name}{ending}' for name in ('rmse', 'overview', 'close-up')
        ]
        assert len(found['plots']) >= 3 + 4 + 5
        assert found['pieces'] > 250


@pytest.mark.needs_numba
def test_long_names_many_recordings_and_three_effects_find_their_room(look):
    result, source = results.crowded_result()
    runs = runs_of(result)
    html = page(result, runs, source, numbers(result, runs, source), Path('/tmp/identified.yaml'))
    for width, found in look(html).items():
        assert found['problems'] == {name: [] for name in found['problems']}, width


def test_the_measuring_finds_what_is_wrong(look):
    page = (
        '<style>svg{width:300px}</style><section id="a"><h2></h2><p style="position:absolute;'
        'top:50px;left:9px">over</p><p style="position:absolute;top:52px;left:20px">under</p>'
        '<div style="width:5000px">far</div><p style="margin-left:-30px;width:400px">left out</p>'
        '<svg class="plot" data-name="p" viewBox="0 0 600 90" height="45">'
        '<text x="590" y="40" font-size="12">cut off</text></svg></section>'
    )
    for found in look(page).values():
        problems = found['problems']
        assert problems['overlaps'] == ['over | under']
        assert problems['outside'] == ['left out']
        assert 'DIV ' in problems['wide']
        assert problems['cut'] == ['p: cut off']
        assert problems['small'] == ['p: 6.0 px']
        assert problems['empty'] == ['p']
        assert problems['missing'] == ['H2 ']
