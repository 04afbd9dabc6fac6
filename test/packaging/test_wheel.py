# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What `pip install .` brings: all rooms, their templates, the programs, the shared files."""

import configparser
import importlib.util
import zipfile

import pytest

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec('setuptools') is None, reason='setuptools is not installed'
)


@pytest.fixture(scope='module')
def wheel(build, tmp_path_factory):
    """Return the package's wheel, opened."""
    folder = tmp_path_factory.mktemp('wheel')
    # No environment of its own for the build: it would need the package index.
    command = ['-m', 'pip', 'wheel', '--no-deps', '--no-build-isolation', '--wheel-dir']
    build(*command, str(folder), '.')
    (file,) = folder.glob('*.whl')
    with zipfile.ZipFile(file) as opened:
        yield opened


def test_has_every_source_file(wheel, sources):
    packed = {name for name in wheel.namelist() if name.startswith('pam_ros/')}
    sources = {
        path.relative_to(sources).as_posix()
        for path in (sources / 'pam_ros').rglob('*')
        if path.is_file() and '__pycache__' not in path.parts
    }
    assert packed == sources


def test_does_not_install_the_examples(wheel):
    assert not [name for name in wheel.namelist() if 'examples/' in name]


def test_has_every_program(wheel, sources):
    (listed,) = (name for name in wheel.namelist() if name.endswith('/entry_points.txt'))
    parser = configparser.ConfigParser()
    parser.read_string(wheel.read(listed).decode())
    programs = (sources / 'pam_ros' / 'cli').glob('pam_*.py')
    assert set(parser['console_scripts']) == {path.stem for path in programs}


def test_has_the_shared_files(wheel, sources):
    marker = '.data/data/share/pam_ros/'
    packed = {name.split(marker)[1] for name in wheel.namelist() if marker in name}
    assert {'package.xml', 'launch/sim.launch.py', 'config/muscles/dmsp_20_400n.yaml'} <= packed
    assert {
        f'config/rigs/{path.name}' for path in (sources / 'config' / 'rigs').iterdir()
    } <= packed
