# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Programs as processes: what they were started with, what they print, how they end."""

import pytest

from pam_ros.processes.children import Program


def test_a_program_that_ends_by_itself_gives_its_output_and_code():
    with Program('pam_identify') as program:
        assert program.wait() == 2
        assert not program.is_running
        assert program.output.startswith('pam_identify: the following arguments are required')


@pytest.mark.parametrize(
    ('value', 'text'),
    [(True, 'true'), (20.0, '20.0'), ('vent', 'vent'), (('left', 'right'), '[left, right]')],
)
def test_parameters_are_written_as_ros_reads_them(value, text):
    with Program('pam_identify', '-r', 'a:=b', parameters={'name': value}) as program:
        program.wait()
        given = program.process.args[program.process.args.index('--ros-args') :]
    assert given == ['--ros-args', '-r', 'a:=b', '-p', f'name:={text}']
