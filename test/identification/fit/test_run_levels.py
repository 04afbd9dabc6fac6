# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Levels of recordings at one prescribed length."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.run_levels import LEVEL, level_unknowns
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint

RIG = single_muscle_joint(Muscle(), Mass(mass=20.0))


def resting(*kappas, force=300.0, seconds=4.0):
    """Return held runs of a muscle of 0.4 m at these contractions, under a rising force."""
    t = np.arange(round(50 * seconds)) / 50.0
    return segments_of(
        [
            Recording(
                'h', t, None, None, np.full(t.size, kappa * 0.4), None,
                np.linspace(0.0, force, t.size), np.full(t.size, 3e5), 'held',
            )
            for kappa in kappas
        ],
    )  # fmt: skip


def test_each_run_at_a_length_has_a_level_against_the_last_one_there():
    runs = resting(0.1, 0.2, 0.1, 0.2, 0.1, 0.05)
    found = level_unknowns(runs, RIG)
    assert [k.name for k in found] == ['level[0]', 'level[1]', 'level[2]']
    assert [k.value(1.0) for k in found] == pytest.approx(3 * [LEVEL * 300.0])
    assert {k.prior for k in found} == {1.0}
    assert not any(k.is_parameter for k in found)


def test_lengths_that_differ_or_change_and_loads_that_move_have_no_level():
    assert level_unknowns(resting(0.1, 0.102), RIG) == []
    first, second = resting(0.1, 0.1)
    moving = replace(first, position=first.position + np.linspace(0.0, 1e-3, first.t.size))
    assert level_unknowns([moving, second], RIG) == []
    assert level_unknowns([second, moving], RIG) == []
    t = np.arange(100) / 50.0
    free = Recording('f', t, t, np.full(100, 3e5), np.full(100, 0.05))
    assert level_unknowns(segments_of([free, free]), RIG) == []
