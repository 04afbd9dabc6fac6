# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The force over the position: the integral of a slope that is linear between knots."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from pam_ros.control.learning.force_curve import KNOTS, ForceCurve

LOW, HIGH, STROKE = -0.01, 0.09, 0.01
KNOTS_AT = np.linspace(LOW, HIGH, KNOTS)
SLOPES = np.random.default_rng(3).uniform(-100.0, 100.0, KNOTS)  # N a stroke


def slope_at(position):
    """Return the interpolated slope in N/m, which numpy keeps constant outside."""
    return float(np.interp(position, KNOTS_AT, SLOPES)) / STROKE


@pytest.mark.parametrize('position', [-0.05, LOW, -0.002, 0.0025, 0.0131, 0.0525, HIGH, 0.12])
def test_the_force_is_the_integral_of_the_slopes(position):
    curve = ForceCurve((LOW, HIGH), STROKE)
    force = SLOPES @ curve.features(position) - SLOPES @ curve.features(0.03)
    between = [float(knot) for knot in KNOTS_AT if min(position, 0.03) < knot]
    found, _ = quad(slope_at, 0.03, position, points=between, limit=200)
    assert force == pytest.approx(found, abs=1e-9)


@pytest.mark.parametrize('position', [-0.05, LOW, 0.0, 0.0131, 0.0525, HIGH, 0.12])
def test_the_slope_is_that_of_the_knots_beside(position):
    knot, share = ForceCurve((LOW, HIGH), STROKE).at(position)
    slope = (1.0 - share) * SLOPES[knot] + share * SLOPES[knot + 1]
    assert slope / STROKE == pytest.approx(slope_at(position))


def test_a_knot_changes_nothing_beyond_its_neighbours():
    """So that what is learned in one part of the reach is not extrapolated to the other end."""
    curve = ForceCurve((LOW, HIGH), STROKE)
    for knot in range(1, KNOTS - 1):
        left, right = KNOTS_AT[knot - 1], KNOTS_AT[knot + 1]
        beyond = [curve.features(x)[knot] for x in (right, right + 0.01, HIGH + 0.01)]
        assert beyond == pytest.approx([(HIGH - LOW) / (KNOTS - 1) / STROKE] * 3)
        assert [curve.features(x)[knot] for x in (left, LOW - 0.01)] == pytest.approx([0.0] * 2)


def test_without_a_finite_reach_there_is_one_slope():
    curve = ForceCurve((-math.inf, math.inf), STROKE)
    assert curve.at(3.0) == (0, 0.0)
    assert curve.features(-0.5) == pytest.approx([-0.5 / STROKE] + [0.0] * (KNOTS - 1))


def test_a_position_that_is_not_a_number_has_no_force():
    """A law checks its command, and says then which parameters do not give one."""
    curve = ForceCurve((LOW, HIGH), STROKE)
    assert curve.at(math.nan) == (0, 0.0)
    assert math.isnan(sum(curve.features(math.nan)))
