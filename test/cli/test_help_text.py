# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The text of ``--help`` has no markup, and loses nothing else."""

import pytest

from pam_ros.cli.help_text import help_text


@pytest.mark.parametrize(
    ('docstring', 'text'),
    [
        (
            '``pam_sim``: simulate\n\n    ``force`` (Float64): N',
            'pam_sim: simulate\n\n    force (Float64): N',
        ),
        (
            'see :mod:`pam_ros.cli` and :class:`Joint`, or `this`',
            'see pam_ros.cli and Joint, or this',
        ),
        ('*node* is **never** None', 'node is never None'),
        (
            '2 * 3 N m/rad, 2**3, m/s^2, adc=force_N*0.392',
            '2 * 3 N m/rad, 2**3, m/s^2, adc=force_N*0.392',
        ),
        ('``ros2 param describe /pam_sim <name>``.', 'ros2 param describe /pam_sim <name>.'),
        (None, ''),
    ],
)
def test_markup_is_left_out(docstring, text):
    assert help_text(docstring) == text
