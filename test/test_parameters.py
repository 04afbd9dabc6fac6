# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Described parameters: what passes, what is refused, and the sentence that says so."""

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.errors import ParameterError
from pam_ros.parameters import Parameter, check_all, described, parameter_field

bound = st.none() | st.floats(-1e9, 1e9)


@dataclass(frozen=True)
class Simulation:
    mass: float = parameter_field(20.0, 'mass', 'kg', low=0.0, high=100.0, above_low=True)
    mount: str = parameter_field('up', 'mount', choices=('up', 'down'), live=False)
    count: int = parameter_field(2, 'count', low=1, high=9)
    loud: bool = parameter_field(False, 'whether')
    undescribed: float = 1.0

    def __post_init__(self):
        check_all(self)


@given(bound, bound, st.booleans(), st.floats() | st.integers())
def test_a_number_passes_exactly_when_it_is_finite_and_in_range(low, high, above, value):
    try:
        finite = math.isfinite(value)
    except OverflowError:
        finite = False
    fits = (
        finite
        and (low is None or value > low or (value == low and not above))
        and (high is None or value <= high)
    )
    about = Parameter('text', 'm', low=low, high=high, above_low=above)
    if fits:
        found = about.check('x', value, float)
        assert type(found) is float
        assert found == float(value)
    else:
        with pytest.raises(ParameterError, match=r'^x = .* is not allowed: give '):
            about.check('x', value, float)


@given(st.integers(-(2**40), 2**40))
def test_a_whole_number_passes_in_any_form(value):
    about = Parameter('text')
    for form in (value, float(value), np.int64(value), np.float64(value)):
        found = about.check('n', form, int)
        assert type(found) is int
        assert found == value


@pytest.mark.slow
@given(st.text() | st.none() | st.booleans() | st.lists(st.floats()) | st.complex_numbers())
def test_what_is_no_number_is_refused(value):
    for kind in (int, float):
        with pytest.raises(ParameterError, match='is not allowed'):
            Parameter('text').check('x', value, kind)


SENTENCES = [
    ({'mass': 0.0}, 'mass = 0.0 is not allowed: give above 0 and at most 100 kg'),
    ({'mass': 'big'}, "mass = 'big' is not allowed: give a number, above 0 and at most 100 kg"),
    ({'mass': True}, 'mass = True is not allowed: give a number, above 0 and at most 100 kg'),
    ({'mount': 'left'}, "mount = 'left' is not allowed: give one of up, down"),
    ({'mount': 3.0}, 'mount = 3.0 is not allowed: give one of up, down'),
    ({'count': 2.5}, 'count = 2.5 is not allowed: give a whole number, 1 to 9'),
    ({'count': math.inf}, 'count = inf is not allowed: give a whole number, 1 to 9'),
    ({'count': 10}, 'count = 10 is not allowed: give a whole number, 1 to 9'),
    ({'loud': 1}, 'loud = 1 is not allowed: give true or false'),
]


@pytest.mark.parametrize(('fields', 'sentence'), SENTENCES)
def test_refusals_name_the_thing_its_value_and_what_is_allowed(fields, sentence):
    with pytest.raises(ParameterError) as error:
        Simulation(**fields)
    assert str(error.value) == sentence


@pytest.mark.parametrize(
    ('about', 'kind', 'allowed'),
    [
        (Parameter(''), float, 'a finite number'),
        (Parameter(''), int, 'a whole number'),
        (Parameter(''), str, 'a text'),
        (Parameter('', 's', low=1.5), float, 'at least 1.5 s'),
        (Parameter('', 's', low=1.5, above_low=True), float, 'above 1.5 s'),
        (Parameter('', 's', high=2.0), float, 'at most 2 s'),
        (Parameter('', '', low=-1.0, high=2.0), float, '-1 to 2'),
    ],
)
def test_what_is_allowed_in_words(about, kind, allowed):
    assert about.allowed(kind) == allowed


def test_values_are_normalised_to_their_type():
    rig = Simulation(mass=5, count=3.0)
    assert (type(rig.mass), type(rig.count)) == (float, int)
    assert Simulation(mass=Fraction(1, 4)).mass == 0.25
    assert Simulation(mass=np.float32(0.5)).mass == 0.5
    with pytest.raises(ParameterError):
        Simulation(mass=10**400)


def test_described_lists_the_described_fields():
    table = described(Simulation)
    assert list(table) == ['mass', 'mount', 'count', 'loud']
    kind, default, about = table['mount']
    assert (kind, default, about.live, about.choices) == (str, 'up', False, ('up', 'down'))
    assert table['mass'][2].unit == 'kg'


def test_a_list_of_texts_is_a_tuple_of_them():
    names = Parameter('names')
    assert names.check('names', ['a', 'b'], tuple) == ('a', 'b')
    assert names.check('names', [], tuple) == ()
    for bad in ('ab', ['a', 1], None, 3.0):
        with pytest.raises(ParameterError, match='give a list of texts'):
            names.check('names', bad, tuple)
