# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Samples on the steps of a simulation."""

import sys
from fractions import Fraction
from math import ceil

import pytest

from pam_ros.timing.grid import Grid


def steps_of(grid, count):
    found = []
    for _ in range(count):
        found.append(grid.next)
        grid.advance()
    return found


@pytest.mark.parametrize('rate', [1000, 500, 300, 7, 1])
def test_each_sample_is_at_the_first_step_that_is_not_before_it(rate):
    grid = Grid(1000.0)
    grid.begin(float(rate))
    assert steps_of(grid, 2000) == [ceil(Fraction(1000 * n, rate)) for n in range(2000)]


def test_it_is_counted_from_a_step_and_from_a_sample():
    grid = Grid(1000.0)
    grid.begin(500.0, first=17, sample=1)
    assert steps_of(grid, 3) == [19, 21, 23]


def test_without_a_rate_nothing_is_ever_due():
    grid = Grid(1000.0)
    assert steps_of(grid, 2) == [sys.maxsize, sys.maxsize]
