# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""package.xml, setup.py and CHANGELOG.rst: valid, of one mind, and true to the sources."""

import re
import runpy
import sys
from itertools import chain
from pathlib import Path

import pytest
import setuptools
import yaml

import pam_ros
from support.imports import imported

ROOT = Path(__file__).parents[2]
# rosdep's names for Python packages, and what each is imported as.
IMPORTED_AS = {
    'python3-bokeh-pip': 'bokeh',
    'python3-jinja2': 'jinja2',
    'python3-matplotlib': 'matplotlib',
    'python3-numba': 'numba',
    'python3-numpy': 'numpy',
    'python3-openpyxl': 'openpyxl',
    'python3-rosbags-pip': 'rosbags',
    'python3-scipy': 'scipy',
    'python3-tqdm': 'tqdm',
    'python3-yaml': 'yaml',
}
# Used where they are, done without where they are not: no rosdep key says that.
OPTIONAL = {'distributed', 'mcap', 'rviz2'}
COMMANDS = {'ros2launch'}  # with which users start the launch files


@pytest.fixture(scope='module')
def package():
    """Return package.xml as catkin_pkg reads it, which refuses an invalid one."""
    catkin_pkg = pytest.importorskip('catkin_pkg.package')
    warnings = []
    found = catkin_pkg.parse_package(str(ROOT / 'package.xml'), warnings=warnings)
    found.validate(warnings=warnings)
    assert warnings == []
    return found


@pytest.fixture(scope='module')
def metadata():
    """Return what setup.py tells setuptools."""
    with pytest.MonkeyPatch.context() as patch:
        arguments = {}
        patch.setattr(setuptools, 'setup', arguments.update)
        patch.chdir(ROOT)
        runpy.run_path('setup.py')
    return arguments


def third_party():
    """Return the top packages that the package and its launch files import."""
    files = [*(ROOT / 'pam_ros').rglob('*.py'), *(ROOT / 'launch').glob('*.py')]
    names = set().union(*(imported(path) for path in files))
    return names - sys.stdlib_module_names - {'pam_ros'}


def started():
    """Return the packages whose programs the launch files start."""
    texts = (path.read_text(encoding='utf-8') for path in (ROOT / 'launch').glob('*.py'))
    return set(chain(*(re.findall(r"package='(\w+)'", text) for text in texts))) - {'pam_ros'}


def test_package_xml_is_format_3_for_ament_python(package):
    assert package.package_format == 3
    assert package.name == 'pam_ros'
    assert package.get_build_type() == 'ament_python'
    assert package.licenses == ['Apache-2.0']


def test_package_xml_names_all_that_is_imported_or_started(package):
    declared = {IMPORTED_AS.get(d.name, d.name) for d in package.exec_depends}
    assert (third_party() | started()) - OPTIONAL <= declared


def test_package_xml_names_nothing_that_is_not_used(package):
    declared = {IMPORTED_AS.get(d.name, d.name) for d in package.exec_depends}
    assert declared <= third_party() | started() | COMMANDS


def test_pip_dependencies_have_no_ros_and_no_upper_limit(metadata):
    for requirement in chain(metadata['install_requires'], *metadata['extras_require'].values()):
        assert re.fullmatch(r'[A-Za-z0-9-]+(>=[0-9.]+)?', requirement)
        assert not re.match(r'(ros-|rclpy|launch)', requirement)


def test_every_version_is_the_same(package, metadata):
    assert package.version == metadata['version'] == pam_ros.__version__


def test_changelog_has_this_version(package):
    text = (ROOT / 'CHANGELOG.rst').read_text(encoding='utf-8')
    headings = re.findall(r'^(.+)\n-+$', text, re.MULTILINE)
    assert 'Forthcoming' in headings or headings[0].startswith(package.version)


def test_programs_are_modules_with_a_main(metadata):
    scripts = metadata['entry_points']['console_scripts']
    assert scripts
    for script in scripts:
        name, module = re.fullmatch(r'(\w+) = pam_ros\.cli\.(\w+):main', script).groups()
        assert name == module
        source = (ROOT / 'pam_ros' / 'cli' / f'{module}.py').read_text(encoding='utf-8')
        assert '\ndef main() -> None:\n' in source


def test_all_data_files_are_installed_in_their_places(metadata):
    installed = {
        (folder, Path(file).name) for folder, files in metadata['data_files'] for file in files
    }
    expected = {
        ('share/ament_index/resource_index/packages', 'pam_ros'),
        ('share/pam_ros', 'package.xml'),
    }
    for folder in ('config', 'launch', 'urdf'):
        for path in (ROOT / folder).rglob('*'):
            if path.is_file() and '__pycache__' not in path.parts:
                place = path.relative_to(ROOT).parent.as_posix()
                expected.add((f'share/pam_ros/{place}', path.name))
    assert installed == expected
    assert ('share/pam_ros/config/muscles', 'dmsp_20_400n.yaml') in installed


def test_the_workflow_uses_commands_and_versions_that_exist():
    workflow = yaml.safe_load((ROOT / '.github/workflows/ci.yml').read_text(encoding='utf-8'))
    wheels, colcon = workflow['jobs']['wheels'], workflow['jobs']['colcon']
    commands = [step.get('run', '') for step in wheels['steps']]
    targets = set(re.findall(r'^make ([a-z-]+)', '\n'.join(commands), re.MULTILINE))
    known = re.findall(
        r'^([a-z-]+):', (ROOT / 'Makefile').read_text(encoding='utf-8'), re.MULTILINE
    )
    assert {'demo', 'lint', 'test'} <= targets <= set(known)
    tried = re.search(r'(?s)PYTHONS = (.*?)\n', (ROOT / 'noxfile.py').read_text(encoding='utf-8'))
    assert wheels['strategy']['matrix']['python'] == re.findall(r'3\.\d+', tried.group(1))
    distributions = {
        path.stem.removeprefix('ros-') for path in ROOT.glob('requirements/ros-*.txt')
    }
    assert set(colcon['strategy']['matrix']['ros']) == distributions
