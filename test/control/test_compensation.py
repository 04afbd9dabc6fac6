# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What declared effects take, against the rig that has them."""

import numpy as np
import pytest
from pam_ros.control.inner_model import InnerModel
from pam_ros.rig.model import RigModel

from pam_ros.control.compensation import Losses, left_to_feedback
from pam_ros.control.signals import Reference
from pam_ros.rig.run import simulate_held

DT = 2e-3
LOSSES = {
    'hysteresis': {'slip': 30.0, 'slip_width': 0.02},
    'creep': {'force': 0.04},
}


def test_losses_along_a_motion_are_what_the_rig_pulls_less():
    model, bare = RigModel(effects=LOSSES), RigModel()
    t = np.arange(0.0, 4.0, DT)
    y = 0.05 + 0.02 * np.sin(2.0 * t) ** 2
    v = np.gradient(y, t)
    p = 300e3 + 50e3 * np.sin(3.0 * t)
    with_effects = simulate_held(model, t, p, y, v, step=DT).force
    without = simulate_held(bare, t, p, y, v, step=DT).force
    losses, inner = Losses(model), InnerModel(model)
    losses.start(y[0], p[0])
    found = []
    for n in range(len(t)):
        reference = Reference(y[n], v[n])
        found.append(losses.follow(DT, reference, p[n], inner.force(p[n], y[n])))
    expected = without - with_effects
    assert np.ptp(expected) > 40.0
    np.testing.assert_allclose(found[5:], expected[5:], atol=0.6)


def test_friction_turns_over_with_the_motion():
    losses = Losses(RigModel(effects={'coulomb_friction': {'level': 15.0}}))
    losses.start(0.05, 300e3)
    for n in range(100):
        up = losses.follow(DT, Reference(0.05 + 1e-4 * n, 0.05), 300e3, 200.0)
    for n in range(100):
        down = losses.follow(DT, Reference(0.06 - 1e-4 * n, -0.05), 300e3, 200.0)
    assert up == pytest.approx(15.0)
    assert down == pytest.approx(-15.0)


def test_without_effects_nothing_is_lost():
    losses = Losses(RigModel())
    assert losses.follow(DT, Reference(0.05, 0.1), 300e3, 200.0) == 0.0


def test_it_says_what_it_leaves_to_feedback():
    model = RigModel(
        effects={'payload': {'mass': 1.0}, 'leak': {'rate': 0.1}, 'hysteresis': {'slip': 3.0}}
    )
    assert left_to_feedback(model) == ('leak',)
