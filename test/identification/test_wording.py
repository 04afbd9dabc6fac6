# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers in words, against what a person would write."""

import math

import pytest

from pam_ros.identification.wording import (
    interval,
    listed,
    number,
    percent,
    probability,
    scale_for,
    spoken,
    time_span,
)


@pytest.mark.parametrize(
    ('value', 'digits', 'text'),
    [
        (0.0, 3, '0'),
        (1234.567, 3, '1235'),
        (99999.0, 3, '1·10⁵'),
        (12.345, 3, '12.3'),
        (-0.05, 3, '−0.0500'),
        (0.000123456, 3, '1.23·10⁻⁴'),
        (2.0e-7, 3, '2·10⁻⁷'),
        (9.999, 3, '10.0'),
        (0.0009999, 2, '0.0010'),
        (math.nan, 3, '–'),
        (None, 3, '–'),
        (-math.inf, 3, '−∞'),
    ],
)
def test_number_has_its_significant_digits(value, digits, text):
    assert number(value, digits) == text


@pytest.mark.parametrize(
    ('low', 'high', 'text'),
    [
        (13.96, 14.01, '13.96 to 14.01'),
        (303.36, 303.58, '303.36 to 303.58'),
        (-0.1, 0.2, '−0.100 to 0.200'),
        (1.0, 1.0, '1.00 to 1.00'),
        (0.0, math.inf, '0 to ∞'),
    ],
)
def test_interval_has_digits_that_tell_its_ends_apart(low, high, text):
    assert interval(low, high) == text


@pytest.mark.parametrize(
    ('low', 'high', 'text'),
    [
        (0.0, 0.0, 'less than a minute'),
        (20.0, 60.0, 'less than a minute'),
        (4.0, 70.0, 'up to 2 min'),
        (23.0, 70.0, '25 s to 2 min'),
        (60.0, 240.0, '1 to 4 min'),
        (119.0, 121.0, 'about 2 min'),
        (170.0, 190.0, '2 to 4 min'),
        (650.0, 1870.0, '10 to 30 min'),
        (650.0, 690.0, 'about 10 min'),
        (3000.0, 7100.0, '50 to 120 min'),
        (1800.0, 7300.0, '30 min to 2 h'),
        (30.0, 7300.0, '30 s to 2 h'),
        (9000.0, 90000.0, '2 to 25 h'),
    ],
)
def test_a_time_span_has_few_digits(low, high, text):
    assert time_span(low, high) == text


def test_scales_keep_the_value():
    for unit, size, expected in (('m', 0.003, 'mm'), ('m', 2e-6, 'µm'), ('Pa', 2e5, 'kPa')):
        scale = scale_for(unit, size)
        assert scale.unit == expected
        assert {'mm': 1e3, 'µm': 1e6, 'kPa': 1e-3}[expected] == scale.factor
    assert scale_for('N', 3.0).text(3.0) == '3.00'


def test_small_words():
    assert probability(1e-7) == '< 0.0001'
    assert probability(0.0312) == '0.031'
    assert percent(0.5) == '50 %'
    assert percent(-0.0123) == '−1.2 %'
    assert percent(math.nan) == '–'
    assert listed([]) == ''
    assert listed(['a']) == 'a'
    assert listed(['a', 'b', 'c']) == 'a, b and c'
    names = ['dead_time', 'creep']
    assert spoken('dead_time and t_s', names) == 'dead time and t_s'
