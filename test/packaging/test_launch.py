# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files: they name programs and files that exist, and load where launch is installed."""

import ast
import importlib.util
import runpy
from pathlib import Path

import pytest
import setuptools

ROOT = Path(__file__).parents[2]
LAUNCH_FILES = sorted((ROOT / 'launch').glob('*.launch.py'))
HAVE_LAUNCH = importlib.util.find_spec('launch_ros') is not None

each = pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)


def programs():
    told = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(setuptools, 'setup', told.update)
        patch.chdir(ROOT)
        runpy.run_path('setup.py')
    return {script.split()[0] for script in told['entry_points']['console_scripts']}


def parsed(path):
    return ast.parse(path.read_text(encoding='utf-8'), filename=str(path))


def calls(path, name):
    """Return the keyword arguments that are plain strings of each call of *name*."""
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.Call) and getattr(node.func, 'id', None) == name:
            yield {
                word.arg: word.value.value
                for word in node.keywords
                if isinstance(word.value, ast.Constant)
            }


def test_there_is_one_for_the_simulator():
    assert ROOT / 'launch' / 'sim.launch.py' in LAUNCH_FILES


@each
def test_has_the_function_that_launch_calls(path):
    functions = {node.name for node in parsed(path).body if isinstance(node, ast.FunctionDef)}
    assert 'generate_launch_description' in functions
    compile(path.read_text(encoding='utf-8'), path, 'exec')


@each
def test_starts_programs_that_exist(path):
    nodes = list(calls(path, 'Node'))
    assert nodes
    for node in nodes:
        if node.get('package') == 'pam_ros':
            assert node['executable'] in programs()


@each
def test_names_files_that_exist(path):
    texts = [node.value for node in ast.walk(parsed(path)) if isinstance(node, ast.Constant)]
    for text in texts:
        is_name = isinstance(text, str) and Path(text).suffix  # and not an ending by itself
        if is_name and text.endswith(('.yaml', '.launch.py', '.urdf', '.rviz')):
            assert list(ROOT.rglob(Path(text).name)), text


@each
def test_describes_every_argument(path):
    for argument in calls(path, 'DeclareLaunchArgument'):
        assert argument['description']


@pytest.mark.skipif(not HAVE_LAUNCH, reason='launch_ros is not installed: no wheels have it')
@each
def test_loads(path):
    from launch import LaunchDescription

    description = runpy.run_path(str(path))['generate_launch_description']()
    assert isinstance(description, LaunchDescription)
    assert description.entities
