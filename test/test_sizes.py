# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes of rigs, and what each unit is there."""

from dataclasses import astuple, replace

import pytest

from pam_ros.effects import EFFECTS
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.sizes import REFERENCE, Sizes, sizes_of, tuned_sizes_of

LARGE = Sizes(force=10.0, pressure=100.0, length=0.1)
FACTORS = {
    '': 1.0,
    'fraction': 1.0,
    's': 1.0,
    '1/s': 1.0,
    '1/fraction': 1.0,
    'Hz': 1.0,
    'N': 10.0,
    'kg': 10.0,
    'Pa': 100.0,
    '1/Pa': 0.01,
    'Pa/s': 100.0,
    'm': 0.1,
    'm/s': 0.1,
    's/m': 10.0,
    'N/m': 100.0,
    'N^2': 100.0,
    'N m': 1.0,
    'N m/(rad s)': 1.0,
    'N/Pa': 0.1,
    'N s/m': 100.0,
    'N s/(m Pa)': 1.0,
}


def test_the_factor_of_every_unit_of_the_library():
    units = {p.unit for one in EFFECTS for p in (*one.parameters(), *one.states)}
    assert units <= {*FACTORS}
    for unit, factor in FACTORS.items():
        assert LARGE.factor(unit) == pytest.approx(factor), unit
        assert REFERENCE.factor(unit) == 1.0


@pytest.mark.parametrize(
    ('change', 'decades', 'exact'),
    [
        ({}, REFERENCE, REFERENCE),
        ({'l0': 0.2, 'p_max': 1e6}, REFERENCE, REFERENCE),
        ({'l0': 0.04}, Sizes(length=0.1), Sizes(length=0.1)),
        ({'l0': 1.6}, Sizes(length=10.0), Sizes(length=4.0)),
        ({'p_max': 9e4}, Sizes(0.1, 0.1), Sizes(0.159, 0.15)),
    ],
)
def test_tuning_numbers_follow_exactly_the_rigs_of_another_order(change, decades, exact):
    joint = single_muscle_joint(replace(Muscle(), **change))
    assert sizes_of(joint) == decades
    assert astuple(tuned_sizes_of(joint)) == pytest.approx(astuple(exact), rel=0.01)
