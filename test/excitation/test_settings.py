# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Limits of an excitation that contradict each other or the muscle."""

import pytest

from pam_ros.errors import ParameterError
from pam_ros.excitation.settings import Excitation
from pam_ros.muscle.muscle import Muscle


@pytest.mark.parametrize(
    ('values', 'words'),
    [
        ({'pressure_min': 5e5}, ['pressure_min = 500000', 'pressure_max = 450000']),
        ({'contraction_max': -0.1}, ['contraction_min = -0.04', 'contraction_max = -0.1']),
        ({'position_min': 0.2, 'position_max': 0.1}, ['position_min = 0.2', 'position_max = 0.1']),
        ({'duration': 5.0}, ['duration = 5.0', '30 to 3600 s']),
        ({'pressure_rate': 0.0}, ['pressure_rate']),
        ({'rate': 50.0}, ['frequency_max = 8 Hz', 'rate = 50 Hz']),
        ({'seed': -1}, ['seed']),
        ({'segments': ('steps', 'chirp')}, ['segments', 'a list of steps, slow_triangle']),
        ({'segments': 'steps'}, ["segments = 'steps'", 'a list of steps, slow_triangle']),
        ({'segments': ()}, ['segments = []', 'at least one segment']),
        ({'segments': ('steps', 'steps')}, ["['steps', 'steps']", 'each once']),
        ({'pressure_max': float('nan')}, ['pressure_max']),
    ],
)
def test_what_makes_no_programme(values, words):
    with pytest.raises(ParameterError) as caught:
        Excitation(**values)
    for word in words:
        assert word in str(caught.value)


def test_the_limits_of_the_muscle_apply_as_well():
    small = Muscle(p_max=4e5, kappa_min=-0.03, kappa_max=0.2)
    narrowed = Excitation().within(small)
    assert (narrowed.pressure_min, narrowed.pressure_max) == (5e4, 4e5)
    assert (narrowed.contraction_min, narrowed.contraction_max) == (-0.03, 0.2)
    assert Excitation(contraction_max=0.1).within(small).contraction_max == 0.1


def test_a_muscle_that_leaves_nothing():
    with pytest.raises(ParameterError, match='pressure_min = 450000 is not below'):
        Excitation(pressure_min=4.5e5, pressure_max=5e5).within(Muscle(p_max=4e5))
