# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values of parameters from texts, and names that do not exist."""

import pytest

from pam_ros.command.parameter_values import refuse_unknown, value_of
from pam_ros.errors import PamError


@pytest.mark.parametrize(
    ('text', 'kind', 'is_list', 'description', 'value'),
    [
        ('4', float, False, 'friction [N]', 4.0),
        ('4kN', float, False, 'friction [N]', 4000.0),
        ('12kg', float, False, 'mass of the load [kg]', 12.0),
        ('20ms', float, False, 'lag [s]', 0.02),
        ('0.1', float, False, 'damping ratio', 0.1),
        ('2', int, False, 'periods', 2),
        ('1e3', int, False, 'periods', 1000),
        ('True', bool, False, 'switch', True),
        ('3', str, False, 'name', '3'),
        ('[a, b]', str, True, 'names', ['a', 'b']),
        ('1,2.5', float, True, 'lengths [m]', [1.0, 2.5]),
    ],
)
def test_a_value_has_the_type_and_unit_of_its_parameter(text, kind, is_list, description, value):
    found = value_of('name', text, kind, description, is_list=is_list)
    assert found == pytest.approx(value) if kind is float else found == value
    assert isinstance(found, list if is_list else kind)


@pytest.mark.parametrize(
    ('text', 'kind', 'description'),
    [
        ('4mm', float, 'friction [N]'),
        ('4N', float, 'damping ratio'),
        ('much', float, 'friction [N]'),
        ('2.5', int, 'periods'),
        ('yes', bool, 'switch'),
    ],
)
def test_a_value_of_another_type_or_unit_is_refused(text, kind, description):
    with pytest.raises(PamError, match=f'level.*{text}'):
        value_of('level', text, kind, description)


def test_a_name_that_does_not_exist_is_named_with_a_similar_one():
    known = ['mass', 'mount', 'effects.creep.gain']
    assert 'was effects.creep.gain meant' in str(refuse_unknown('effects.crep.gain', known, '/a'))
    assert 'pam_command list' in str(refuse_unknown('nonsense', known, '/a'))
