# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Fields of the two records that the kernel works on: what the rig is, and where it is."""

from __future__ import annotations

from typing import Any

from .compiled import blank, element

ELEMENTS = 12  # slip elements of a hysteresis
QUEUE = 512  # commands in flight through a dead time
ENOUGH = 1e9  # Pa of a supply that limits no regulator

# Zero means absent for every effect's field. The unit is the end of the name where it has one;
# the catalogue says what each one is.
PARAMETERS = (
    # the muscle, the load and the integrator's largest step
    *('a1', 'a2', 'a3', 'a4', 'a5', 'a6', 'l0_m', 'mass_kg', 'zeta', 'gravity', 'dt', 'held'),
    # pressure path
    *('dead_time_s', 'regulator_pa', 'regulator_gain', 'ripple_pa'),
    *('fill_s', 'vent_s', 'conductance_fill', 'conductance_vent', 'volume_l', 'valve_band_pa'),
    *('leak_per_s', 'refill_pa_s', 'valve_open_s', 'hyst_pa', 'hyst_reach_pa'),
    *('late_1', 'late_2', 'saturation', 'knee_pa', 'overlap_pa', 'bladder_pa'),
    'dead_zone_pa',
    # muscle
    *('slack', 'toe_n', 'hyst_n', 'hyst_reach_m', 'creep_1', 'creep_2', 'creep_1_s', 'creep_2_s'),
    *('maxwell_1_n_m', 'maxwell_2_n_m', 'soft_share', 'soft_work_j', 'soft_path_pa'),
    *('damping_up_ns_m_bar', 'damping_down_ns_m_bar', 'kappa_offset', 'cross_n_pa'),
    *('drift_share', 'drift_mid_s', 'drift_width_s'),
    # load and guide
    *('payload_kg', 'coulomb_n', 'static_n', 'stribeck_m_s', 'bristle_n_m', 'bristle_ns_m'),
    *('viscous_ns_m', 'stop_m', 'stop_n_m15', 'stop_s_m', 'ripple_n', 'ripple_hz', 'ripple_rad'),
    *('drag_ns2_m2', 'cog_n', 'cog_m', 'play_m', 'second_kg', 'second_hz', 'second_zeta'),
    'walk_n_rs',
)
STATE = (
    *('t', 'y', 'v', 'p', 'pull', 'u', 'valve_time', 'head', 'tail', 'y_mem', 'p_mem', 'bristle'),
    'supply_pa',
    *(
        'lag_1',
        'lag_2',
        'plag_1',
        'plag_2',
        'strain_1',
        'strain_2',
        'wear',
        'link',
        'second',
        'second_v',
    ),
)
STATE_ARRAYS = {
    'slip': ELEMENTS,
    'slip_reach': ELEMENTS,
    'pslip': ELEMENTS,
    'pslip_reach': ELEMENTS,
    'queue_t': QUEUE,
    'queue_u': QUEUE,
}


def new_parameters() -> Any:
    """Return a sequence of one record of all parameters, every effect absent."""
    sequence = blank('parameters', PARAMETERS, {})
    element(sequence).regulator_gain = 1.0
    return sequence


def new_state() -> Any:
    """Return a sequence of one record of all states at zero; the supply always suffices."""
    sequence = blank('state', STATE, STATE_ARRAYS)
    element(sequence).supply_pa = ENOUGH
    return sequence
