# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An effect that contains a simpler one moves a load as this one does, at its limit."""

import numpy as np
import pytest

from pam_ros.effects import EFFECTS, Hysteresis, Leak
from pam_ros.rig.run import simulate
from support import bench

EFFECT = {effect.name: effect for effect in EFFECTS}
T = np.linspace(0.0, 2.0, 201)
AT = np.array([0.0, 0.1, 0.6, 1.1003, 1.5])
U = np.array([2e5, 3.3e5, 1.6e5, 2.6e5, 2.0e5])
# Each almost without the property that the simpler effect lacks, and the share of what the simpler
# effect does by which they may differ. The shortest width of a hysteresis is 0.05 %.
AT_THE_LIMIT = {
    ('leak', 'pressure_lag'): (
        Leak(rate=1e-9, refill=0.04, vent=0.07, supply=1e6, exhaust=8e5),
        1e-6,
    ),
    ('hysteresis', 'coulomb_friction'): (Hysteresis(amplitude=8.0, width=5e-4), 0.15),
}


def moved(*effects):
    return simulate(bench.hanging(*effects), T, U, AT).position


def test_every_effect_that_shares_parameters_with_a_simpler_one_is_compared_with_it():
    shared = {
        (effect.name, simple)
        for effect in EFFECTS
        for simple, names in effect.contains.items()
        if names
    }
    assert set(AT_THE_LIMIT) == shared


@pytest.mark.parametrize('pair', AT_THE_LIMIT, ids='+'.join)
def test_at_its_limit_a_broader_effect_moves_a_load_as_the_simpler_one(pair):
    broad, share = AT_THE_LIMIT[pair]
    name, simple = pair
    names = EFFECT[name].contains[simple]
    same = EFFECT[simple](**{own: getattr(broad, other) for own, other in names.items()})
    does = np.abs(moved(same) - moved()).max()
    assert does > 1e-3
    assert np.abs(moved(broad) - moved(same)).max() <= share * does
