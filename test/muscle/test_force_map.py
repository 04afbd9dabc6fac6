# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The map of the static force, and its picture."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from pam_ros.errors import ParameterError
from pam_ros.muscle.force_map import force_map
from pam_ros.muscle.muscle import Muscle
from support import bench


def test_it_is_the_force_law_over_the_whole_working_range():
    muscle = Muscle()
    found = force_map(muscle)
    assert (found.contraction[0], found.contraction[-1]) == (muscle.kappa_min, muscle.kappa_max)
    assert (found.pressure[0], found.pressure[-1]) == (muscle.p_min, muscle.p_max)
    for p, row in zip(found.pressure, found.force, strict=True):
        expected = [bench.pull(p, kappa * muscle.l0) for kappa in found.contraction]
        np.testing.assert_allclose(row, expected, rtol=1e-9, atol=1e-6)


def test_contractions_and_pressures_can_be_given():
    found = force_map(Muscle(), [0.0, 0.1, 0.2], 3e5)
    assert found.force.shape == (1, 3)
    np.testing.assert_array_equal(found.force[0], Muscle().force(3e5, [0.0, 0.1, 0.2]))


def test_its_picture_has_a_curve_for_each_pressure():
    found = force_map(Muscle(), pressure=[1e5, 3e5])
    axes = Figure().subplots()
    assert found.plot(axes) is axes
    curves = {line.get_label(): line for line in axes.lines}
    np.testing.assert_allclose(curves['300 kPa'].get_xdata(), 100.0 * found.contraction)
    np.testing.assert_allclose(curves['300 kPa'].get_ydata(), found.force[1])
    assert '100 kPa' in curves
    assert axes.get_xlabel() == 'contraction [%]'
    assert axes.get_ylabel() == 'force [N]'


def test_without_axes_it_makes_a_figure(monkeypatch):
    monkeypatch.setenv('MPLBACKEND', 'agg')
    plt = pytest.importorskip('matplotlib.pyplot')
    axes = force_map(Muscle()).plot()
    assert axes.figure.number in plt.get_fignums()
    plt.close(axes.figure)


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({'muscle': 'dmsp_20'}, 'give a Muscle'),
        ({'contraction': [[0.1]]}, 'contraction'),
        ({'pressure': []}, 'pressure'),
        ({'pressure': [np.inf]}, r'pressure\[0\] = inf'),
    ],
)
def test_what_is_no_map_is_refused(given, sentence):
    with pytest.raises(ParameterError, match=sentence):
        force_map(**{'muscle': Muscle(), **given})
