# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Constants from the geometry of a braid, against virtual work on a cylinder of threads."""

import numpy as np
import pytest

from pam_ros.errors import ParameterError
from pam_ros.muscle.braid import Braid


def force_of_threads(p, kappa, radius, angle):
    """Return -p dV/dL of a cylinder in threads that do not stretch, by differences.

    A thread of length b winds n times around: L^2 + (2 pi n r)^2 = b^2.
    """
    length = 0.3
    b = length / np.cos(angle)
    n = np.sqrt(b**2 - length**2) / (2.0 * np.pi * radius)

    def volume(now):
        return (b**2 - now**2) / (4.0 * np.pi * n**2) * now

    now, d = length * (1.0 - kappa), 1e-5
    return -p * (volume(now + d) - volume(now - d)) / (2.0 * d)


@pytest.mark.parametrize(('radius', 'angle'), [(0.0085, 20.0), (0.01, 25.0), (0.004, 35.0)])
def test_force_is_that_of_virtual_work(radius, angle):
    braid = Braid(radius, angle)
    p, kappa = np.meshgrid([1e5, 3e5], np.linspace(-0.05, 0.3, 15))
    wanted = force_of_threads(p, kappa, radius, np.radians(angle))
    np.testing.assert_allclose(braid.force(p, kappa), wanted, rtol=1e-7, atol=1e-6 * wanted.max())


@pytest.mark.parametrize('angle', [15.0, 20.0, 30.0, 45.0])
@pytest.mark.parametrize('end_factor', [1.0, 1.25])
def test_the_force_law_differs_by_the_stated_share(angle, end_factor):
    braid = Braid(0.01, angle, end_factor, bladder=1e-3)
    high = 0.9 * braid.greatest_contraction
    muscle = braid.muscle(l0=0.25, p_max=4e5, kappa_min=-0.05, kappa_max=high)
    kappa = np.linspace(-0.05, high, 77)
    off = np.max(np.abs(muscle.force(4e5, kappa) - braid.force(4e5, kappa)))
    greatest = np.max(braid.force(4e5, kappa))
    assert off / greatest == pytest.approx(
        braid.misfit(braid.constants(high), -0.05, high), rel=0.02
    )
    assert off / greatest < 0.015
    inside = np.linspace(0.0, high, 77)
    off = np.max(np.abs(muscle.force(4e5, inside) - braid.force(4e5, inside)))
    assert off / greatest < 0.005
    assert (
        f'within {100.0 * braid.misfit(braid.constants(high), -0.05, high):.2g} %' in muscle.source
    )


def test_ends_that_stay_narrow_act_as_more_contraction():
    narrow, plain = Braid(0.01, 20.0, 1.25), Braid(0.01, 20.0)
    kappa = np.linspace(0.0, 0.25, 6)
    np.testing.assert_allclose(narrow.force(1e5, kappa), plain.force(1e5, 1.25 * kappa))


def test_it_stops_to_pull_where_its_threads_are_steep():
    braid = Braid(0.01, 20.0, 1.2)
    assert braid.force(5e5, braid.greatest_contraction) == pytest.approx(0.0, abs=1e-6)
    # cos(54.7 deg) = 1/sqrt(3), the angle of most volume.
    length = np.cos(np.arccos(1.0 / np.sqrt(3.0))) / np.cos(np.radians(20.0))
    assert 1.0 - length == pytest.approx(1.2 * braid.greatest_contraction)


def test_the_bladder_resists_without_pressure():
    muscle = Braid(0.01, 20.0, 1.25, bladder=60.0).muscle(kappa_min=0.0, kappa_max=0.3)
    assert muscle.force(0.0, 0.0) == pytest.approx(0.0, abs=1e-12)
    assert muscle.force(0.0, 0.3) == pytest.approx(60.0 * (np.exp(-0.9) - 1.0))


def test_what_the_braid_leaves_open_is_given():
    muscle = Braid(0.01, 20.0, 1.25).muscle(l0=0.2, zeta=0.4, source='mine', force_max=900.0)
    assert (muscle.l0, muscle.zeta, muscle.source) == (0.2, 0.4, 'mine')
    assert (muscle.force_max, muscle.inside_diameter) == (900.0, 0.02)
    rated = Braid(0.01, 20.0, 1.25).muscle(p_max=3e5)
    assert rated.force_max == pytest.approx(Braid(0.01, 20.0).force(3e5, 0.0))


@pytest.mark.parametrize(
    ('fields', 'message'),
    [
        (
            {'kappa_max': 0.32},
            'kappa_max = 0.32 is not allowed: this braid .* of 0.308 on; give less',
        ),
        ({'a2': 3.0}, 'a2 follows from the braid'),
        ({'pressure_unit': 'bar'}, 'pressure_unit follows from the braid'),
        ({'p_max': 'high'}, 'p_max'),
        ({'kappa_max': float('nan')}, 'kappa_max'),
    ],
)
def test_what_does_not_fit_it_is_refused(fields, message):
    with pytest.raises(ParameterError, match=message):
        Braid(0.0085, 20.0, 1.25).muscle(**fields)


@pytest.mark.parametrize(
    ('values', 'message'),
    [
        ((0.0, 20.0), 'radius = 0.0 is not allowed'),
        ((0.01, 60.0), 'angle = 60.0 is not allowed: give 1 to 54 deg'),
        ((0.01, 20.0, 0.5), 'end_factor = 0.5 is not allowed'),
        ((0.01, 20.0, 1.0, -5.0), 'bladder = -5.0 is not allowed'),
        ((0.01, float('nan')), 'angle = nan is not allowed'),
    ],
)
def test_a_geometry_that_cannot_be_is_refused(values, message):
    with pytest.raises(ParameterError, match=message):
        Braid(*values)
