# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Moves of a search on a joint of two muscles."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.effects import CoulombFriction, PressureLag
from pam_ros.identification.search.moves import absent_effects, with_each
from pam_ros.identification.search.search import (
    Search,
    confirm,
    free_parameters,
    share_between_muscles,
)
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.run import simulate
from pam_ros.rig.transmissions import Pulley
from support.searches import retuned_of, setting_of

pytestmark = pytest.mark.needs_numba
PRESLIDING = 4e-3  # rad
NAMES = ('flexor', 'extensor')
T = np.arange(0.0, 16.0, 0.02)
COMMAND = 1e3 * np.stack(
    [
        260.0 + 80.0 * np.sign(np.sin(1.3 * T)) + 40.0 * np.sin(3.0 * T),
        250.0 - 60.0 * np.sign(np.sin(0.9 * T)) - 50.0 * np.cos(2.0 * T),
    ],
    axis=1,
)
LAG = [PressureLag(fill=0.05, vent=0.07)]


def elbow(first, second, on_joint=()):
    muscles = tuple(Actuator(effects=effects, contraction=0.1) for effects in (first, second))
    return Joint(muscles, Arm(mass=1.0, arm=0.25), Pulley(radius=0.04), effects=on_joint)


def search_on(joint, pool):
    """Return a search on 16 s of *joint*, whose nominal model has no effects, after re-tuning."""
    noise = np.random.default_rng(5).normal(0.0, 2e-4, T.size)
    angle = simulate(joint, T, COMMAND).position + noise
    recording = Recording('elbow', T, T, COMMAND, angle, muscles=NAMES, unit='rad')
    setting = setting_of([recording], pool, elbow((), ()), muscles=NAMES)
    retuned = retuned_of(setting)
    return Search(setting, retuned, retuned, [retuned])


@pytest.fixture(scope='module')
def in_both(pool):
    return search_on(elbow(LAG, LAG), pool)


def with_lag(found, muscles):
    now = found.retuned
    for muscle in muscles:
        now = with_each(now, [f'{muscle}.pressure_lag'], found.setting)[0]
    return now


def test_an_effect_that_each_muscle_has_alone_becomes_one_of_all(in_both):
    now = with_lag(in_both, NAMES)
    assert now.effects == ('flexor.pressure_lag', 'extensor.pressure_lag')
    alike = share_between_muscles(now, in_both)
    assert alike.effects == ('pressure_lag',)
    assert alike.errors.fit < 1.03 * now.errors.fit
    assert alike.solution.value('effects.pressure_lag.fill') == pytest.approx(0.05, rel=0.05)


def test_an_effect_of_one_muscle_stays_there(in_both):
    (now,) = with_each(in_both.retuned, ['flexor.dead_time'], in_both.setting)
    assert share_between_muscles(now, in_both) is now
    names = absent_effects(now, in_both.setting)
    assert 'extensor.dead_time' in names
    assert 'dead_time' not in names
    assert 'flexor.dead_time' not in names


def test_finer_steps_free_a_parameter_that_long_steps_hide(pool):
    """A step of 20 ms makes the contact longer than it is before it slides."""
    rig = elbow((), (), [CoulombFriction(level=0.8, presliding=PRESLIDING)])
    name = 'effects.coulomb_friction.presliding'
    found = search_on(rig, pool)
    noise = found.setting.noise
    (coarse,) = with_each(found.retuned, ['coulomb_friction'], found.setting)
    now = free_parameters(coarse, found)
    assert name not in {unknown.name for unknown in now.solution.problem.unknowns}
    assert now.errors.fit > 5.0 * noise
    best = confirm(replace(found, best=now))
    assert best.effects == now.effects
    assert best.solution.problem.step < now.solution.problem.step
    assert best.solution.value(name) == pytest.approx(PRESLIDING, rel=0.05)
    assert best.errors.fit < 1.1 * noise
