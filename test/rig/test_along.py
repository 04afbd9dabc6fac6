# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Forces along a motion that is given: closed forms, and the velocity of a free run."""

import numpy as np
import pytest

from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.bind import bind
from pam_ros.rig.model import Load, RigModel, start_row
from pam_ros.rig.run import simulate
from support import bench

pytestmark = pytest.mark.needs_numba


def along(model, t, y, v, command_t, command):
    """Return what each interval between two stamps gives: velocity and its moment, (n - 1, 2)."""
    q = model.row()
    x = start_row(model.layout, q, command[0], y[0], v[0])
    out = np.empty((t.size - 1, 2))
    arrays = [np.asarray(a, float) for a in (t, y, v, command_t, command)]
    bind(model.layout, model.active).simulate_along(x, np.empty_like(x), q, *arrays, out)
    return out


def test_a_command_within_an_interval_counts_from_its_stamp():
    gain, mass = 35.0, 5.0
    model = RigModel(
        Muscle(0.0, 0.0, 0.0, 0.0, gain, 0.0, pressure_unit='Pa', zeta=0.0, p_max=10.0),
        Load(mass=mass, mount='horizontal'),
    )
    t = np.array([0.0, 0.01, 0.02, 0.04])
    still = np.zeros(4)
    out = along(model, t, still, still, [0.0, 0.01, 0.027], [0.0, 2.0, 5.0])
    a, b = 2.0 * gain / mass, 5.0 * gain / mass
    middle = 0.5 * (0.02 + 0.04)
    moment = a * 0.007 * (0.0235 - middle) + b * 0.013 * (0.0335 - middle)
    expected = [[0.0, 0.0], [a * 0.01, 0.0], [a * 0.007 + b * 0.013, moment]]
    np.testing.assert_allclose(out, expected, atol=1e-12)


@pytest.mark.parametrize(
    'effects',
    [
        {},
        {'dead_time': {'delay': 0.013}},
        {'pressure_lag': {'fill': 0.03, 'vent': 0.05}},
        {'leak': {'rate': 0.2, 'refill': 0.05}},
        {'viscous_friction': {'coefficient': 100.0}},
        {'payload': {'mass': 3.0}},
        {'creep': {'stiffness': 800.0, 'time': 2.0}},
        {'hysteresis': {'amplitude': 8.0, 'width': 0.01}},
        {'softening': {'limit': 0.05, 'per_second': 1.0}},
        # Without damping: how much of that acts depends on the step.
        {'end_stop': {'upper': 0.1, 'stiffness': 2e4, 'damping': 0.0}},
        {
            'pressure_lag': {'fill': 0.03, 'vent': 0.05},
            'hysteresis': {'amplitude': 8.0, 'width': 0.01},
            'viscous_friction': {'coefficient': 100.0},
        },
    ],
    ids=lambda effects: '+'.join(effects) or 'none',
)
def test_forces_along_a_free_run_give_its_velocity(effects):
    """Between stamps the motion is taken as linear: the error falls with their square."""
    model = bench.hanging(**effects)
    at = np.array([0.0, 0.45, 1.2, 2.0, 2.1, 3.0])
    u = np.array([2e5, 4.5e5, 1e5, 3e5, 3.2e5, 2.5e5])
    error = []
    for h in (1e-3, 0.5e-3):
        t = h * np.arange(round(4.0 / h))
        run = simulate(model, t, at, u, step=1e-4)
        pushed = along(model, t, run.position, run.velocity, at, u)[:, 0] / h
        gained = np.diff(run.velocity) / h
        error.append(np.sqrt(np.mean((pushed - gained) ** 2) / np.mean(gained**2)))
    assert error[0] < 2e-3
    # A pad begins at one place, and play turns at another: kinks in what is else smooth.
    assert error[1] < error[0] / (2.0 if {'end_stop', 'softening'} & set(effects) else 3.5)
