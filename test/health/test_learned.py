# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the diagnostics say about what a law has learned."""

from dataclasses import replace

import pytest

from pam_ros.control.learned import Learned
from pam_ros.health.health import Level
from pam_ros.health.learned import learning

FRICTION = Learned(
    motion=12.0,
    missing=15.0,
    noise=1.0,
    explained=0.95,
    weight=1.0,
    friction=15.2,
    breakaway=8.1,
    stiffness=-20.0,
    lag=(0.0, 0.0),
    dropped_lag=None,
    restarts=0,
)


@pytest.mark.parametrize(
    ('changes', 'message'),
    [
        ({'motion': 0.0}, 'has learned nothing: the load has not moved yet'),
        ({}, 'compensates what was learned'),
        (
            {'missing': 1.9, 'explained': 0.0, 'weight': 0.0},
            'the nominal model lacks no force that changes with the motion',
        ),
        (
            {'explained': 0.1, 'weight': 0.12},
            'what was learned explains 10 % of the missing force: it is used with a weight of '
            '0.12',
        ),
        (
            {'dropped_lag': (0.048, 0.07)},
            'compensates what was learned; a learned lag of 48 ms (filling) and 70 ms (venting) '
            'is not used any more: the motion is predicted better without it',
        ),
        (
            {'restarts': 1},
            'everything learned was forgotten once: the loop oscillated; '
            'compensates what was learned',
        ),
        (
            {'motion': 0.0, 'restarts': 2},
            'everything learned was forgotten 2 times: the loop oscillated; '
            'has learned nothing: the load has not moved since then',
        ),
    ],
)
def test_one_sentence_lists_what_is_used_and_what_is_not_any_more(changes, message):
    health = learning(replace(FRICTION, **changes), 'm')
    assert (health.level, health.message) == (Level.OK, message)


def test_the_numbers_have_the_units_of_the_joint():
    values = learning(FRICTION, 'm').values
    assert values['friction and hysteresis (N)'] == 15.2
    assert values['additional friction at rest (N)'] == 8.1
    assert values['additional stiffness (N/m)'] == -20.0
    assert values['lag while filling (s)'] == 0.0
    revolute = learning(replace(FRICTION, lag=None), 'rad').values
    assert revolute['friction and hysteresis (N m)'] == 15.2
    assert revolute['additional stiffness (N m/rad)'] == -20.0
    assert revolute['lag while venting (s)'] is None  # it is configured


def test_a_law_that_does_not_learn_reports_it():
    assert learning(None, 'm') == (Level.OK, 'the law does not learn', {})
