# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which known names an unknown one probably stands for."""

import pytest

from pam_ros.effects import EFFECTS
from pam_ros.similar_names import near, not_known, similar

NAMES = [effect.name for effect in EFFECTS]


@pytest.mark.parametrize(
    ('name', 'expected'),
    [
        ('friction', ['viscous_friction', 'coulomb_friction']),
        ('hysteresis', ['hysteresis', 'pressure_hysteresis']),
        ('Lag', ['pressure_lag']),
        ('couloumb_friction', ['coulomb_friction', 'viscous_friction']),
        ('temperature', []),
        ('l', []),
    ],
)
def test_names_that_contain_it_or_resemble_it(name, expected):
    assert near(name, NAMES) == expected


def test_a_mistyped_name_is_similar_and_another_one_is_not():
    assert similar('massa', ['mass', 'mount']) == 'mass'
    assert similar('friction', NAMES) == ''


def test_the_error_has_the_near_names_or_all():
    text = str(not_known('effects.friction', 'friction', NAMES))
    assert text == 'effects.friction is not known: was viscous_friction or coulomb_friction meant?'
    text = str(not_known('effects.x', 'x', ['a', 'b']))
    assert text == 'effects.x is not known: give one of a, b'
