# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""report.html in a real browser, at the width of a desk and of a telephone."""

import html as markup
import json
import re
import subprocess
from pathlib import Path

import pytest

from pam_ros.report.numbers import numbers
from pam_ros.report.page import page
from pam_ros.report.runs import runs_of
from pam_ros.report.use import uses_of
from support import results
from support.browsing import FLAGS


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


CLICK = """<script>
const copied = [];
const own = async (text) => { if (%s) throw new Error('refused'); copied.push(text); };
Object.defineProperty(navigator, 'clipboard', { value: { writeText: own } });
addEventListener('load', async () => {
  const buttons = [...document.querySelectorAll('button.copy')];
  buttons[1].click();
  await null; await null; await null;
  const found = [copied, String(getSelection()), buttons[1].textContent, buttons[0].textContent];
  document.body.innerHTML = '<pre id="found"></pre>';
  document.getElementById('found').textContent = JSON.stringify(found);
});
</script></body>"""


@pytest.mark.parametrize('is_refused', [False, True])
def test_a_click_copies_a_line_or_selects_it(browser, reports, friction, tmp_path, is_refused):
    folder = reports(friction)
    html = (folder / 'report.html').read_text(encoding='utf-8')
    file = tmp_path / 'page.html'
    file.write_text(html.replace('</body>', CLICK % json.dumps(is_refused)), encoding='utf-8')
    command = [browser, *FLAGS, f'--user-data-dir={tmp_path / "profile"}', file.as_uri()]
    done = subprocess.run(command, capture_output=True, check=True, encoding='utf-8', timeout=240)
    found = re.search(r'<pre id="found">(.*?)</pre>', done.stdout, re.DOTALL)
    line = uses_of(folder / 'identified.yaml')[1].line
    expected = [[], line, 'Selected: press Ctrl+C'] if is_refused else [[line], '', 'Copied']
    assert json.loads(markup.unescape(found[1])) == [*expected, 'Copy']
