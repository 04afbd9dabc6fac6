# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The demonstration's antagonistic joint: numbers of sources that are known."""

import numpy as np
import pytest

from pam_ros.demo.joint import JointRun, figure, table

TIME = np.arange(0.0, 6.0, 0.01)
SWING = 0.25
TOLD = np.where(TIME < 4.0, 20.0, 30.0)


def swinging(off):
    """Return a joint that rests for 2 s, then swings, *off* rad behind; stiffer after 4 s."""
    reference = np.where(TIME > 2.0, SWING * np.sin(np.pi * TIME), 0.0)
    flat = np.full_like(TIME, 2e5)
    return JointRun(TIME, reference, reference - off, flat, 2.0 * flat, TOLD, TOLD + 0.5)


def test_it_departs_when_the_reference_moves():
    assert swinging(0.0).departure == pytest.approx(2.01)


def test_the_table_has_error_and_stiffness_of_each_part():
    run = swinging(np.radians(0.1))
    head, soft, stiff = table(
        [
            ('soft', run.between(2.0, 4.0)),
            ('stiff', run.with_stiffness(30.0)),
        ]
    ).splitlines()
    assert head.split() == ['amplitude', 'error', 'RMS', 'largest', 'N', 'm/rad', 'set']
    degrees = f'{np.degrees(SWING):.1f}'
    each = [degrees, 'deg', '0.100', 'deg', '0.100', 'deg']
    assert soft.split() == ['soft', *each, '20.50', '20.00']
    assert stiff.split() == ['stiff', *each, '30.50', '30.00']


def test_the_figure_shows_angle_error_pressures_and_stiffness():
    drawn = figure(swinging(np.radians(0.1)), 'headline')
    titles = [ax.get_title(loc='left') or ax.get_title() for ax in drawn.axes]
    assert titles == [
        'angle [degrees]',
        'error [degrees]',
        'pressure [kPa]',
        'stiffness of the joint [N m/rad]',
    ]
    angle, error, pressure, stiffness = drawn.axes
    assert error.lines[0].get_ydata()[0] == pytest.approx(0.1)
    assert [line.get_ydata()[0] for line in pressure.lines] == [200.0, 400.0]
    assert [line.get_ydata()[-1] for line in stiffness.lines] == [30.0, 30.5]
    assert np.max(angle.lines[0].get_ydata()) == pytest.approx(np.degrees(SWING), rel=1e-3)
