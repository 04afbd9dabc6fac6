# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Forces along a motion that is given: closed forms, and the velocity of a free run."""

import numpy as np
import pytest

from pam_ros.effects import EFFECTS, DeadTime, Hysteresis, PressureLag, ViscousFriction
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.acting import acting_commands, delays_of
from pam_ros.rig.bind import bind
from pam_ros.rig.loads import Mass
from pam_ros.rig.run import by_muscle, simulate
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.start import start_state
from support import bench
from support.joint_models import lever, pair

pytestmark = pytest.mark.needs_numba


def along(joint, t, y, v, command_t, command):
    """Return what each interval between two stamps gives: velocity and its moment, (n - 1, 2)."""
    q, layout = joint.parameters(), joint.layout
    command = by_muscle('command', command, 'command_t', len(command_t), layout.muscles)
    x = start_state(layout, q, command[0], y[0], v[0])
    out = np.empty((t.size - 1, 2))
    acts = [np.asarray(command_t, float) + delay for delay in delays_of(layout, q)]
    at, acting = acting_commands(acts, command)
    kernel = bind(layout, joint.active)
    kernel.simulate_along(x, layout.scratch(), q, t, y, v, at, acting, out)
    return out


def test_a_command_within_an_interval_counts_from_its_stamp():
    gain, mass = 35.0, 5.0
    model = single_muscle_joint(
        Muscle(0.0, 0.0, 0.0, 0.0, gain, 0.0, pressure_unit='Pa', zeta=0.0, p_max=10.0),
        Mass(mass=mass, mount='horizontal'),
    )
    t = np.array([0.0, 0.01, 0.02, 0.04])
    still = np.zeros(4)
    out = along(model, t, still, still, [0.0, 0.01, 0.027], [0.0, 2.0, 5.0])
    a, b = 2.0 * gain / mass, 5.0 * gain / mass
    middle = 0.5 * (0.02 + 0.04)
    moment = a * 0.007 * (0.0235 - middle) + b * 0.013 * (0.0335 - middle)
    expected = [[0.0, 0.0], [a * 0.01, 0.0], [a * 0.007 + b * 0.013, moment]]
    np.testing.assert_allclose(out, expected, atol=1e-12)


ALONE = [[effect.example()] for effect in EFFECTS]
# A memory in the pressure path, one in the force, and a friction without any.
TOGETHER = [
    PressureLag(fill=0.03, vent=0.05),
    Hysteresis(amplitude=8.0, width=0.01),
    ViscousFriction(coefficient=100.0),
]
EACH = pytest.mark.parametrize(
    'effects',
    [(), *ALONE, TOGETHER],
    ids=lambda some: '+'.join(e.name for e in some) or 'none',
)
T_END = 4.0
AT = np.array([0.0, 0.45, 1.2, 2.0, 2.1, 3.0])
U = np.array([2e5, 4.5e5, 1e5, 3e5, 3.2e5, 2.5e5])


def errors(joint, u):
    """Return how far accelerations along a free run are from it, relative, at 1 and 0.5 ms.

    Each as RMS of all intervals between stamps, and of all but the worst hundredth: forces have
    kinks and jumps at single places, where a pad begins and where a contact slides.
    """
    found = []
    for h in (1e-3, 0.5e-3):
        t = h * np.arange(round(T_END / h))
        run = simulate(joint, t, AT, u, step=1e-4)
        pushed = along(joint, t, run.position, run.velocity, AT, u)[:, 0] / h
        gained = np.diff(run.velocity) / h
        off = np.sort((pushed - gained) ** 2) / np.mean(gained**2)
        most = off[: -round(0.01 * t.size)]
        found.append((np.sqrt(np.mean(off)), np.sqrt(np.mean(most))))
    return found


@pytest.mark.slow
@EACH
def test_forces_along_a_free_run_give_its_velocity(effects):
    """Between stamps the motion is taken as linear: the error falls with their square."""
    (coarse, most_coarse), (fine, most_fine) = errors(bench.hanging(*effects), U)
    assert coarse < 2.5e-3
    assert fine < coarse / 1.5
    assert most_coarse < 3e-4
    assert most_fine < most_coarse / 3.5


@pytest.mark.slow
@pytest.mark.parametrize('made', [pair, lever])
def test_so_do_those_of_two_muscles_on_a_joint_that_turns(made):
    u = np.stack([U, U[::-1]], axis=1)
    late = [DeadTime(delay=0.013)], [PressureLag(fill=0.03, vent=0.05)]
    joint = made(effects=late, load=[ViscousFriction(coefficient=0.2)])
    (coarse, _), (fine, _) = errors(joint, u)
    assert coarse < 1e-4
    assert fine < coarse / 3.5
