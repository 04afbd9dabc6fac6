# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values with units as a person types them."""

from math import pi

import pytest

from pam_ros.command.amounts import amount_of, joined
from pam_ros.errors import PamError

POSITION = ('m', 'rad')
ATMOSPHERE = 101325.0


@pytest.mark.parametrize(
    ('text', 'units', 'value', 'unit'),
    [
        ('300e3', ('Pa',), 300e3, ''),
        ('300kPa', ('Pa',), 300e3, 'Pa'),
        ('3 bar', ('Pa',), 300e3, 'Pa'),
        ('300E3Pa', ('Pa',), 300e3, 'Pa'),
        ('0.3MPa', ('Pa',), 300e3, 'Pa'),
        ('3000mbar', ('Pa',), 300e3, 'Pa'),
        ('43.5psi', ('Pa',), 43.5 * 0.45359237 * 9.80665 / 0.0254**2, 'Pa'),
        ('4bara', ('Pa',), 400e3 - ATMOSPHERE, 'Pa'),
        ('60mm', POSITION, 0.06, 'm'),
        ('-.5cm', POSITION, -0.005, 'm'),
        ('+0.06', POSITION, 0.06, ''),
        ('20deg', POSITION, pi / 9.0, 'rad'),
        ('-20°', POSITION, -pi / 9.0, 'rad'),
        ('4N m/rad', ('N m/rad',), 4.0, 'N m/rad'),
        ('4Nm/rad', ('N m/rad',), 4.0, 'N m/rad'),
        ('20ms', ('s',), 0.02, 's'),
        ('90deg/s', ('rad/s',), pi / 2.0, 'rad/s'),
    ],
)
def test_values_are_converted_to_si(text, units, value, unit):
    found = amount_of(text, units, 'value')
    assert (found.value, found.unit) == (pytest.approx(value), unit)


@pytest.mark.parametrize(
    ('text', 'units', 'words'),
    [
        ('300kpsi', ('Pa',), ["'kpsi' is not a unit", 'kPa, bar']),
        ('300mPa', ('Pa',), ["'mPa'"]),  # milli or mega: not guessed
        ('60mm', ('Pa',), ["'mm'"]),
        ('3bar', POSITION, ["'bar'", 'mm', 'deg']),
        ('kPa', ('Pa',), ['not a finite number', '300kPa']),
        ('nan', ('Pa',), ['not a finite number']),
        ('inf', POSITION, ['not a finite number', '60mm', '20deg']),
        ('1e999', ('Pa',), ['not a finite number']),
        ('0x10', ('Pa',), ["'x10'"]),
        ('', ('Pa',), ['not a finite number']),
        ('3m', (), ['a number without a unit']),
    ],
)
def test_what_is_not_a_value_in_these_units_is_refused(text, units, words):
    with pytest.raises(PamError) as error:
        amount_of(text, units, 'value')
    for word in ('value', *words):
        assert word in str(error.value)


def test_a_unit_after_a_space_belongs_to_the_number_before_it():
    assert joined(['300', 'kPa', '2bar', 'left:=3', 'bar']) == ['300kPa', '2bar', 'left:=3bar']
    assert joined(['kPa', '3']) == ['kPa', '3']
