# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fitted numbers become models and values in their source's units."""

from dataclasses import replace

import numpy as np
import pytest

from pam_ros.identification.data.segment import segments_of
from pam_ros.identification.fit.extend import with_effect
from pam_ros.identification.fit.places import places_of
from pam_ros.identification.fit.problem import Problem
from pam_ros.identification.fit.unknowns import SPECIMEN, nominal_unknowns, proper
from pam_ros.identification.source_units import in_source_units, with_row
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from support.by_name import by_name

BAR = single_muscle_joint(Muscle(), Mass(mass=20.0))
# The same muscle in other units: p in Pa, contraction as a fraction, by hand.
SI = single_muscle_joint(
    replace(
        BAR.muscle,
        a1=-4.35573e-5, a2=281.22370, a3=-32.866, a4=-9.27035e-3, a5=302.20107e-5, a6=-263.69185,
        pressure_unit='Pa', contraction_unit='fraction',
    ),
    Mass(mass=20.0),
)  # fmt: skip
FACTORS = {'a1': 1e5, 'a2': 1.0, 'a3': 1e-2, 'a4': 1e3, 'a5': 1e5, 'a6': 1.0, 'zeta': 1.0}


def problem_of(model):
    """Return the problem of re-tuning a model to runs at three lengths."""
    t = np.arange(60) / 50.0
    pressure, force = np.linspace(1.5e5, 5e5, t.size), np.full(t.size, 300.0)
    runs = [
        Recording('h', t, None, None, np.full(t.size, kappa * 0.4), None, force, pressure, 'held')
        for kappa in (0.02, 0.1, 0.18)
    ]
    return Problem(
        tuple(segments_of(runs)),
        model.layout,
        model.active,
        model.parameters().ravel(),
        tuple(map(proper, nominal_unknowns(model))),
    )


def model_at(model, problem, u, effects=()):
    places = [places_of(model)[name] for name in effects]
    back, problem = with_row(model, problem.row_at(u), problem.segments, places, {})
    assert problem == ''
    return back


def test_the_configured_model_comes_back():
    problem = problem_of(BAR)
    back = model_at(BAR, problem, np.zeros(len(problem.unknowns)))
    assert back.muscle.pressure_unit == 'bar'
    for name in ('a1', 'a2', 'a3', 'a4', 'a5', 'a6', 'zeta', 'l0', 'kappa_max', 'p_max'):
        assert getattr(back.muscle, name) == pytest.approx(getattr(BAR.muscle, name), rel=1e-12)
    assert back.load == BAR.load
    assert back.all_effects == ()


@pytest.mark.parametrize('model', [BAR, SI], ids=['bar', 'Pa'])
def test_a_fitted_model_is_the_row_that_was_fitted(model):
    problem = problem_of(model)
    u = np.random.default_rng(1).uniform(-0.7, 0.7, len(problem.unknowns))
    back = model_at(model, problem, u)
    np.testing.assert_allclose(back.parameters().ravel(), problem.row_at(u), rtol=1e-12)
    assert back.muscle.contraction_unit == model.muscle.contraction_unit


def test_effects_of_the_model_hold_what_was_fitted():
    problem = problem_of(BAR)
    friction = next(e for e in BAR.library if e.name == 'coulomb_friction')
    wider, added = with_effect(
        problem, BAR, places_of(BAR)['coulomb_friction'], {'level': 7.0, 'asymmetry': 0.1}
    )
    back = model_at(BAR, wider, np.append(np.zeros(7), added), ['coulomb_friction'])
    values = by_name(back.all_effects)['coulomb_friction'].values
    assert (values['level'], values['asymmetry']) == pytest.approx((7.0, 0.1))
    defaults = {p.name: p.default for p in friction.parameters()}
    assert values['presliding'] == defaults['presliding']
    row = wider.row_at(np.append(np.zeros(7), added))
    np.testing.assert_allclose(back.parameters().ravel(), row)


def row_with(problem, **constants):
    """Return the parameter row of a fit that changed these constants, in units of their prior."""
    names = [unknown.name for unknown in problem.unknowns]
    u = np.zeros(len(names))
    for name, value in constants.items():
        u[names.index(name)] = value
    return problem.row_at(u)


def test_constants_that_make_no_muscle_beyond_keep_their_values_in_the_recorded_range():
    problem = problem_of(BAR)
    row = row_with(problem, a4=-0.5 / SPECIMEN)  # no pressure gain beyond it
    back, reason = with_row(BAR, row, problem.segments, [], {})
    assert reason == ''
    np.testing.assert_allclose(back.parameters().ravel(), row, rtol=1e-12)
    assert back.muscle.kappa_max == pytest.approx(0.18)
    assert BAR.muscle.kappa_max > 0.2


def test_constants_that_make_no_muscle_anywhere_are_said_to_be_invalid():
    problem = problem_of(BAR)
    row = row_with(problem, a4=1.5 / SPECIMEN)  # the stiffness turns negative
    assert row[BAR.layout.constant(at.A4)] > 0.0
    back, reason = with_row(BAR, row, problem.segments, [], {})
    assert 'stiffness' in reason
    # What drawings need is valid.
    assert np.all(np.isfinite(back.parameters().ravel()))
    assert back.muscle.stiffness(3e5, 0.1) > 0.0


def test_constants_are_reported_in_the_units_of_their_source():
    bar, si = (
        {
            unknown.name: in_source_units(
                unknown, [unknown.value(x) for x in (-0.1, 0.0, 0.2)], model, False
            )
            for unknown in problem_of(model).unknowns
        }
        for model in (BAR, SI)
    )
    assert list(bar) == list(FACTORS)
    for name, factor in FACTORS.items():
        for part in ('value', 'low', 'high'):
            mine, theirs = getattr(bar[name], part), getattr(si[name], part)
            assert mine == pytest.approx(factor * theirs, rel=1e-6)
        assert bar[name].low < bar[name].value < bar[name].high
        assert not bar[name].at_bound
    units = [bar[name].unit for name in FACTORS]
    assert units == ['N/bar', 'N', '1/percent', 'N/(bar percent)', 'N/bar', 'N', '']
    assert (si['a3'].unit, si['a4'].unit) == ('1/fraction', 'N/(Pa fraction)')


def test_a_parameter_of_an_effect_has_the_unit_that_the_effect_declares():
    viscous = places_of(BAR)['viscous_friction']
    problem, _ = with_effect(problem_of(BAR), BAR, viscous, {'coefficient': 30.0})
    found = in_source_units(problem.unknowns[-1], [0.0, 0.0, 3.0], BAR, True)
    assert (found.value, found.low, found.high, found.unit) == (0.0, 0.0, 3.0, 'N s/m')
    assert found.at_bound
