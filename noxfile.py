# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tests with each Python and each ROS that this machine can run: ``make platforms``.

Each has an environment of its own, with the newest libraries that pip finds for this Python, or
with the oldest ones that are supported. A Python that the machine lacks is skipped and listed.
"""

import os
import shutil
from pathlib import Path

import nox

# pyenv's own commands of these names work only for the versions that it has activated.
pyenv = Path(os.environ.get('PYENV_ROOT', Path.home() / '.pyenv')) / 'versions'
installed = map(str, sorted(pyenv.glob('3.1[0-3].*/bin'), reverse=True))
os.environ['PATH'] = os.pathsep.join([*installed, os.environ['PATH']])

nox.needs_version = '>=2024.10'
nox.options.envdir = '.venv/platforms'  # a folder that colcon ignores
nox.options.reuse_venv = 'yes'
nox.options.default_venv_backend = 'venv'

PYTHONS = ('3.10', '3.11', '3.12', '3.13')
# The first that is here of those for which numpy 1.26 has wheels.
OLD = next((one for one in PYTHONS[:3] if shutil.which(f'python{one}')), PYTHONS[0])
WITHOUT_NODES = ('-n', 'auto', '--dist', 'loadfile', '-m', 'pure and not slow')
# Simulator and controller in lockstep, the recorder of a joint, starts and ends of programs,
# parameter files.
SMOKE = (
    'test/nodes/test_closed_loop_in_lockstep.py',
    'test/nodes/record/test_record_of_joint.py',
    'test/nodes/sim/test_sim_process.py',
    'test/nodes/test_parameter_files.py',
)
# What needs ROS, and the truth plant: it is not a part of the package, and is tested only once.
NOT_PURE = ('faults', 'nodes', 'packaging', 'truth')


def install(session: nox.Session, *arguments: str) -> None:
    """Install with a new pip: the one of Python 3.10 searches for versions for ten minutes."""
    session.install('--upgrade', 'pip')
    session.install(*arguments)


def run_with_nodes(session: nox.Session, *requirements: str) -> None:
    """Run the tests without nodes that are quick, and some of the nodes."""
    files = [word for name in requirements for word in ('-r', f'requirements/{name}.txt')]
    install(session, *files, '-e', '.[fast,test]')
    session.run('python', '-m', 'pam_ros.rig.warm')
    session.run('python', '-m', 'pytest', *WITHOUT_NODES)
    session.run('python', '-m', 'pytest', *SMOKE)


@nox.session(python=PYTHONS)
@nox.parametrize('ros', ['jazzy', 'kilted'])
def newest(session: nox.Session, ros: str) -> None:
    """Test nodes and what needs none, with the newest libraries for this Python."""
    run_with_nodes(session, f'ros-{ros}')


@nox.session(python=OLD)
def oldest_with_ros(session: nox.Session) -> None:
    """Do the same with the oldest numpy and scipy that are supported."""
    run_with_nodes(session, 'ros-jazzy', 'oldest')


@nox.session(python=OLD)
def oldest(session: nox.Session) -> None:
    """Test all that needs no nodes with the oldest numpy and scipy, without numba and ROS."""
    install(session, '-r', 'requirements/oldest.txt')
    rooms = [f'--ignore=test/{room}' for room in NOT_PURE]
    session.run('python', '-m', 'pytest', 'test', *WITHOUT_NODES, *rooms)
