# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the log of a simulator has about effects that begin to act."""

from pam_ros.health.onsets import Onsets
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.plant import Plant

LEAK = {'effects.leak.rate': 0.1, 'effects.leak.onset': 2.0}
PAIR = {
    'joint': 'antagonistic',
    'muscles': ('front', 'back'),
    'joint_name': 'elbow',
    'back.effects.leak.rate': 0.1,
    'back.effects.leak.onset': 2.0,
    'effects.viscous_friction.coefficient': 0.1,
    'effects.viscous_friction.onset': 1.0,
}


class Log(list):
    info = list.append


def setup_of(given):
    scene = Scene(given)
    return scene.build(checked(scene.table(), given))


def looks(plant, log, at):
    onsets = Onsets(log, plant)
    for second in at:
        plant.advance(1000 * second)
        onsets.look()
    return onsets


def test_each_has_one_line_when_it_has_begun():
    log = Log()
    looks(Plant(setup_of(LEAK)), log, [1])
    assert log == []
    looks(Plant(setup_of(LEAK)), log, [1, 2, 3])
    assert log == ['effects.leak acts from 2 s of simulated time on']


def test_of_several_muscles_the_place_of_the_effect_is_reported():
    log = Log()
    looks(Plant(setup_of(PAIR)), log, [3])
    assert log == [
        'elbow.effects.viscous_friction acts from 1 s of simulated time on',
        'back.effects.leak acts from 2 s of simulated time on',
    ]


def test_after_a_reset_it_begins_again():
    log, plant = Log(), Plant(setup_of(LEAK))
    onsets = looks(plant, log, [3])
    plant.begin()
    for second in (1, 2):
        plant.advance(1000 * second)
        onsets.look()
    assert log == ['effects.leak acts from 2 s of simulated time on'] * 2


def test_effects_that_always_act_have_no_line():
    log = Log()
    looks(Plant(setup_of({'effects.leak.rate': 0.1})), log, [1])
    assert log == []
