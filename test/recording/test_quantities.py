# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Column names and their units."""

import pytest

from pam_ros.errors import RecordingError
from pam_ros.recording.mapping import ColumnMapping, read_mapping
from pam_ros.recording.quantities import target_of


@pytest.mark.parametrize(
    ('name', 'quantity', 'factor'),
    [
        ('t_s', 'time', 1.0),
        ('time', 'time', 1.0),
        ('t', 'time', 1.0),
        ('Time (s)', 'time', 1.0),
        ('time_ms', 'time', 1e-3),
        ('timestamp_ns', 'time', 1e-9),
        ('stamp_us', 'time', 1e-6),
        ('elapsed [s]', 'time', 1.0),
        ('pressure_command_Pa', 'pressure_command', 1.0),
        ('pressure_command_kPa', 'pressure_command', 1e3),
        ('pressure_kPa', 'pressure', 1e3),
        ('pressure_bar', 'pressure', 1e5),
        ('Pressure [MPa]', 'pressure', 1e6),
        ('pressure_hPa', 'pressure', 1e2),
        ('pressure_KPA', 'pressure', 1e3),
        ('position_mm', 'position', 1e-3),
        ('position (m)', 'position', 1.0),
        ('contraction_percent', 'contraction', 1e-2),
        ('contraction [%]', 'contraction', 1e-2),
        ('contraction_fraction', 'contraction', 1.0),
        ('contraction_mm', 'position', 1e-3),
        ('velocity_m_s', 'velocity', 1.0),
        ('velocity [mm/s]', 'velocity', 1e-3),
        ('force_N', 'force', 1.0),
        ('force_kN', 'force', 1e3),
        ('force_kgf', 'force', 9.80665),
        ('Force (lbf)', 'force', 0.45359237 * 9.80665),
        ('pressure_torr', 'pressure', 101325.0 / 760.0),
        ('pressure [kgf/cm2]', 'pressure', 98066.5),
        ('pressure_barg', 'pressure', 1e5),
        ('position_inch', 'position', 0.0254),
        ('Position [in]', 'position', 0.0254),
        ('position [µm]', 'position', 1e-6),
        ('position_μm', 'position', 1e-6),
        ('angle_mrad', 'angle', 1e-3),
    ],
)
def test_what_a_column_means(name, quantity, factor):
    target = target_of(name)
    assert target.quantity == quantity
    assert target.factor == pytest.approx(factor, rel=1e-12)
    assert target.offset == 0.0


@pytest.mark.parametrize(('name', 'value'), [('bara', 3.5), ('psia', 50.763), ('kPaa', 350.0)])
def test_an_absolute_pressure_is_converted_to_gauge(name, value):
    factor, offset = ColumnMapping().meaning(f'pressure_{name}').to_si
    assert value * factor + offset == pytest.approx(350e3 - 101325.0, abs=20.0)
    factor, offset = read_mapping([f'x=pressure_{name}*2.0-{value}']).meaning('x').to_si
    assert value * factor + offset == pytest.approx(350e3 - 101325.0, abs=20.0)


def test_a_pound_on_a_square_inch():
    pound, inch = 0.45359237 * 9.80665, 0.0254
    assert target_of('pressure_psi').factor == pytest.approx(pound / inch**2, rel=1e-12)


@pytest.mark.parametrize(
    'name',
    [
        *('motor_voltage_V', 'state_1fill_2vent', 'reference_m', 'temperature_C', 'notes', ''),
        *('position_reference_m', 'pressure_at_valve_kPa', 'forceful', 'timer_7_count'),
    ],
)
def test_other_columns_are_not_ours(name):
    assert target_of(name) is None


@pytest.mark.parametrize(
    ('name', 'words'),
    [
        ('pressure', ['pressure', 'no unit', 'kPa', 'pressure_Pa', 'ignore']),
        ('timestamp', ['timestamp', 'no unit', 'ms']),
        ('pressure_inAq', ['pressure_inAq', "'inAq'", 'bar', 'pressure_Pa*FACTOR', 'one inAq is']),
        ('pressure_mPa', ['mPa', 'not known']),
        ('position_feet', ['position_feet', 'mm', 'position_m*FACTOR']),
        ('force_kg', ['force_kg', "'kg'", 'kN', "--column 'force_kg=force_kgf'"]),
        ('contraction', ['contraction', 'percent', 'fraction']),
    ],
)
def test_a_unit_that_is_missing_or_unknown_is_refused(name, words):
    with pytest.raises(RecordingError) as caught:
        target_of(name)
    for word in words:
        assert word in str(caught.value)
