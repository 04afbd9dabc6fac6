# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The example of a data sheet finds the constants that its table was made of."""

import re

import pytest

from pam_ros import load_muscle


def test_it_finds_the_constants_of_its_table(run_example):
    done = run_example('muscle_from_data_sheet.py')
    assert (done.returncode, done.stderr) == (0, '')
    known = load_muscle('dmsp_20_festo')
    found = re.findall(r'^(a\d) = +(\S+) \+- (\S+)$', done.stdout, re.MULTILINE)
    assert [name for name, _, _ in found] == ['a1', 'a2', 'a3', 'a4', 'a5', 'a6']
    for name, value, error in found:
        assert abs(float(value) - getattr(known, name)) < 3.0 * float(error), name
    # Rounding to 10 N is an error of 10 / sqrt(12) N.
    assert float(re.search(r'RMSE (\S+) N', done.stdout)[1]) == pytest.approx(2.9, abs=0.7)
    lengths = re.findall(r'^(\S+) mm', done.stdout, re.MULTILINE)
    assert float(lengths[0]) == pytest.approx(float(lengths[1]), abs=0.5)
