# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs whose results were recorded with version 0.1.0: what is simulated, as plain data.

Nothing here names a class of the package, so that the same cases describe every version of it.
Values are SI. ``MUSCLE_EFFECTS`` act in a muscle or its pressure path, ``JOINT_EFFECTS`` on what
it moves; each is strong enough to change a run visibly.
"""

from typing import Any

import numpy as np

MUSCLE_EFFECTS: dict[str, dict[str, float]] = {
    'dead_time': {'delay': 0.0123},
    'pressure_offset': {'offset': 7e3, 'gain': 0.03},
    'pressure_lag': {
        'fill': 0.05, 'vent': 0.08, 'fastest': 2e6, 'fastest_vent': 1e6, 'choking': 0.4,
    },
    'leak': {'rate': 0.2, 'refill': 0.15, 'supply': 5e5, 'vent': 0.02},
    'length_offset': {'offset': 0.012},
    'softening': {'limit': 0.05, 'per_pressure': 2e-7, 'per_second': 0.02},
    'creep': {'force': 0.04, 'stiffness': 400.0, 'pressure': 0.03, 'time': 0.8, 'spread': 3.0},
    'hysteresis': {
        'slip': 6.0, 'slip_width': 0.03, 'pressure': 4e3, 'pressure_width': 2e4, 'initial': 0.1,
    },
    'slack': {'share': 1.0, 'toe': 20.0, 'push': 5.0},
    'pressure_dependent_damping': {'inflating': 3e-4, 'deflating': 6e-4},
    'periodic_disturbance': {
        'force_sin': 4.0, 'force_cos': -2.0, 'pressure_sin': 800.0, 'frequency': 3.3,
    },
}  # fmt: skip
JOINT_EFFECTS: dict[str, dict[str, float]] = {
    'payload': {'mass': 2.5},
    'viscous_friction': {'coefficient': 35.0},
    'coulomb_friction': {
        'level': 9.0, 'breakaway': 14.0, 'stribeck_speed': 0.015, 'per_pressure': 1e-5,
        'asymmetry': 0.1,
    },
    'end_stop': {'upper': 0.2, 'stiffness': 3e4, 'lower': 0.02, 'lower_stiffness': 2e4},
}  # fmt: skip
# The law of Dahl by itself: 0.1.0 integrated it in two parts, so that its bits differ.
DAHL = {'hysteresis': {'amplitude': 8.0, 'width': 0.02, 'initial': 0.1}}
# The same effects on a joint that turns, where N is N m and m is rad.
TURNED_EFFECTS: dict[str, dict[str, float]] = {
    'payload': {'mass': 0.3},
    'viscous_friction': {'coefficient': 0.05},
    'coulomb_friction': {'level': 0.15, 'breakaway': 0.22, 'stribeck_speed': 0.3},
    'end_stop': {'upper': 0.6, 'stiffness': 400.0, 'lower': -0.6, 'lower_stiffness': 300.0},
}
DMSP_10 = {
    'a1': -9.2194029, 'a2': 203.7012413, 'a3': -0.34221042, 'a4': -3.2255991, 'a5': 109.2038216,
    'a6': -208.372034, 'l0': 0.25, 'inside_diameter': 0.01, 'force_max': 630.0, 'p_max': 8e5,
}  # fmt: skip
# A load that a known force moves: no muscle, the input is a voltage (the EMPS drive).
DRIVE = {
    'a1': 0.0, 'a2': 0.0, 'a3': 0.0, 'a4': 0.0, 'a5': 35.15, 'a6': 0.0, 'zeta': 0.0,
    'pressure_unit': 'Pa', 'p_min': -10.0, 'p_max': 10.0, 'force_max': 500.0,
}  # fmt: skip

STEP = 1e-3  # s


def single_muscle_joint() -> dict[str, dict[str, Any]]:
    """Return the rigs of one muscle: muscle, load and effects by name."""
    effects = {**MUSCLE_EFFECTS, **JOINT_EFFECTS}
    return {
        'plain': {'muscle': {}, 'load': {'mass': 20.0}, 'effects': {}},
        'dmsp_10': {'muscle': DMSP_10, 'load': {'mass': 5.0}, 'effects': {}},
        'all': {'muscle': {}, 'load': {'mass': 20.0}, 'effects': effects},
    }


def commands(seed: int = 1, duration: float = 4.0) -> tuple[np.ndarray, np.ndarray]:
    """Return stamps in s and pressures in Pa: steps of all sizes at uneven times."""
    random = np.random.default_rng(seed)
    t = np.concatenate([[0.0], np.sort(random.uniform(0.02, duration, 40))])
    return t, random.uniform(0.5e5, 5.8e5, t.size)


def stamps(seed: int = 2, duration: float = 4.0) -> np.ndarray:
    """Return uneven stamps in s."""
    random = np.random.default_rng(seed)
    return np.cumsum(np.concatenate([[0.005], random.uniform(0.002, 0.03, round(duration * 60))]))


def motion(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a prescribed position in m and velocity in m/s, and a measured pressure in Pa."""
    y = 0.05 + 0.02 * np.sin(2.0 * np.pi * 0.4 * t) + 0.004 * np.sin(2.0 * np.pi * 1.7 * t)
    v = 0.02 * 2.0 * np.pi * 0.4 * np.cos(
        2.0 * np.pi * 0.4 * t
    ) + 0.004 * 2.0 * np.pi * 1.7 * np.cos(2.0 * np.pi * 1.7 * t)
    return y, v, 3e5 + 2e5 * np.sin(2.0 * np.pi * 0.25 * t + 0.3)
