# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which contractions beyond the permitted ones are events."""

import numpy as np
import pytest

from pam_ros.health.health import Level
from pam_ros.health.simulator import contraction
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.contractions import CALM, MARGIN, Contractions, Excess
from pam_ros.simulator.plant import Plant

LIMITS = np.array([0.25, 0.3])
OVER = 0.25 + 2.0 * MARGIN


def plant(**given):
    given = {name.replace('__', '.'): value for name, value in given.items()}
    scene = Scene(given)
    return Plant(scene.build(checked(scene.table(), given)))


def test_an_event_has_the_largest_contraction_and_is_new_once():
    found = Contractions()
    for time, first in ((1.0, OVER), (1.1, 0.39), (1.2, 0.31)):
        found.record(time, np.array([first, 0.3]), LIMITS)
    assert found.report(1.2) == [Excess(0, pytest.approx(0.39), is_new=True)]
    assert found.report(1.5) == [Excess(0, pytest.approx(0.39), is_new=False)]
    assert found.report(1.2 + 2.0 * CALM) == []
    assert found.count == 1


def test_an_event_between_two_reports_is_reported():
    found = Contractions()
    found.record(1.0, np.array([0.1, 0.39]), LIMITS)
    assert found.report(50.0) == [Excess(1, pytest.approx(0.39), is_new=True)]
    assert found.report(51.0) == []


def test_a_load_that_swings_about_the_limit_is_one_event_and_a_later_one_another():
    found = Contractions()
    for time in np.arange(0.0, 5.0, 0.01):
        swing = 0.25 + 0.02 * np.sin(2.0 * np.pi * 1.5 * time)
        found.record(time, np.array([swing, 0.0]), LIMITS)
    assert found.count == 1
    found.record(5.0 + 2.0 * CALM, np.array([OVER, 0.0]), LIMITS)
    assert found.count == 2


def test_within_the_limit_and_its_margin_there_is_none():
    found = Contractions()
    found.record(1.0, LIMITS + 0.9 * MARGIN, LIMITS)
    found.record(1.0, LIMITS - 0.5, LIMITS)
    assert found.report(1.0) == []
    assert found.count == 0


def test_a_contraction_beyond_the_limit_is_reported_with_muscle_value_and_limit():
    rig = plant(mass=1.0, initial__pressure=600e3)
    kappa = rig.read().position[0] / rig.setup.muscles[0].l0
    assert kappa > 0.26
    health = contraction(rig, rig.contractions.report(rig.time))
    assert health.level == Level.WARN
    assert f'muscle pam contracts by {100.0 * kappa:.1f} % of its length' in health.message
    assert 'more than the 25.0 % that it permits (kappa_max)' in health.message
    assert health.values['largest contraction beyond kappa_max'] == pytest.approx(kappa)


def test_of_several_muscles_the_one_beyond_its_own_limit_is_reported():
    given = {'initial.pressure': 300e3, 'mass': 20.0, 'right.kappa_max': 0.1}
    rig = plant(muscles=('left', 'right'), **given)
    rig.read()
    found = rig.contractions.report(rig.time)
    assert [one.muscle for one in found] == [1]
    assert contraction(rig, found).message.startswith('muscle right contracts by ')


def test_a_reset_begins_without_events():
    rig = plant(mass=1.0, initial__pressure=600e3)
    rig.read()
    rig.begin()
    assert rig.contractions.report(rig.time) == []
    assert contraction(rig, []).level == Level.OK
    assert contraction(rig, []).values['times beyond kappa_max'] == 1
