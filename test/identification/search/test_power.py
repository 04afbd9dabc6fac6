# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What recordings could have shown: closed forms on a cylinder that a machine moves."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pam_ros.effects import EFFECTS
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.power import hidden, power, reference
from pam_ros.settings.nominal import nominal_joint
from support import moved_cylinders
from support.searches import retuned_of, setting_of

pytestmark = [pytest.mark.slow, pytest.mark.needs_numba]
ROOT = Path(__file__).parents[3]
EFFECT = {effect.name: effect for effect in EFFECTS}


@pytest.fixture(scope='module')
def retuned(pool):
    """Return the re-tuned model of a cylinder without friction at 3 bar."""
    cylinder = nominal_joint(ROOT / 'config' / 'rigs' / 'cylinder_25mm.yaml').joint
    return retuned_of(setting_of([moved_cylinders.recording(3.0)], pool, cylinder))


def power_of(name, model):
    return power(reference(model, model.setting), model.setting.places[name])


def test_power_is_what_an_effect_changes_over_the_noise(retuned):
    """30 N s/m: the sum of (c v)^2 over the variance of the noise, re-tuning has no part in it."""
    (segment,) = retuned.solution.problem.segments
    _, v = moved_cylinders.to_and_fro(segment.t)
    expected = np.sum((30.0 * v[segment.fit]) ** 2) / moved_cylinders.NOISE**2
    found = power_of('viscous_friction', retuned)
    assert found == pytest.approx(expected, rel=0.1)
    assert found > 10.0 * CRITERIA.margin


def test_what_retuning_makes_up_for_has_no_power(retuned):
    """At one pressure an offset of it is a change of the area, as far as that may change."""
    found = power_of('pressure_offset', retuned)
    # Most of its starts changes 300 kPa by 1 kPa and 3 %, and the prior of the area is 3 %.
    assert found == pytest.approx((10.0 / 9.0) ** 2, rel=1e-2)
    assert found < CRITERIA.margin


def test_long_steps_change_the_run_and_not_the_noise(retuned):
    """A model confirmed with fine steps has the noise of these, and powers in units of it."""
    setting, known = retuned.setting, retuned.solution
    problem = replace(known.problem, step=setting.step / BUDGET.finer)
    # Long steps would be a model error here: with fine steps, half of the residuals are left.
    fine = setting.model((), replace(known, problem=problem, r=0.5 * known.r))
    base = reference(fine, setting)
    assert base.problem.step == setting.step
    np.testing.assert_array_equal(base.r, known.r)
    expected = 4.0 * power_of('viscous_friction', retuned)
    assert power_of('viscous_friction', fine) == pytest.approx(expected, rel=1e-2)
    assert set(hidden(fine, ['viscous_friction', 'payload'], setting)) == {'payload'}


def test_what_nothing_excites_is_hidden_and_the_experiment_named(retuned):
    names = ['dead_time', 'pressure_lag', 'payload', 'end_stop', 'coulomb_friction']
    found = hidden(retuned, names, retuned.setting)
    assert set(found) == {'dead_time', 'pressure_lag', 'payload', 'end_stop'}
    for name, reason in found.items():
        assert reason.startswith('these data cannot show it: ')
        assert reason.endswith(f'record: {EFFECT[name].experiment}')
    assert 'would lower the score by only 0.0' in found['dead_time']
    assert 'a machine prescribes the position; with a free load' in found['payload']


@pytest.mark.parametrize(
    ('name', 'reason'),
    [
        ('supply', 'the pressures are measured behind the reservoir; record commands to a free'),
        ('end_stop', 'it acts on a load that moves freely'),
    ],
)
def test_why_a_machine_that_prescribes_the_position_hides_an_effect(retuned, name, reason):
    assert reason in hidden(retuned, [name], retuned.setting)[name]
