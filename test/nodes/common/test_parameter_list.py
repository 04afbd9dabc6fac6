# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``--parameters``: the parameters of a program as text, without the command line of ROS."""

import pytest
import yaml

from pam_ros.settings.scene import Scene
from support.harness import Program

pytestmark = [pytest.mark.at_any_pace, pytest.mark.usefixtures('domain')]

DEPTH = 'qos_overrides./force.publisher.depth'


def listed(name, *words, **given):
    """Return exit code and output of a program that lists its parameters."""
    with Program(name, *parameters_of(given), '--', '--parameters', *words) as program:
        return program.wait(), program.output


def parameters_of(given):
    return [word for name, value in given.items() for word in ('-p', f'{name}:={value}')]


def entries(output):
    """Return name -> (value, description); the first line of each is read as YAML."""
    found, name = {}, ''
    for line in output.splitlines():
        if line.startswith(' '):
            found[name] = found[name][0], line.strip()
        else:
            ((name, value),) = yaml.safe_load(line).items()
            found[name] = value, ''
    return found


def test_each_parameter_is_listed_with_value_description_unit_and_range():
    code, output = listed('pam_sim')
    assert code == 0
    found, table = entries(output), Scene({}).table()
    assert table.keys() <= found.keys()
    for name, (kind, default, about) in table.items():
        value, text = found[name]
        assert kind(value) == default
        assert text.startswith(about.text)
        assert not about.unit or f'[{about.unit}]' in text
        assert ('only at the start' in text) is not about.live
    assert not any('qos_overrides' in name for name in found)
    assert found['mass'] == (20.0, 'mass of the load [kg]; above 0 and at most 10000 kg')


@pytest.mark.parametrize(
    ('name', 'given', 'part'),
    [
        ('pam_sim', {'joint': 'crank', 'crank': 0.06}, 'crank'),
        ('pam_control', {'joint': 'crank', 'crank': 0.06}, 'crank'),
        ('pam_excite', {'pressure_max': 3.5e5}, 'pressure_max'),
        ('pam_sim', {DEPTH: 7}, DEPTH),
    ],
)
def test_a_part_of_the_names_selects_them_and_values_are_those_that_are_given(name, given, part):
    code, output = listed(name, part, **given)
    assert code == 0
    found = entries(output)
    assert found[part][0] == given[part]
    assert all(part in other for other in found)


def test_what_is_not_possible_is_one_sentence():
    code, output = listed('pam_sim', 'weight')
    assert (code, output.count('\n')) == (2, 1)
    assert "no parameter of pam_sim has 'weight' in its name" in output
    code, output = listed('pam_sim', mass=-1.0)
    assert (code, output.count('\n')) == (2, 1)
    assert 'mass = -1.0 is not allowed' in output


def test_running_programs_do_not_notice_it(peer):
    """A controller would take it for another simulator, and wait."""
    seen = set()
    with Program('pam_sim', '--', '--parameters') as program:
        while program.is_running:
            seen.update(peer.node.get_node_names())
            peer.work(0.01)
        assert program.wait() == 0
    assert not any('pam_sim' in name for name in seen)
