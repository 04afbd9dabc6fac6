# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The library that draws the page: what is said where there is none, and what works without."""

import subprocess
import sys
from types import SimpleNamespace

import pytest

from pam_ros.errors import PamError
from pam_ros.plot.bokeh_files import bokeh_files

WITHOUT_BOKEH = """
import runpy, sys
sys.modules['bokeh'] = None
runpy.run_module('pam_ros.cli.pam_plot', run_name='__main__', alter_sys=True)
"""


@pytest.fixture
def table(tmp_path):
    path = tmp_path / 'rig.csv'
    path.write_text('t_s,force_N\n' + ''.join(f'{k},{k % 3}\n' for k in range(20)))
    return path


def run_without(*arguments):
    command = [sys.executable, '-c', WITHOUT_BOKEH, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)


def test_the_scripts_are_those_of_the_installed_package():
    assert set(bokeh_files()) == {'bokeh.min.js', 'bokeh-api.min.js'}


def test_a_page_without_the_package_is_one_sentence(table):
    done = run_without('--bag', table)
    assert (done.returncode, done.stdout) == (2, '')
    begin = 'pam_plot: the page is drawn by the Python package bokeh, which is not installed: '
    assert done.stderr.startswith(begin)
    assert "pip install 'bokeh>=3.4'" in done.stderr
    assert '--png FILE' in done.stderr
    assert done.stderr.count('\n') == 1


def test_a_png_file_needs_no_such_package(table, tmp_path):
    png = tmp_path / 'rig.png'
    done = run_without('--bag', table, '--png', png)
    assert (done.returncode, done.stdout, done.stderr) == (0, f'wrote {png}\n', '')
    assert png.stat().st_size > 10_000


def test_an_old_or_a_broken_package_is_one_sentence(tmp_path, monkeypatch):
    broken = SimpleNamespace(__version__='3.9.2', __file__=str(tmp_path / '__init__.py'))
    monkeypatch.setitem(sys.modules, 'bokeh', broken)
    with pytest.raises(PamError, match=r'^\S+bokeh\.min\.js of the Python package bokeh cannot'):
        bokeh_files()
    monkeypatch.setitem(sys.modules, 'bokeh', SimpleNamespace(__version__='2.4.3'))
    with pytest.raises(PamError, match=r'^bokeh 2\.4\.3 is too old for the page: install it'):
        bokeh_files()
