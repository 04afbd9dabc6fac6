# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Uncertain numbers of a rig that act alike, or not at all."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from math import log1p

import numpy as np
import pytest

from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.discrepancy import WHITE
from pam_ros.identification.fit.intervals import covariance
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.solve import initial_solution
from pam_ros.identification.fit.uncertain import spread_unknowns
from pam_ros.identification.fit.undetermined import undetermined, undetermined_before
from pam_ros.identification.fit.unknowns import run_unknowns
from pam_ros.recording.recording import Recording
from pam_ros.rig.loads import Arm
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import antagonistic_joint

NAMES = ('flexor', 'extensor')
NOISE = 1e-4
T = np.arange(0.0, 6.0, 0.01)
COMMAND = 1e3 * np.stack(
    [
        250.0 + 90.0 * np.sign(np.sin(4.0 * T)) + 60.0 * np.sin(1.3 * T),
        260.0 - 70.0 * np.sign(np.cos(3.0 * T)) + 50.0 * np.cos(2.1 * T),
    ],
    axis=1,
)
ARM = Arm(inertia=0.02, mass=1.0, arm=0.2)
LEVEL = replace(ARM, plane='horizontal')
END = (
    ': it stays near its nominal value, within the given standard deviation, until the others are '
    'known more exactly'
)


def problem(load, **spreads):
    joint = antagonistic_joint(load=load)
    angle = simulate(joint, T, COMMAND, position=0.1).position
    recording = Recording('elbow', T, T, COMMAND, angle, muscles=NAMES, unit='rad')
    segments = tuple(segments_of([recording]))
    unknowns = (*spread_unknowns(joint, NAMES, spreads), *run_unknowns(segments, NOISE))
    row = joint.parameters().ravel()
    return Problem(segments, joint.layout, joint.library, row, unknowns, joint=joint)


def told(load, **spreads):
    with ThreadPoolExecutor(1) as pool:
        return undetermined_before(problem(load, **spreads), NOISE, pool)


def test_two_numbers_of_the_same_inertia_are_named_together():
    """Without gravity only I + m l^2 acts."""
    wanted = f'the recordings hardly distinguish inertia from mass{END}'
    assert told(LEVEL, inertia='20%', mass='50%') == (wanted,)


def test_gravity_distinguishes_a_mass_from_an_inertia():
    assert told(ARM, inertia='20%', mass='50%') == ()


def test_of_three_numbers_in_two_influences_all_are_named():
    """With gravity the influences are I + m l^2 and m l."""
    (text,) = told(ARM, inertia='20%', mass='50%', arm='50%')
    start = 'the recordings hardly distinguish inertia from '
    assert text.startswith(start)
    assert text.endswith(END)
    assert {'mass', 'arm'} == {*text[len(start) : -len(END)].split(', ')}


@pytest.mark.parametrize(
    ('load', 'spreads'), [(LEVEL, {'hanging_at': 0.1}), (ARM, {'radius': 1e-9})]
)
def test_what_has_no_influence_is_named_alone(load, spreads):
    (name,) = spreads
    assert told(load, **spreads) == (
        f'the recordings hardly determine {name}: it stays near its nominal value, within the '
        'given standard deviation',
    )


def test_the_prior_shares_a_sum_that_the_recordings_determine():
    """Two terms a and b of a known sum: the variance of each is a^2 b^2/(a^2 + b^2)."""
    given = problem(LEVEL, inertia='30%', mass='30%')
    known = initial_solution(given, np.zeros(len(given.unknowns)))
    spread = covariance(replace(known, r=np.full_like(known.r, NOISE)), WHITE)
    k = [one.name for one in given.unknowns].index('inertia')
    a, b = (log1p(0.3) * part for part in (LEVEL.inertia, LEVEL.mass * LEVEL.arm**2))
    assert np.sqrt(spread[k, k]) == pytest.approx(b / np.hypot(a, b), rel=1e-2)
    assert len(undetermined(given, spread)) == 1


def test_without_uncertain_numbers_nothing_is_simulated():
    no_start = replace(problem(LEVEL), segments=())
    with ThreadPoolExecutor(1) as pool:
        assert undetermined_before(no_start, NOISE, pool) == ()
