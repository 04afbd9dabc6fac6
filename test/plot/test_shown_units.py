# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The units of plots, and the names of their columns as the reader of CSV files knows them."""

import numpy as np
import pytest

from pam_ros.plot.column_names import column_name
from pam_ros.plot.panels import Curves, panels
from pam_ros.plot.shown_units import SI, choices, in_units, scale
from pam_ros.plot.topics import TOPICS, Key
from pam_ros.recording.quantities import target_of

# The units that can be chosen: the first is what is shown at first.
CHOICES = {
    'm': ('mm, kPa', SI),
    'rad': ('deg, kPa', SI),
    '': ('kPa', 'mm, kPa', 'deg, kPa', SI),
}
ONE = np.zeros(1), np.ones(1)
KEYS = {
    'position': Key('position', 'joint_states', 'knee'),
    'pressure': Key('pressure', 'pressure'),
    'force': Key('force', 'force'),
    'stiffness': Key('stiffness', 'stiffness'),
}


@pytest.mark.parametrize('unit', CHOICES)
def test_what_can_be_chosen(unit):
    made = panels(Curves(dict.fromkeys(KEYS.values(), ONE)), unit, 1.0)
    assert choices(made) == CHOICES[unit]
    assert choices(made[1:]) == ('kPa', SI)  # without a position


def shown(unit, choice):
    made = panels(Curves(dict.fromkeys(KEYS.values(), ONE)), unit, 1.0)
    return [in_units(panel, choice) for panel in made]


@pytest.mark.parametrize(
    ('unit', 'choice', 'position', 'pressure'),
    [
        ('m', 'mm, kPa', ('position, mm', 1e3), ('pressure (gauge), kPa', 1e-3)),
        ('m', SI, ('position, m', 1.0), ('pressure (gauge), Pa', 1.0)),
        ('rad', 'deg, kPa', ('position, deg', 57.29578), ('pressure (gauge), kPa', 1e-3)),
        ('', 'kPa', ('position, m or rad', 1.0), ('pressure (gauge), kPa', 1e-3)),
        ('', 'mm, kPa', ('position, mm', 1e3), ('pressure (gauge), kPa', 1e-3)),
        ('', 'deg, kPa', ('position, deg', 57.29578), ('pressure (gauge), kPa', 1e-3)),
    ],
)
def test_titles_and_values(unit, choice, position, pressure):
    found = [(panel.title, panel.lines[0].value[0]) for panel in shown(unit, choice)]
    expected = [position, pressure, ('force, N', 1.0), ('stiffness, N/m', 1.0)]
    assert [title for title, _ in found] == [title for title, _ in expected]
    assert [value for _, value in found] == pytest.approx([value for _, value in expected])


@pytest.mark.parametrize('unit', ['m', 'rad'])
@pytest.mark.parametrize('number', [0, 1])
def test_the_reader_of_csv_files_understands_the_columns(unit, number):
    for quantity, key in KEYS.items():
        (panel,) = panels(Curves({key: ONE}), unit, 1.0)
        _, factor, suffix = scale(panel, CHOICES[unit][number])
        target = target_of(f'{panel.lines[0].column}_{suffix}')
        if quantity == 'stiffness':  # is no quantity of a recording
            assert target is None
            continue
        assert target.quantity == (
            'angle' if (quantity, unit) == ('position', 'rad') else quantity
        )
        assert target.factor == pytest.approx(1.0 / factor)
        assert target.offset == 0.0


def test_the_columns_of_muscles_and_joints():
    muscles = ('flexor', 'upper extensor')
    key = Key('pressure', 'pressure_commands', '1')
    assert column_name(key, muscles) == 'upper_extensor.pressure_command'
    assert column_name(key, ()) == 'muscle_2.pressure_command'
    target = target_of('upper_extensor.pressure_command_kPa')
    assert (target.muscle, target.quantity) == ('upper_extensor', 'pressure_command')
    knee = Key('position', 'joint_states', 'knee')
    assert column_name(knee, (), 1) == 'position'
    assert column_name(knee, (), 2) == 'knee.position'
    # Of two joints neither is what the reader would take for the position.
    assert target_of('knee.position_deg') is None


def test_every_topic_has_a_column_and_no_two_of_a_rig_the_same():
    keys = [
        Key(use.panel, topic, '1' if use.kind.endswith('MultiArray') else '')
        for topic, use in TOPICS.items()
        if topic != 'joint_states'
    ]
    names = [column_name(key, ()) for key in keys]
    assert len(set(names)) == len(names)
    # References and stiffnesses are no quantities of a recording: they are passed over.
    for name in ('position_reference_mm', 'reference_mm', 'stiffness_N_per_m', 'damping_Ns_per_m'):
        assert target_of(name) is None
