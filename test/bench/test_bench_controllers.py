# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which program a text of the command line means, and how it is started."""

from pathlib import Path

import pytest

from pam_ros.bench.controllers import controllers_of
from pam_ros.errors import ParameterError

GAINS = '/**/pam_control:\n  ros__parameters: {controller: pid}\n'


@pytest.fixture
def gains(tmp_path):
    path = tmp_path / 'tuned.yaml'
    path.write_text(GAINS, encoding='utf-8')
    return path


def test_controllers_of_a_command_line(gains):
    texts = ['sliding_mode', 'pid', f'pam_control:{gains}', f'stiff=pam_control:{gains}']
    found = controllers_of([*texts, 'mine=sh -c "run $x" --file {parameters}'])
    assert [one.name for one in found] == ['sliding_mode', 'pid', 'tuned', 'stiff', 'mine']
    assert [one.is_own for one in found] == [True, True, True, True, False]
    file = Path('/declared.yaml')
    words = [one.command_line(file, 250.0, is_simulated=True) for one in found]
    assert words[-1] == ['sh', '-c', 'run $x', '--file', '/declared.yaml']
    for own in words[:-1]:
        assert own[1:6] == [
            '-m',
            'pam_ros.cli.pam_control',
            '--ros-args',
            '--params-file',
            str(file),
        ]
        assert 'use_sim_time:=true' in own
        assert 'rate:=250.0' in own
    assert 'controller:=pid' in words[1]
    # Its own file comes after that of the rig, which it may override.
    assert words[2][6:8] == ['--params-file', str(gains)]


@pytest.mark.parametrize(
    ('texts', 'sentence'),
    [
        (['pidd'], "'pidd' is not a controller: give one of pam_control, sliding_mode, pid"),
        (['pid', 'pid'], 'two controllers are called pid: give NAME=... with another name'),
        (['pam_control:nowhere.yaml'], 'pam_control:nowhere.yaml: the parameter file does not'),
        (['a b=true'], "'a b' is not a name of a controller"),
        (['mine='], 'mine has no command: give mine=COMMAND'),
        (['mine=sh "'], 'the command of mine cannot be read: No closing quotation'),
        (['mine=no_such_program x'], 'the program no_such_program of mine does not exist'),
    ],
)
def test_what_is_no_controller(texts, sentence):
    with pytest.raises(ParameterError) as caught:
        controllers_of(texts)
    assert sentence in str(caught.value)


def test_a_parameter_file_that_is_not_valid(tmp_path):
    path = tmp_path / 'bad.yaml'
    path.write_text('a: [', encoding='utf-8')
    with pytest.raises(ParameterError, match='not valid YAML'):
        controllers_of([f'pam_control:{path}'])
