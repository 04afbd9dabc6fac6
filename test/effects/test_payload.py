# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The payload against the equation of motion with another mass, written out."""

import numpy as np
import pytest

from pam_ros.effects import Payload
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.joint import Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.run import simulate
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from support import bench


@pytest.mark.parametrize('more', [-3.0, 5.0])
def test_load_moves_with_weight_and_inertia_of_the_sum(more):
    t = np.linspace(0.0, 1.0, 101)
    y0 = bench.rest(3e5)
    run = simulate(bench.hanging(Payload(mass=more)), t, [3e5], [0.0], position=y0)
    m = bench.MASS + more

    def rhs(_, state, u):
        y, v = state
        return v, (bench.pull(u, y) - bench.drag(u, y, m) * v) / m - bench.G

    y, v = bench.solved(rhs, t, (y0, 0.0), ((0.0, 3e5),))
    np.testing.assert_allclose(run.position, y, atol=1e-9)
    np.testing.assert_allclose(run.velocity, v, atol=1e-7)
    assert np.ptp(y) > 1e-3


def test_load_is_never_less_than_a_fifth():
    """A joint refuses less; a fit that changes the mass as well may try it on its way."""
    assert Payload.equations.mass(10.0, [-50.0], 0) == 2.0
    assert Payload.equations.mass(10.0, [-7.0], 0) == 3.0


@pytest.mark.parametrize(
    'make',
    [
        lambda effect: single_muscle_joint(Muscle(), Mass(mass=20.0), effects=[effect]),
        lambda effect: antagonistic_joint(load=Arm(mass=20.0), effects=[effect]),
        lambda effect: Joint(load=Mass(mass=20.0), effects=[effect]),
    ],
)
def test_no_joint_has_less_than_a_fifth(make):
    assert make(Payload(mass=-16.0)).moved_mass == pytest.approx(4.0)
    words = r'^effects\.payload\.mass = -25 kg leaves -5 kg of mass = 20 kg: give at least -16 kg$'
    for effect in (Payload(mass=-25.0), Payload(mass=-25.0, onset=2.0)):
        with pytest.raises(ParameterError, match=words):
            make(effect)
    assert Payload.fit_bounds({'mass': -1.0}, {'mass'}, 20.0, 60.0)['mass'][0] == -16.0
