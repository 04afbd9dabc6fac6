# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Two muscles side by side: positions, weight, and what one of them alone would do."""

import pytest

from pam_ros.rig import statics
from pam_ros.rig.joints.parallel import ParallelLoad
from pam_ros.rig.model import GRAVITY, Load, RigModel
from pam_ros.rig.rig import Rig
from support import joints
from support.joint_models import BOTH_LONG, actuators, muscle, parallel


def test_position_0_is_where_the_muscles_have_their_stated_contractions():
    model = parallel(50.0, offsets=(0.05, -0.02))
    for i, (offset, l0) in enumerate(((0.05, 0.4), (-0.02, 0.2))):
        assert statics.contraction(model, i, 0.0) == pytest.approx(offset)
        assert statics.contraction(model, i, 0.03) == pytest.approx(offset + 0.03 / l0)


def test_each_of_two_equal_muscles_carries_half_the_weight():
    rig = Rig([parallel(50.0, BOTH_LONG)])
    rig.command(4e5)
    rig.advance(8000)
    for force in rig.outputs()[:, 0]:
        assert force == pytest.approx(25.0 * GRAVITY, abs=1e-6)
    assert rig.joint_outputs()[0, 0] == pytest.approx(50.0 * GRAVITY, abs=1e-6)


def test_it_rests_where_one_of_two_equal_muscles_rests_with_half_the_mass():
    one = RigModel(muscle(joints.LONG), Load(mass=25.0))
    for p in (1e5, 4e5):
        assert parallel(50.0, BOTH_LONG).rest(p) == pytest.approx(one.rest(p), abs=1e-12)


def test_it_may_slide_without_gravity():
    from pam_ros.rig.joint_model import JointModel

    model = JointModel(ParallelLoad(mass=5.0, mount='horizontal'), actuators(BOTH_LONG))
    assert statics.weight(model, 0.01) == 0.0
    rest = model.rest(3e5)
    assert joints.LONG.force(3.0, rest) == pytest.approx(0.0, abs=1e-9)
