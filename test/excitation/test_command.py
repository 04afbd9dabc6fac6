# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Command lines of ``pam_excite``, and those that the effects propose."""

import pytest

from pam_ros.effects import EFFECTS
from pam_ros.excitation.command import command_line
from pam_ros.excitation.programme import programme
from pam_ros.excitation.settings import Excitation


@pytest.mark.parametrize(
    ('parameters', 'text'),
    [
        ({}, 'pam_excite'),
        ({'duration': 1200.0}, 'pam_excite --ros-args -p duration:=1200'),
        (
            {'segments': ('steps', 'chirps'), 'pressure_min': 0.0},
            "pam_excite --ros-args -p segments:='[steps, chirps]' -p pressure_min:=0",
        ),
    ],
)
def test_the_command_line_has_the_parameters(parameters, text):
    assert command_line(parameters) == text


def test_a_joint_has_its_parameter_file():
    text = "pam_excite --ros-args --params-file elbow.yaml -p segments:='[steps]'"
    assert command_line({'segments': ('steps',)}, 'elbow.yaml') == text
    assert command_line({}, 'elbow.yaml') == 'pam_excite --ros-args --params-file elbow.yaml'


@pytest.mark.parametrize('effect', EFFECTS, ids=lambda e: e.name)
def test_the_experiment_of_an_effect_is_a_programme_that_shows_it(effect):
    if effect.excitation is None:
        assert effect.name in ('end_stop', 'pressure_offset')
        return
    made = programme(Excitation(**effect.excitation))
    shows = ' '.join(segment.text for segment in made.segments)
    words = {
        'creep': 'creep',
        'softening': 'softening',
        'hysteresis': 'hysteresis',
        'coulomb_friction': 'friction',
        'pressure_lag': 'lag',
        'dead_time': 'dead time',
        'payload': 'mass',
        'viscous_friction': 'damping',
        'pressure_dependent_damping': 'damping over pressure',
        'pressure_hysteresis': 'hysteresis',
    }
    assert words.get(effect.name, '') in shows
