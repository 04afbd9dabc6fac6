# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``--version`` and ``--help`` of every program that setup.py installs."""

import ast
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import pam_ros

SETUP = Path(__file__).parents[2] / 'setup.py'
PROGRAMS = next(
    ast.literal_eval(statement.value)
    for statement in ast.parse(SETUP.read_text()).body
    if isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == 'PROGRAMS'
)
# Whatever imports ROS or starts it would fail where there is none.
WITHOUT_ROS = """
import runpy, sys
sys.modules['rclpy'] = None
sys.argv = sys.argv[1:]
runpy.run_module('pam_ros.cli.' + sys.argv[0], run_name='__main__')
"""
MARKUP = re.compile(r'`|:\w+:`|(?<!\w)\*+\w|\w\*+(?!\w)')


@pytest.mark.parametrize(
    ('program', 'arguments'),
    [
        *((program, ['--version']) for program in PROGRAMS),
        ('pam_sim', ['--version', '--ros-args', '-p', 'mass:=-1.0']),
    ],
)
def test_version(program, arguments):
    done = subprocess.run(
        [sys.executable, '-c', WITHOUT_ROS, program, *arguments],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (
        0,
        f'pam_ros {pam_ros.__version__}\n',
        '',
    )


def is_node(program):
    return hasattr(import_module(f'pam_ros.cli.{program}'), 'start_node')


@pytest.mark.parametrize('program', PROGRAMS)
def test_help(program):
    if is_node(program):
        pytest.importorskip('rclpy')
    done = subprocess.run(
        [sys.executable, '-m', f'pam_ros.cli.{program}', '--help'],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, '')
    assert f'\n{program}: ' in done.stdout
    assert '--version' in done.stdout
    assert not MARKUP.search(done.stdout)


@pytest.mark.parametrize('program', [*filter(is_node, PROGRAMS)])
def test_a_node_without_ros_ends_with_a_sentence(program):
    done = subprocess.run(
        [sys.executable, '-c', WITHOUT_ROS, program], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr.startswith(f'{program}: rclpy')
    assert 'setup.bash' in done.stderr
    assert done.stderr.count('\n') == 1
