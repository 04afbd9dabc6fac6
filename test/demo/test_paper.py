# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The numbers compared with the paper's, from motions whose numbers are known."""

import numpy as np
import pytest

from pam_ros.demo import paper
from pam_ros.demo.run import PublishedRun
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint

MODEL = single_muscle_joint()


def swing(hertz, decay, rest, amplitude=0.02, seconds=3.0, rate=500.0):
    """Return a decaying swing about *rest* m, with the spring constant of its frequency."""
    t = 100.0 + np.arange(0.0, seconds, 1.0 / rate)
    omega = 2.0 * np.pi * hertz
    wave = amplitude * np.exp((-decay + 1j * omega) * (t - t[0]))
    position = rest + wave.real
    velocity = ((-decay + 1j * omega) * wave).real
    ones = np.ones_like(t)
    return PublishedRun(
        t, position, velocity, 600e3 * ones, 196.0 + 50.0 * wave.real, 13e3 * ones, 150.0 * ones
    )


@pytest.mark.parametrize(('hertz', 'decay'), [(4.15, 3.9), (1.0, 0.3), (11.3, 8.0)])
def test_frequency_is_that_of_the_swing(hertz, decay):
    assert paper.frequency(swing(hertz, decay, 0.09)) == pytest.approx(hertz, rel=2e-3)


def test_resting_values_are_those_of_the_last_quarter_of_a_second():
    run = swing(4.0, 6.0, 0.09)
    end = paper.resting(run)
    assert end.t[0] == pytest.approx(run.t[-1] - paper.SETTLED, abs=0.003)
    assert end.position.mean() == pytest.approx(0.09, abs=1e-7)


def test_between_takes_the_begin_and_leaves_the_end():
    run = swing(4.0, 6.0, 0.09)
    part = run.between(run.t[10], run.t[20])
    np.testing.assert_array_equal(part.position, run.position[10:20])
    np.testing.assert_array_equal(part.damping, run.damping[10:20])


def test_acceleration_is_equation_3():
    run = swing(4.0, 6.0, 0.09)
    for mount, gravity in (('vertical', 9.80665), ('horizontal', 0.0)):
        joint = single_muscle_joint(load=Mass(8.0, mount))
        wanted = (run.force - run.damping * run.velocity) / 8.0 - gravity
        np.testing.assert_allclose(run.acceleration(joint), wanted, rtol=1e-12)


def test_the_values_of_the_paper_stand_next_to_ours():
    rows = paper.compare(swing(4.15, 6.0, 0.0973), MODEL)
    force, static, kappa, k, c, hertz = rows
    assert force.wanted == 198.0
    assert static.wanted == pytest.approx(20.0 * 9.81)
    assert force.ours == static.ours == pytest.approx(196.0, abs=1e-3)
    assert force.difference == pytest.approx(-2.0, abs=1e-3)
    # The muscle at 600 kPa and 20 kg, computed by hand from the printed constants.
    assert kappa.wanted == pytest.approx(24.33, abs=0.005)
    assert kappa.ours == pytest.approx(100.0 * 0.0973 / 0.4, abs=1e-4)
    assert k.wanted == pytest.approx(13912.6, abs=0.5)
    assert c.wanted == pytest.approx(2.0 * 0.15 * np.sqrt(20.0 * 13912.6), abs=0.01)
    assert hertz.wanted == pytest.approx(np.sqrt(13912.6 / 20.0 * (1 - 0.15**2)) / 2 / np.pi, 1e-4)


def test_the_table_is_aligned_and_signs_differences():
    rows = [
        paper.StepRow('force', 'N', 198.0, 'section 3', 196.13),
        paper.StepRow('contraction', '%', 24.33, 'equation (1)', 24.3301, 2),
    ]
    assert paper.table(rows).splitlines() == [
        'quantity         paper  where          ours  difference  relative',
        'force [N]        198.0  section 3     196.1        -1.9   -0.94 %',
        'contraction [%]  24.33  equation (1)  24.33        0.00    0.00 %',
    ]
