# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The lines that use an identified model: each is read as its program reads it."""

import shlex
from pathlib import Path

import pytest

from pam_ros.report.use import uses_of


@pytest.mark.parametrize('name', ['report', "Monday's run", 'a "b" $HOME', 'näher'])
def test_shell_gives_the_path_to_both_programs(name):
    file = Path('/data') / name / 'identified.yaml'
    for use, program in zip(uses_of(file), ('pam_sim', 'pam_control'), strict=False):
        *start, path = shlex.split(use.line)
        assert start == ['ros2', 'run', 'pam_ros', program, '--ros-args', '--params-file']
        assert path == str(file)


def test_path_is_absolute(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for use in uses_of(Path('report') / 'identified.yaml'):
        assert f'{tmp_path}/report/identified.yaml' in use.line


@pytest.mark.slow
def test_line_of_python_loads_the_identified_joint(reports, friction):
    folder = reports(friction)
    space: dict[str, object] = {}
    exec(uses_of(folder / 'identified.yaml')[2].line, space)
    assert space['joint'].muscle.a5 == friction[0].joint.muscle.a5
