# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The package built by colcon, as on a machine with ROS, and its simulator started from there."""

import importlib.util
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from sensor_msgs.msg import JointState

from support.harness import Peer

HAVE_COLCON = importlib.util.find_spec('colcon_core') is not None
BUILD_DEADLINE = 300.0  # s; both only bound how long something broken may hang
DEADLINE = 60.0

pytestmark = pytest.mark.skipif(not HAVE_COLCON, reason='colcon is not installed')


@pytest.fixture(scope='module', params=[[], ['--symlink-install']], ids=['plain', 'symlinked'])
def workspace(request, sources, tmp_path_factory, clean_environment):
    """Return a colcon workspace that holds the package, built."""
    folder = tmp_path_factory.mktemp('workspace')
    (folder / 'src').mkdir()
    (folder / 'src' / 'pam_ros').symlink_to(sources)
    built = subprocess.run(
        [sys.executable, '-m', 'colcon', 'build', *request.param],
        cwd=folder,
        env=clean_environment,
        capture_output=True,
        text=True,
        timeout=BUILD_DEADLINE,
        check=False,
    )
    assert built.returncode == 0, built.stdout + built.stderr
    assert '1 package finished' in built.stdout + built.stderr
    return folder


@pytest.fixture
def installed(workspace):
    """Return the folder that the package was installed into."""
    return workspace / 'install' / 'pam_ros'


def test_everything_is_where_ros2_looks(installed, sources):
    share = installed / 'share'
    assert (share / 'ament_index' / 'resource_index' / 'packages' / 'pam_ros').is_file()
    for path in ('package.xml', 'launch/sim.launch.py'):
        assert (share / 'pam_ros' / path).read_bytes() == (sources / path).read_bytes()
    for path in (sources / 'config').rglob('*.yaml'):
        place = share / 'pam_ros' / path.relative_to(sources)
        assert place.read_bytes() == path.read_bytes()


def test_every_program_is_in_lib(installed, sources):
    programs = installed / 'lib' / 'pam_ros'
    present = {path.name for path in programs.iterdir() if os.access(path, os.X_OK)}
    started = sources / 'pam_ros' / 'cli'
    assert present == {path.stem for path in started.glob('pam_*.py')}


def test_ament_index_finds_it(workspace, clean_environment):
    asked = in_workspace(
        workspace,
        f"'{sys.executable}' -c '"
        'from ament_index_python import get_package_prefix, get_package_share_directory\n'
        'print(get_package_prefix("pam_ros"), get_package_share_directory("pam_ros"))\'',
        clean_environment,
        stdout=subprocess.PIPE,
        text=True,
    )
    answer, _ = asked.communicate(timeout=DEADLINE)
    prefix = workspace / 'install' / 'pam_ros'
    assert answer.split() == [str(prefix), str(prefix / 'share' / 'pam_ros')]


@pytest.mark.at_any_pace
@pytest.mark.parametrize('stop', [signal.SIGINT, signal.SIGTERM], ids=lambda stop: stop.name)
def test_simulator_runs_from_there_and_ends_well(
    workspace, clean_environment, domain, tmp_path, stop
):
    program = workspace / 'install' / 'pam_ros' / 'lib' / 'pam_ros' / 'pam_sim'
    printed = tmp_path / 'printed'
    # What is compiled, and when, is for other tests: here that would take half a minute.
    environment = {**clean_environment, 'ROS_DOMAIN_ID': str(domain), 'NUMBA_DISABLE_JIT': '1'}
    with Peer() as peer, printed.open('w') as output:
        states = peer.collect(JointState, 'joint_states')
        running = in_workspace(
            workspace,
            f"exec '{program}' --ros-args -p muscle:=dmsp_20_200n",
            environment,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            cwd=tmp_path,
        )
        try:
            peer.until(
                lambda: states or running.poll() is not None, 'joint_states of the simulator'
            )
            assert states, printed.read_text()
            os.killpg(running.pid, stop)
            assert running.wait(DEADLINE) == 0, printed.read_text()
        finally:
            if running.poll() is None:
                os.killpg(running.pid, signal.SIGKILL)
                running.wait()
    assert len(states[0].position) == len(states[0].velocity) == len(states[0].effort) == 1
    assert 'Traceback' not in printed.read_text()


def in_workspace(workspace: Path, command: str, environment: dict[str, str], **options):
    """Start a command as a user does who has sourced the workspace."""
    script = f"source '{workspace}/install/setup.bash' && {command}"
    return subprocess.Popen(['bash', '-c', script], env=environment, **options)
