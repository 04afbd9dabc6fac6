# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Column names and their units."""

import pytest

from pam_ros.errors import RecordingError
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
    ],
)
def test_what_a_column_means(name, quantity, factor):
    target = target_of(name)
    assert target.quantity == quantity
    assert target.factor == factor


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
        ('pressure_inHg', ['pressure_inHg', "'inHg'", 'bar']),
        ('pressure_mPa', ['mPa', 'not known']),
        ('position_inch', ['position_inch', 'mm']),
        ('force_kg', ['force_kg', "'kg'", 'kN']),
        ('contraction', ['contraction', 'percent', 'fraction']),
    ],
)
def test_a_unit_that_is_missing_or_unknown_is_refused(name, words):
    with pytest.raises(RecordingError) as caught:
        target_of(name)
    for word in words:
        assert word in str(caught.value)
