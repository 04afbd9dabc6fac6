# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Products with the blocks of a Jacobian against those with the whole one."""

import numpy as np
import pytest

from pam_ros.identification.fit.discrepancy import Discrepancy
from pam_ros.identification.fit.slopes import Slopes, product

SIZES = (40, 25, 60)  # samples of the runs
# Two common unknowns, and one or two of each run: columns need not be in the order of the runs.
COLUMNS = [np.array(own) for own in ((0, 2, 5), (0, 1, 5), (0, 3, 4, 5))]
K = 6


@pytest.fixture
def parts():
    """Return the rows of each run, of a Jacobian with zeros where an unknown does not act."""
    random = np.random.default_rng(2)
    found = []
    for size, own in zip(SIZES, COLUMNS, strict=True):
        part = np.zeros((size, K))
        part[:, own] = random.normal(size=(size, own.size))
        found.append(part)
    return found


def test_products_are_those_of_the_whole_jacobian(parts):
    random = np.random.default_rng(3)
    slopes, whole = Slopes.of(parts, COLUMNS), np.concatenate(parts)
    assert [block.shape for block in slopes.blocks] == [(40, 3), (25, 3), (60, 4)]
    np.testing.assert_array_equal(slopes.dense, whole)
    np.testing.assert_allclose(slopes.normal(), whole.T @ whole, rtol=1e-12, atol=1e-12)
    r = [random.normal(size=size) for size in SIZES]
    np.testing.assert_allclose(slopes.onto(r), whole.T @ np.concatenate(r), rtol=1e-12)
    step = random.normal(size=K)
    np.testing.assert_allclose(slopes.along(step), whole @ step, rtol=1e-12, atol=1e-12)


def test_each_run_is_whitened_by_its_own_map(parts):
    process = Discrepancy(2.0, 0.1)
    maps = [process.whitening(0.01 * (1 + k) * np.arange(n)) for k, n in enumerate(SIZES)]
    found = Slopes.of(parts, COLUMNS).whitened(maps).dense
    expected = np.concatenate([w(part) for w, part in zip(maps, parts, strict=True)])
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-15)


def test_an_update_gives_the_change_of_each_run_by_the_unknowns_that_act_there(parts):
    random = np.random.default_rng(4)
    slopes, step = Slopes.of(parts, COLUMNS), random.normal(size=K)
    change = [random.normal(size=size) for size in SIZES]
    after = slopes.updated(step, change)
    np.testing.assert_allclose(after.along(step), np.concatenate(change), rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(after.dense == 0.0, slopes.dense == 0.0)
    # It is the least change: along any other direction at a right angle nothing changes.
    for before, now, own in zip(slopes.blocks, after.blocks, COLUMNS, strict=True):
        other = random.normal(size=own.size)
        other -= other @ step[own] / (step[own] @ step[own]) * step[own]
        np.testing.assert_allclose(now @ other, before @ other, rtol=1e-11, atol=1e-12)


def test_what_moves_only_another_run_changes_no_slope_of_this_one(parts):
    slopes, step = Slopes.of(parts, COLUMNS), np.zeros(K)
    step[3] = 0.7  # acts in the last run alone
    change = [np.zeros(40), np.zeros(25), np.ones(60)]
    after = slopes.updated(step, change)
    for n in (0, 1):
        np.testing.assert_array_equal(after.blocks[n], slopes.blocks[n])
    assert np.all(after.blocks[2][:, 1] != slopes.blocks[2][:, 1])


@pytest.mark.parametrize(
    'shape', [(3, 2, 1), (50_000, 5, 3), (10, 600, 500), (0, 2, 2), (7, 0, 2)]
)
def test_a_product_by_parts_is_the_product(shape):
    """With fewer and more rows than a part has, and with parts of a single row."""
    rows, k, m = shape
    random = np.random.default_rng(1)
    a, b = random.normal(size=(rows, k)), random.normal(size=(rows, m))
    np.testing.assert_allclose(product(a, b), a.T @ b, rtol=0.0, atol=1e-9)
