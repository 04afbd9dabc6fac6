# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The muscle: its inverse and equilibrium, and what it refuses to be made of."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq

from pam_ros.errors import ParameterError, RangeError
from pam_ros.muscle import law
from pam_ros.muscle.muscle import Muscle
from support import paper

MUSCLE = Muscle()
LOAD_ONLY = dict.fromkeys(('a1', 'a2', 'a3', 'a4', 'a6'), 0.0) | {'a5': 35.0, 'zeta': 0.0}


def test_equilibrium_of_the_papers_experiment():
    kappa = MUSCLE.equilibrium(6e5, 196.2)
    assert kappa == pytest.approx(0.243, abs=5e-4)
    assert paper.force(6.0, 100 * kappa) == pytest.approx(196.2, abs=1e-9)


@given(st.floats(0.0, 6e5), st.floats(-50.0, 1500.0))
def test_equilibrium_is_the_root_that_scipy_finds(p, load):
    try:
        kappa = MUSCLE.equilibrium(p, load)
    except RangeError:
        ends = MUSCLE.force(p, np.array([-0.14, 0.5])) - load
        assert ends[0] < 0.0 or ends[1] > 0.0
        return
    found = brentq(lambda k: float(MUSCLE.force(p, k)) - load, -0.14, 0.5, xtol=1e-14)
    assert kappa == pytest.approx(found, abs=1e-11)
    assert MUSCLE.force(p, kappa) == pytest.approx(load, abs=1e-8)


def test_no_equilibrium_is_a_sentence():
    with pytest.raises(RangeError, match=r'^no equilibrium: at 0 kPa the muscle pulls '):
        MUSCLE.equilibrium(0.0, -500.0)


@given(st.floats(0.0, 1.0), st.floats(-0.04, 0.25))
def test_pressure_for_force_and_back(share, kappa):
    low, high = MUSCLE.force(np.array([0.0, 6e5]), kappa)
    wanted = low + share * (high - low)
    p = MUSCLE.pressure_for_force(wanted, kappa)
    assert 0.0 <= p <= 6e5
    assert MUSCLE.force(p, kappa) == pytest.approx(wanted, abs=1e-8)


@given(st.floats(0.0, 6e5), st.floats(-0.04, 0.25))
def test_force_for_pressure_and_back(p, kappa):
    again = MUSCLE.pressure_for_force(MUSCLE.force(p, kappa), kappa)
    assert again == pytest.approx(p, abs=1e-6)


def test_pressure_for_force_names_the_first_point_out_of_reach():
    wanted = np.array([[100.0, 200.0], [2000.0, 5000.0]])
    with pytest.raises(RangeError) as error:
        MUSCLE.pressure_for_force(wanted, 0.1)
    low, high = paper.force(0.0, 10.0), paper.force(6.0, 10.0)
    assert str(error.value) == (
        'a force of 2000 N at contraction 0.1 is out of reach: 0 to 600 kPa give '
        f'{low:.4g} to {high:.4g} N there'
    )
    with pytest.raises(RangeError, match='out of reach'):
        MUSCLE.pressure_for_force(100.0, -0.3)  # the gain is negative there


def test_methods_broadcast_and_take_lists():
    p, kappa = [0.0, 3e5, 6e5], np.array([[0.0], [0.1]])
    assert MUSCLE.force(p, kappa).shape == (2, 3)
    assert MUSCLE.stiffness(p, kappa).shape == (2, 3)
    assert MUSCLE.damping(p, kappa, 20.0).shape == (2, 3)
    assert MUSCLE.gain(kappa).shape == (2, 1)
    assert MUSCLE.damping(3e5, 0.1, 20.0) == pytest.approx(paper.damping(3.0, 10.0, 20.0, 0.15))


def test_constants_are_given_back_as_given():
    assert MUSCLE.a3 == -0.32866
    assert MUSCLE.contraction_unit == 'percent'


REFUSED = [
    ({'a3': 0.3}, 'stiffness k = .* N/m at 0 kPa and contraction 0.25; it must be positive'),
    ({'a4': 9.0}, r'stiffness k = -.* N/m at 600 kPa and contraction 0.25'),
    ({'a2': 0.0}, 'stiffness k = -?0 N/m at 0 kPa'),
    ({'a5': 100.0}, r'pressure gain dF/dp = -0.0013\d* N/Pa at 0 kPa and contraction 0.25'),
    ({'kappa_max': 0.4}, r'pressure gain dF/dp = -.* contraction 0.4'),
    ({'a3': -1e6}, r'stiffness k = .* \(are the units right\?\)'),
    ({'a3': 1e6}, 'stiffness k = -inf N/m'),
    ({'pressure_unit': 'kPa'}, 'give 1.787e.05 N at p_max = 600 kPa and contraction 0, which is'),
    ({'pressure_unit': 'Pa'}, 'far from force_max = 1500 N: correct pressure_unit, the constants'),
    ({'a5': 1.7976931348623157e308}, 'give inf N at p_max'),  # without a warning of numpy
    ({'zeta': -0.1}, '^zeta = -0.1 is not allowed: give 0 to 5$'),
    ({'l0': 0.0}, '^l0 = 0.0 is not allowed: give 0.001 to 10 m$'),
    ({'p_max': 0.0}, '^p_max = 0.0 is not allowed: give above 0 and at most 5e.06 Pa$'),
    ({'a1': float('nan')}, '^a1 = nan is not allowed: give a finite number$'),
    ({'a6': float('inf')}, '^a6 = inf is not allowed'),
    ({'p_min': 1.0}, '^p_min = 1.0 is not allowed: give -101325 to 0 Pa$'),
    ({'pressure_unit': 'psi'}, "^pressure_unit = 'psi' is not allowed: give one of Pa, kPa, bar$"),
    (LOAD_ONLY | {'zeta': 0.15}, r'^zeta = 0.15 needs a muscle with stiffness: a1, a2'),
]


@pytest.mark.parametrize(('fields', 'sentence'), REFUSED)
def test_what_makes_no_muscle_is_refused_with_a_sentence(fields, sentence):
    with pytest.raises(ParameterError, match=sentence) as error:
        Muscle(**fields)
    assert '\n' not in str(error.value)


@given(
    st.floats(-20.0, 20.0),
    st.floats(-100.0, 500.0),
    st.floats(-1.0, 0.5),
    st.floats(-20.0, 5.0),
    st.floats(100.0, 600.0),
)
def test_the_check_finds_what_a_fine_grid_finds(a1, a2, a3, a4, a5):
    constants = {'a1': a1, 'a2': a2, 'a3': a3, 'a4': a4, 'a5': a5}
    assume(a1 or a2 or a4)
    kappa = np.linspace(-4.0, 25.0, 233)
    p = np.linspace(0.0, 6.0, 49)[:, None]
    bracket = (a1 * p + a2) * a3 * np.exp(a3 * kappa) + a4 * p
    gain = a1 * np.exp(a3 * kappa) + a4 * kappa + a5
    works = np.max(bracket) < 0.0 and np.min(gain) > 0.0
    assume(not 0.0 < np.min(gain) < 1e-2)  # between two points of the grid it may dip below 0
    if works and 100.0 < a1 * 6.0 + a2 + a5 * 6.0 - 263.69185 < 4e4:
        Muscle(**constants, force_max=2000.0)
    elif not works:
        with pytest.raises(ParameterError, match='do not describe a muscle'):
            Muscle(**constants, force_max=2000.0)


def test_a_force_source_without_a_muscle():
    drive = Muscle(**LOAD_ONLY, pressure_unit='Pa', p_min=-10.0, p_max=10.0, force_max=350.0)
    assert drive.is_load_only
    np.testing.assert_array_equal(drive.force([-10.0, 0.0, 2.0], 0.1), [-350.0, 0.0, 70.0])
    assert drive.pressure_for_force(-175.0, 0.3) == -5.0
    with pytest.raises(RangeError, match='no equilibrium'):
        drive.equilibrium(1.0, 10.0)


def test_a_vacuum_widens_the_range():
    with pytest.raises(ParameterError, match='at -50 kPa and contraction'):
        Muscle(p_min=-50e3)  # shortened and evacuated, the law has no stiffness
    muscle = Muscle(p_min=-50e3, kappa_max=0.08)
    wanted = float(muscle.force(-40e3, 0.05))
    assert muscle.pressure_for_force(wanted, 0.05) == pytest.approx(-40e3)
    with pytest.raises(RangeError, match=': 0 to 600 kPa'):
        MUSCLE.pressure_for_force(wanted, 0.05)


def test_stiffest_and_softest_are_at_the_corners():
    p, kappa = np.meshgrid(np.linspace(0, 6e5, 61), np.linspace(-0.04, 0.25, 59))
    a1, a2, a3, a4, _, _ = MUSCLE.si
    k = law.stiffness_v(p, kappa, a1, a2, a3, a4, MUSCLE.l0)
    corners = k[np.ix_([0, -1], [0, -1])]
    assert k.min() == corners.min()
    assert k.max() == corners.max()


def test_there_is_no_damping_of_a_negative_mass():
    assert MUSCLE.damping(3e5, 0.1, 0.0) == 0.0
    with pytest.raises(ParameterError, match=r'^mass = -20\.0 is not allowed: give at least 0 kg'):
        MUSCLE.damping(3e5, 0.1, [20.0, -20.0])
