# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Units of the constants: any unit, one force."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.muscle import law
from pam_ros.muscle.constants import CONTRACTION_UNITS, PRESSURE_UNITS, from_si, to_si
from pam_ros.muscle.muscle import Muscle

units = st.tuples(
    st.sampled_from(sorted(PRESSURE_UNITS)), st.sampled_from(sorted(CONTRACTION_UNITS))
)
number = st.floats(1e-30, 1e6) | st.floats(-1e6, -1e-30) | st.just(0.0)
six = st.tuples(number, number, number, number, number, number)
PRINTED = (-4.35573, 281.22370, -0.32866, -9.27035, 302.20107, -263.69185)


def test_bar_and_percent_convert_as_published():
    # a1 1e-5, a2, a3 100, a4 1e-5 100, a5 1e-5, a6
    expected = (-4.35573e-5, 281.22370, -32.866, -9.27035e-3, 302.20107e-5, -263.69185)
    assert to_si(PRINTED, 'bar', 'percent') == pytest.approx(expected, rel=1e-15)
    assert to_si(PRINTED, 'Pa', 'fraction') == PRINTED


@given(six, units)
def test_round_trips_are_exact_to_the_last_digit(constants, unit):
    for there, back in [(to_si, from_si), (from_si, to_si)]:
        found = back(there(constants, *unit), *unit)
        np.testing.assert_array_almost_equal_nulp(np.array(found), np.array(constants), nulp=2)


@given(units, st.floats(0.0, 6e5), st.floats(-0.04, 0.3))
def test_the_force_is_the_same_in_all_units(unit, p, kappa):
    si = to_si(PRINTED, 'bar', 'percent')
    mine = from_si(si, *unit)
    in_unit = law.force_v(p / PRESSURE_UNITS[unit[0]], kappa / CONTRACTION_UNITS[unit[1]], *mine)
    assert in_unit == pytest.approx(law.force_v(p, kappa, *si), abs=1e-9)
    # And so is that of a muscle which is given them; it gives them back as they were given.
    names = ('a1', 'a2', 'a3', 'a4', 'a5', 'a6')
    muscle = Muscle(
        **dict(zip(names, mine, strict=True)), pressure_unit=unit[0], contraction_unit=unit[1]
    )
    assert muscle.force(p, kappa) == pytest.approx(in_unit, abs=1e-9)
    assert tuple(getattr(muscle, name) for name in names) == mine


@pytest.mark.parametrize(
    ('units', 'sentence'),
    [
        (('psi', 'percent'), "pressure_unit = 'psi' is not known: give one of Pa, kPa, bar"),
        (('bar', 'mm'), "contraction_unit = 'mm' is not known: give one of fraction, percent"),
    ],
)
def test_unknown_units_are_refused_with_a_sentence(units, sentence):
    with pytest.raises(ParameterError) as error:
        to_si(PRINTED, *units)
    assert str(error.value) == sentence
