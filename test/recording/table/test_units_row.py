# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A row of units below the names of the columns."""

import numpy as np
import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.csv_file import read_csv
from pam_ros.recording.mapping import read_mapping

ROWS = '0,1,1.5\n0.01,2,2.5\n0.02,2,3.5\n'


def read(path, head, rules=(), separator=','):
    text = f'{head}\n{ROWS}'.replace(',', separator)
    (path / 'log.csv').write_text(text, encoding='utf-8')
    return read_csv(path / 'log.csv', read_mapping(rules))


@pytest.mark.parametrize(
    ('head', 'rules', 'scale'),
    [
        ('time,pressure_command,position\ns,kPa,mm', (), (1.0, 1e3, 1e-3)),
        ('Time,Pressure_command,Position\n(ms),[bar],(µm)', (), (1e-3, 1e5, 1e-6)),
        ('t_s,pressure_command_kPa,position\ns,kPa,mm', (), (1.0, 1e3, 1e-3)),
        ('t_s,pressure_command_kPa,position\n,-,mm', (), (1.0, 1e3, 1e-3)),
        ('t,u,position\nms,V,mm', ('u=pressure_command_bar',), (1e-3, 1e5, 1e-3)),
        ('t,u,x\ns,bar,cm', ('u [bar]=pressure_command_bar', 'x=position_cm'), (1.0, 1e5, 1e-2)),
        ('Time,pressure_command,position\nhh:mm:ss.000,bar,mm', (), (1.0, 1e5, 1e-3)),
        ('Rig 3\ntime,pressure_command,position\ns,kgf/cm2,mm', (), (1.0, 98066.5, 1e-3)),
    ],
)
@pytest.mark.parametrize('separator', [',', ';', '\t'])
def test_units_are_those_of_the_row(tmp_path, head, rules, scale, separator):
    series, _, _ = read(tmp_path, head, rules, separator)
    time, pressure, position = scale
    np.testing.assert_allclose(series['position'].t, np.multiply(time, [0.0, 0.01, 0.02]))
    np.testing.assert_allclose(series['pressure_command'].value, pressure * np.array([1, 2, 2]))
    np.testing.assert_allclose(series['position'].value, position * np.array([1.5, 2.5, 3.5]))


def test_columns_of_other_names_have_their_units_in_messages(tmp_path):
    assert read(tmp_path, 't,cmd,pos\ns,bar,mm')[2] == ['t [s]', 'cmd [bar]', 'pos [mm]']


@pytest.mark.parametrize(
    ('head', 'words'),
    [
        ('t,pressure,position_mm\ns,bar,m', ["'position_mm' has the unit 'm' in line 2"]),
        ('t,pressure_bara,position\ns,bar,m', ["'pressure_bara' has the unit 'bar' in line 2"]),
        ('t,pressure,position\ns,bar,ell', ["'position [ell]' has the unit 'ell', which is not"]),
        ('t,pressure,position\nx,y,z', ["'t [x]' has the unit 'x', which is not known"]),
        ('t,pressure,position_ell\ns,bar,mm', ["'position_ell' has the unit 'ell'"]),
        ('t,pressure,position\ns,,mm', ["'pressure' has no unit"]),
    ],
)
def test_what_is_refused(tmp_path, head, words):
    with pytest.raises(RecordingError) as caught:
        read(tmp_path, head)
    for word in words:
        assert word in str(caught.value)
