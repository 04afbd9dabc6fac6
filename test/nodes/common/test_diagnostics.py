# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How values are written on ``/diagnostics``."""

import numpy as np
import pytest

from pam_ros.control.loop import Loop
from pam_ros.control.plausibility import Plausibility, bounds_of
from pam_ros.control.signals import Reference
from pam_ros.health.controller import Received, control
from pam_ros.nodes.common.diagnostics import text
from pam_ros.settings.control import settings_of
from pam_ros.settings.tables import checked


@pytest.mark.parametrize(
    ('value', 'shown'),
    [
        (None, ''),
        (True, 'True'),
        (3, '3'),
        (np.int64(3), '3'),
        ('held', 'held'),
        (417164.589, '417165'),
        (np.float64(417164.589), '417165'),
        ((417164.589, np.float64(0.25)), '(417165, 0.25)'),
    ],
)
def test_numbers_have_six_digits_alone_and_among_others(value, shown):
    assert text(value) == shown


@pytest.mark.parametrize('effect', [{}, {'effects.coulomb_friction.level': 0.5}])
@pytest.mark.parametrize('kind', ['load', 'antagonistic', 'parallel', 'lever'])
def test_no_value_of_a_controller_names_the_type_of_a_number(kind, effect):
    given = {'joint': kind, **effect}
    table, build = settings_of(given)
    setup = build(checked(table, given))
    law = setup.law.make_law()
    loop = Loop(
        law, setup.law.make_reference_source(), 0.002, Plausibility(bounds_of(law.allocation))
    )
    loop.pressures = loop.law.update(0.002, Reference(0.01, velocity=0.5), 0.01)
    health = control(loop, setup, Received(), '')
    shown = [text(value) for value in health.values.values()]
    assert not [one for one in shown if 'np.' in one or 'float' in one]
