# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The demonstration's position control: numbers of sources that are known."""

from dataclasses import fields

import numpy as np
import pytest

from pam_ros.demo.position import PositionRun, figure, settling, table
from pam_ros.errors import PamError

TIME = np.arange(0.0, 4.0, 0.01)


def approach(goal, constant):
    """Return a load that approaches a goal with a time constant in s."""
    position = goal - 0.01 * np.exp(-TIME / constant)
    reference = np.full_like(TIME, goal)
    return PositionRun(TIME, reference, position, 0.0 * TIME, np.full_like(TIME, 3e5))


def test_settling_is_when_an_exponential_has_come_near():
    # 0.01 exp(-t / T) = 0.1e-3 at t = T ln 100.
    assert settling(approach(0.06, 0.2), 0.06) == pytest.approx(0.2 * np.log(100.0), abs=0.011)
    assert settling(approach(0.06, 10.0), 0.06) == np.inf


def test_a_departure_is_when_the_reference_has_left():
    run = approach(0.06, 0.2)
    run.reference[TIME >= 2.5] = 0.07
    assert run.departure(1.0, 1e-6) == pytest.approx(2.5)
    with pytest.raises(PamError, match=r'stays at 0\.07 m from 3'):
        run.departure(3.0, 1e-6)
    lossy = PositionRun(
        *(getattr(run, f.name)[(TIME < 1.0) | (TIME > 1.5)] for f in fields(PositionRun))
    )
    with pytest.raises(PamError, match='were lost'):
        lossy.departure(0.5, 1e-6)


def test_the_table_has_the_error_at_rest_and_that_of_the_sine():
    off = approach(0.06, 0.01)
    off.position[:] = 0.06 - 25e-6
    swing = 0.01 * np.sin(np.pi * TIME)
    sine = PositionRun(TIME, swing, swing - 12e-6, 0.0 * TIME, 0.0 * TIME)
    first, row, last = table([(0.06, off)], sine).splitlines()
    assert first.startswith('set-point')
    assert row.split() == ['60.0', 'mm', '0.00', 's', '25.0', 'um', '0.00', 'kPa']
    assert last == 'sine of 10.0 mm: error 12.0 um RMS'


def test_the_figure_shows_position_error_pressure_and_sliding_variable():
    drawn = figure(approach(0.06, 0.2), 'headline')
    titles = [ax.get_title(loc='left') or ax.get_title() for ax in drawn.axes]
    assert titles == ['position [mm]', 'error [mm]', 'pressure [kPa]', 'sliding variable [mm/s]']
    error = drawn.axes[1].lines[0].get_ydata()
    assert error[0] == pytest.approx(10.0)
