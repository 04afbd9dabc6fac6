# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The figures show what they say: axes, units and the curves of the run."""

import numpy as np
import pytest
from matplotlib.image import imread

from pam_ros.demo.figures import figure_5, figure_6, figure_steps, save
from pam_ros.demo.run import PublishedRun
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import single_muscle_joint

MODEL = single_muscle_joint()


@pytest.fixture(scope='module')
def run():
    t = np.arange(0.0, 3.0, 0.002)
    path = simulate(MODEL, t, [600e3], [0.0], position=0.0)
    kappa = path.position / MODEL.muscle.l0
    return PublishedRun(
        t + 50.0,
        path.position,
        path.velocity,
        path.pressure,
        MODEL.muscle.force(path.pressure, kappa),
        MODEL.muscle.stiffness(path.pressure, kappa),
        MODEL.muscle.damping(path.pressure, kappa, 20.0),
    )


def titles(figure):
    return [ax.get_title(loc='left') for ax in figure.axes]


def test_figure_5_has_the_papers_three_curves(run):
    figure = figure_5(run, MODEL)
    assert titles(figure) == [
        'damping ratio ζ [-]',
        'stiffness k [N/m]',
        'damping coefficient c [N s/m]',
    ]
    assert figure.axes[-1].get_xlabel() == 'contraction [%]'
    for ax in figure.axes:
        line, dots = ax.get_lines()
        assert line.get_xdata()[[0, -1]].tolist() == [0.0, 25.0]
        inside = (dots.get_xdata() >= 0.0) & (dots.get_xdata() <= 25.0)
        on_line = np.interp(dots.get_xdata()[inside], line.get_xdata(), line.get_ydata())
        np.testing.assert_allclose(dots.get_ydata()[inside], on_line, rtol=1e-3)


def test_figure_6_has_acceleration_velocity_and_force(run):
    figure = figure_6(run, MODEL)
    assert titles(figure) == ['acceleration [m/s²]', 'velocity [m/s]', 'spring force F_spring [N]']
    acceleration, velocity, force = (ax.get_lines()[-1].get_ydata() for ax in figure.axes)
    np.testing.assert_array_equal(velocity, run.velocity)
    np.testing.assert_array_equal(force, run.force)
    # Equation (3) against the slope of the velocity.
    slope = np.gradient(run.velocity, run.t)
    assert np.max(np.abs(acceleration - slope)[1:-1]) < 0.02 * np.max(np.abs(slope))
    low, high = figure.axes[2].get_ylim()
    assert low < run.force.min()
    assert high > run.force.max()
    assert 'at rest 196.1 N (paper: 198 N)' in [t.get_text() for t in figure.axes[2].texts]


def test_the_steps_follow_each_other_and_are_saved(run, tmp_path):
    later = PublishedRun(run.t + 3.0, *(getattr(run, n) for n in list(vars(run))[1:]))
    figure = figure_steps([run, later], MODEL)
    assert figure.axes[-1].get_xlim() == pytest.approx((0.0, 5.998))
    save(figure, tmp_path / 'steps.png')
    height, width, _ = imread(tmp_path / 'steps.png').shape
    assert width == 1520
    assert height > 800
