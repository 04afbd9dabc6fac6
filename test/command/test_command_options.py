# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The command line of ``pam_command``."""

import argparse

import pytest

from pam_ros.command.absence import absent, in_another_namespace
from pam_ros.command.options import add_arguments, checked
from pam_ros.errors import PamError


def options(*words):
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    return checked(parser.parse_args(words))


def test_pressures_are_given_in_order_or_by_name():
    found = options('pressure', '300', 'kPa', '2bar', '--hold', '3').pressures
    assert [(name, one.value) for name, one in found] == [('', 300e3), ('', 200e3)]
    found = options('pressure', 'left:=3bar', 'right:=0').pressures
    assert [(name, one.value) for name, one in found] == [('left', 300e3), ('right', 0.0)]


def test_parameters_are_given_as_pairs_in_two_forms():
    found = options('set', 'mass', '12', 'zeta:=0.1', 'muscles', '[a,b]', '--node', 'pam_sim')
    assert found.pairs == (('mass', '12'), ('zeta', '0.1'), ('muscles', '[a,b]'))
    assert found.node == 'pam_sim'


def test_other_actions():
    assert options('position', '20deg').amount.unit == 'rad'
    assert options('position', '60', 'mm').amount.value == pytest.approx(0.06)
    assert options('stiffness', '4').amount.value == 4.0
    assert options('get', 'a', 'b').names == ('a', 'b')
    assert options('list').names == ('',)
    assert options('call', 'pause', 'true').switch is True
    assert options('call', 'reset', '--wait', '2').wait == 2.0


@pytest.mark.parametrize(
    ('line', 'word'),
    [
        ('pressure left:=1bar 2bar', 'name all or none'),
        ('pressure left:=1bar left:=2bar', 'left is given twice'),
        ('pressure a/b:=1bar', 'MUSCLE:=VALUE'),
        ('pressure 1bar --hold nan', '--hold nan'),
        ('pressure 1bar --wait -1', '--wait -1'),
        ('position 1furlong', 'furlong'),
        ('set mass', 'mass has no value'),
        ('set mass zeta:=1', 'mass has no value'),
        ('set mass:=', 'sets nothing'),
        ('set mass 1 mass:=2', 'mass is given twice'),
    ],
)
def test_what_is_wrong_is_named(line, word):
    with pytest.raises(PamError, match=word):
        options(*line.split())


def test_what_is_found_instead_is_named():
    names = ['/arm/pam_sim', '/talker']
    alike = in_another_namespace('/pam_sim', names)
    sentence = absent('no node', 5.0, names, '7', alike)
    assert 'ROS_DOMAIN_ID 7' in sentence
    assert '/talker' in sentence
    assert '__ns:=/arm' in sentence
    assert in_another_namespace('/arm/pam_sim', names) == ''
    assert 'no other node' in absent('no node', 5.0, [], '0', '')
