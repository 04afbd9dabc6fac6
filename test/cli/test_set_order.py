# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which files each ``--set`` of a command line applies to."""

import pytest

from pam_ros.cli.pam_identify import parser
from pam_ros.cli.set_order import values_of_files
from pam_ros.errors import PamError

REST = ['--params', 'p', '--out', 'o']


@pytest.mark.parametrize(
    ('line', 'recordings', 'test'),
    [
        ('a b --set mass=1', [{}, {}], []),
        ('--set mass=1 a b', [{}, {}], []),
        ('--set mass=1 --set mass=2 a', [{}], []),  # the last one is that of the nominal model
        ('--set mass=1 a --set mass=2 b c', ['1', '2', '2'], []),
        ('--set=mass=1 a --se mass=2 b', ['1', '2'], []),
        ('--set mass=1 a --uncertain a2=3% --set mass=2 --test b c', ['1'], ['2', '2']),
        ('--set mass=1 --set l0=2 a --set mass=3 b', ['1', '3'], []),
        ('--test a --set mass=1 --set mass=2', [], [{}]),
        ('--column set=force_N --set mass=1 a --kind free --set mass=2 b', ['1', '2'], []),
    ],
)
def test_a_value_between_files_applies_to_those_behind_it(line, recordings, test):
    expected = [
        [one if isinstance(one, dict) else {'mass': one} for one in some]
        for some in (recordings, test)
    ]
    assert [*values_of_files([*line.split(), *REST], parser)] == expected


def test_a_file_before_the_first_value_is_refused():
    with pytest.raises(PamError, match='--set mass=1 stands behind a file, and mass is set again'):
        values_of_files(['a', '--set', 'mass=1', 'b', '--set', 'mass=2', *REST], parser)
