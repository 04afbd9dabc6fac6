# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the controller takes for the rig, against the rig itself."""

import pytest

from pam_ros.control.inner_model import InnerModel
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.model import Load, RigModel
from pam_ros.rig.rig import Rig

EFFECTS = {
    'payload': {'mass': 5.0},
    'length_offset': {'offset': 0.02},
    'viscous_friction': {'coefficient': 40.0},
    'pressure_dependent_damping': {'inflating': 3e-4, 'deflating': 5e-4},
}


@pytest.mark.parametrize('effects', [{}, EFFECTS])
@pytest.mark.parametrize('v', [0.1, -0.1])
def test_it_is_the_rig_without_memory(effects, v):
    model = RigModel(Muscle(zeta=0.15), Load(mass=20.0), effects)
    rig, inner = Rig([model]), InnerModel(model)
    p, y = 280e3, 0.05
    rig.reset([p], [y], [v])
    force, stiffness, _, acceleration = rig.outputs()[0]
    assert inner.force(p, y) == pytest.approx(force, rel=1e-12)
    assert inner.stiffness(p, y) == pytest.approx(stiffness, rel=1e-12)
    net = (inner.pull(p, y, v) - inner.weight) / inner.mass
    assert net == pytest.approx(acceleration, rel=1e-9)
    assert inner.pull(p, y, v) == pytest.approx(force - inner.damping(p, y, v) * v, rel=1e-12)


def test_the_inverse_is_one():
    inner = InnerModel(RigModel(effects={'length_offset': {'offset': 0.02}}))
    assert inner.force(inner.pressure_for(200.0, 0.03), 0.03) == pytest.approx(200.0)
    slope = (inner.force(301e3, 0.03) - inner.force(300e3, 0.03)) / 1e3
    assert inner.gain(0.03) == pytest.approx(slope, rel=1e-9)
