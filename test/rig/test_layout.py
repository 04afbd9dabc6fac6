# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rows of a joint and of its muscles: each effect has places of its own in the row it acts in."""

import numpy as np
import pytest

from pam_ros.effects import EFFECTS, Payload
from pam_ros.rig import layout as at
from pam_ros.rig.standard_joints import single_muscle_joint
from support.joint_models import lever, pair, parallel

KINDS = (single_muscle_joint(), pair(), parallel(50.0), lever())


@pytest.mark.parametrize('joint', KINDS, ids=['one', 'pair', 'parallel', 'lever'])
def test_every_effect_has_its_own_places_in_its_row(joint):
    layout = joint.layout
    for on_joint in (True, False):
        states, parameters = [], []
        for effect in layout.library:
            if effect.acts_on_joint() is not on_joint:
                continue
            i, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
            states += range(i, i + len(effect.states))
            parameters += range(j, j + len(effect.parameters()))
            if effect.states and not on_joint:
                assert (i < layout.memory_from) == (effect.equations.pressure is not None)
        first = at.JOINT_HIDDEN if on_joint else at.HIDDEN
        assert sorted(states) == list(range(first, first + len(states)))
        assert first + len(states) <= layout.width
        first = at.JOINT_EFFECTS if on_joint else at.MUSCLE_EFFECTS
        assert sorted(parameters) == list(range(first, first + len(parameters)))
        assert first + len(parameters) <= layout.parameters


def test_load_and_transmission_stand_behind_the_effects_of_the_joint():
    layout = lever().layout
    effects = sum(len(e.parameters()) for e in layout.library if e.acts_on_joint())
    assert layout.load_at == at.JOINT_EFFECTS + effects
    assert layout.transmission_at == layout.load_at + 4
    assert layout.parameters >= layout.transmission_at + 3
    assert layout.rows == 3
    assert layout.run_columns == 2 + 2 * 2


def test_joints_of_one_kind_share_their_layout_and_other_kinds_do_not():
    assert pair().layout is pair(mass=2.0, load=[Payload(mass=0.1)]).layout
    assert len({id(joint.layout) for joint in KINDS}) == len(KINDS)


@pytest.mark.parametrize('effect', EFFECTS, ids=lambda effect: effect.name)
def test_an_index_counts_through_all_rows(effect):
    joint = pair()
    q = np.arange(joint.parameters().size).reshape(joint.parameters().shape)
    j = joint.layout.parameter_at[effect.name]
    row = q[at.JOINT] if effect.acts_on_joint() else q[at.MUSCLE + 1]
    assert (
        joint.layout.index(effect, len(effect.parameters()) - 1, muscle=1)
        == row[j + len(effect.parameters()) - 1]
    )
    assert joint.layout.constant(at.ZETA, muscle=1) == q[at.MUSCLE + 1, at.ZETA]
