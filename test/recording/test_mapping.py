# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the user says that other names mean."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import read_mapping

FINITE = st.floats(-1e6, 1e6, allow_nan=False)


def si(mapping, source, x):
    factor, offset = mapping.meaning(source).to_si
    return factor * x + offset


@pytest.mark.parametrize(
    ('rule', 'source', 'x', 'quantity', 'value'),
    [
        ('motor_voltage_V=pressure_command_Pa', 'motor_voltage_V', 2.5, 'pressure_command', 2.5),
        ('adc=force_N*0.392-4.1786', 'adc', 100.0, 'force', 39.2 - 4.1786),
        ('x_mm=position_mm*-1+30', 'x_mm', 10.0, 'position', 0.02),
        ('p_abs=pressure_kPa-101.325', 'p_abs', 301.325, 'pressure', 2e5),
        ('p = pressure_bar * 1e-1 + 2.5e-1', 'p', 5.0, 'pressure', 7.5e4),
        ('/a/b.wrench.force.z=force_kN*.5', '/a/b.wrench.force.z', 2.0, 'force', 1e3),
        ('a=b=force_N', 'a=b', 3.0, 'force', 3.0),
        ('clock=t_ms', 'clock', 1500.0, 'time', 1.5),
    ],
)
def test_a_rule_of_the_command_line(rule, source, x, quantity, value):
    mapping = read_mapping([rule])
    assert source in mapping
    assert mapping.meaning(source).target.quantity == quantity
    assert si(mapping, source, x) == pytest.approx(value, rel=1e-12)


@given(FINITE, FINITE, FINITE)
def test_scale_and_offset_are_in_the_targets_unit(scale, offset, x):
    mapping = read_mapping([f'q=position_mm*{scale!r}{offset:+.17g}'])
    assert si(mapping, 'q', x) == pytest.approx((x * scale + offset) * 1e-3, rel=1e-9, abs=1e-9)


def test_a_name_of_ours_needs_no_rule_but_a_rule_comes_first():
    mapping = read_mapping(['force_N=pressure_kPa', 'pressure_foo=ignore'])
    assert mapping.meaning('position_mm').target.quantity == 'position'
    assert mapping.meaning('force_N').target.quantity == 'pressure'
    assert mapping.meaning('pressure_foo') is None
    assert 'pressure_foo' in mapping


def test_the_command_line_overrides_the_file(tmp_path):
    file = tmp_path / 'columns.yaml'
    file.write_text('columns:\n  u: pressure_command_bar\n  adc: force_N*2+1\n  junk: ignore\n')
    mapping = read_mapping(['u=pressure_command_Pa'], file)
    assert si(mapping, 'u', 7.0) == 7.0
    assert si(mapping, 'adc', 3.0) == 7.0
    assert sorted(mapping) == ['adc', 'junk', 'u']


@pytest.mark.parametrize(
    ('rule', 'words'),
    [
        ('nothing', ['nothing', 'SOURCE=TARGET']),
        ('=force_N', ['SOURCE=TARGET']),
        ('a=', ['a=', 'force_N']),
        ('a=speed_N', ['a=speed_N', 'velocity_m_s']),
        ('a=force_N*', ['force_N*']),
        ('a=force_N*2*3', ['force_N*2*3']),
        ('a=force_N/2', ['force_N/2']),
        ('a=force_lb', ["'lb'"]),
        ('a=pressure', ['no unit']),
    ],
)
def test_a_rule_that_cannot_be_understood(rule, words):
    with pytest.raises(RecordingError) as caught:
        read_mapping([rule])
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('u: pressure_Pa\n', ['columns']),
        ('columns: [u]\n', ['columns']),
        ('columns:\n  u: 3\n', ["'u': 3"]),
        ('columns:\n  u: volts\n', ['volts']),
        ('columns: {\n', ['is not valid YAML', 'line 2']),
    ],
)
def test_a_file_that_cannot_be_understood(tmp_path, text, words):
    file = tmp_path / 'columns.yaml'
    file.write_text(text)
    with pytest.raises(RecordingError) as caught:
        read_mapping(file=file)
    for word in words:
        assert word in str(caught.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(RecordingError, match=r'none\.yaml'):
        read_mapping(file=tmp_path / 'none.yaml')


def test_a_source_that_is_not_there_is_named():
    with pytest.raises(RecordingError, match=r"log\.csv has no 'volts'.*'t_s', 'u'"):
        read_mapping(['volts=pressure_Pa']).need(['t_s', 'u'], 'log.csv')
