# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rows of several joints behind each other."""

import numpy as np

from pam_ros.rig.assembly import assemble
from pam_ros.rig.joints import JOINTS
from pam_ros.rig.model import RigModel
from support.joint_models import pair, parallel


def test_muscles_come_first_and_then_their_load():
    models = (RigModel(), pair(), RigModel(), parallel(50.0))
    rows = assemble(models)
    assert [JOINTS[kind].name for kind in rows.kind] == [
        'mass', 'antagonistic_pair', 'mass', 'parallel',
    ]  # fmt: skip
    np.testing.assert_array_equal(rows.first, [0, 1, 4, 5])
    np.testing.assert_array_equal(rows.load, [0, 3, 4, 7])
    np.testing.assert_array_equal(rows.muscle, [0, 1, 2, 4, 5, 6])
    np.testing.assert_array_equal(rows.q[1:4], models[1].rows())
    np.testing.assert_array_equal(rows.q[4], models[2].row())
    assert not rows.is_plain
    for g, geometry in zip(rows.g[1::2], (models[1].geometry, models[3].geometry), strict=True):
        np.testing.assert_array_equal(g[: len(geometry)], geometry)
        assert not np.any(g[len(geometry) :])


def test_muscles_with_loads_of_their_own_are_one_row_each():
    rows = assemble((RigModel(), RigModel()))
    assert rows.is_plain
    np.testing.assert_array_equal(rows.first, rows.load)
