# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A page in a real browser, at the width of a desk and of a telephone, measured by ``look.js``."""

import html as markup
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

SIZES = {1280: 900, 390: 844}
NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable', 'chrome')
FLAGS = ('--headless', '--no-sandbox', '--disable-gpu', '--no-first-run', '--dump-dom')
QUIET = ('dev-shm-usage', 'quic', 'background-networking', 'component-update', 'sync')
# Each size is a frame: a window of its own, as far as a page can tell.
STAND = """<!DOCTYPE html><meta charset="utf-8"><body><pre id="found"></pre><script>{look}
addEventListener('load', () => {{
  const found = [...document.querySelectorAll('iframe')].map((frame) => look(frame.contentWindow));
  document.getElementById('found').textContent = JSON.stringify(found);
}});
</script>{frames}</body>"""


@pytest.fixture(scope='module')
def browser():
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if found is None:
        pytest.skip('no Chromium or Chrome on this machine to look at the page with')
    return found


@pytest.fixture(scope='module')
def look(browser, tmp_path_factory):
    """Return a function that renders a page at every size and gives what was measured."""

    def at_all_sizes(html):
        folder = tmp_path_factory.mktemp('browser')
        frames = ''.join(
            f'<iframe style="border:0;width:{w}px;height:{h}px" srcdoc="{markup.escape(html)}">'
            '</iframe>'
            for w, h in SIZES.items()
        )
        script = (Path(__file__).parent / 'look.js').read_text(encoding='utf-8')
        (folder / 'stand.html').write_text(
            STAND.format(look=script, frames=frames), encoding='utf-8'
        )
        quiet = [f'--disable-{name}' for name in QUIET]
        command = [browser, *FLAGS, *quiet, f'--user-data-dir={folder / "profile"}']
        done = subprocess.run(
            [*command, (folder / 'stand.html').as_uri()],
            capture_output=True,
            check=True,
            encoding='utf-8',
            timeout=240,
        )
        found = re.search(r'<pre id="found">(.*?)</pre>', done.stdout, re.DOTALL)
        assert found, done.stderr[-2000:]
        return dict(zip(SIZES, json.loads(markup.unescape(found[1])), strict=True))

    return at_all_sizes
