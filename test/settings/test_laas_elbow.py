# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The elbow of two McKibben muscles: its constants are those of its geometry."""

import numpy as np
import pytest

from pam_ros.identification.fit.uncertain import spread_unknowns
from pam_ros.settings.nominal import nominal_joint, uncertain_values

RADIUS, BRAID, END, LENGTH, WHEEL = 8.5e-3, np.radians(20.0), 1.25, 0.185, 0.015


@pytest.fixture(scope='module')
def elbow():
    return nominal_joint('laas_elbow')


def law(p, kappa):
    """Return the force in N of Tondu and Lopez (2000) at p Pa."""
    a, b = 3.0 / np.tan(BRAID) ** 2, 1.0 / np.sin(BRAID) ** 2
    return np.pi * RADIUS**2 * p * (a * (1.0 - END * kappa) ** 2 - b)


def test_forces_are_those_of_the_geometry(elbow):
    p, kappa = np.meshgrid(np.linspace(0.0, 4e5, 9), np.linspace(0.0, 0.3, 31))
    muscle = elbow.joint.muscles[0]
    bladder = muscle.force(0.0, kappa)
    assert np.max(np.abs(bladder)) < 10.0
    difference = muscle.force(p, kappa) - bladder - law(p, kappa)
    assert np.max(np.abs(difference)) < 0.004 * np.max(law(p, kappa))


def test_both_muscles_have_the_initial_contraction_in_the_middle(elbow):
    for muscle, actuator, side in zip(
        elbow.joint.muscles, elbow.joint.actuators, (1.0, -1.0), strict=True
    ):
        assert muscle.l0 == LENGTH
        moved = side * WHEEL * 0.845 / LENGTH
        assert actuator.contraction + moved == pytest.approx(0.15, abs=1e-4)
    assert elbow.muscles == ('agonist', 'antagonist')
    low, high = elbow.joint.position_range
    assert low < -0.5
    assert high > 2.0


def test_it_states_the_uncertainty_of_its_values(elbow):
    found = spread_unknowns(elbow.joint, elbow.muscles, uncertain_values('laas_elbow'))
    known = {unknown.name: unknown for unknown in found}
    bladder = known['agonist.a2']
    assert bladder.scale * bladder.prior == pytest.approx(300.0)
    # A degree and 0.4 mm: of a radius, and of the force of each muscle without contraction.
    wider = np.pi * (RADIUS + 0.4e-3) ** 2 * (3.0 / np.tan(BRAID - np.radians(1.0)) ** 2)
    share = wider / (np.pi * RADIUS**2 * 3.0 / np.tan(BRAID) ** 2) - 1.0
    assert 0.5 * share < known['antagonist.a4'].scale / abs(known['antagonist.a4'].base) < share
    assert {'contraction_1', 'contraction_2', 'inertia'} <= set(known)
