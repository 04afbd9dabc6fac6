# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated rig of any kind of joint: a change while it runs does not stop it."""

import pytest

from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.rig.bind import bind
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.plant import Plant

FRICTION = {'effects.viscous_friction.coefficient': 0.5}


def simulation(kind, **more):
    given = {'joint': kind.name, **more}
    scene = Scene(given)
    return scene.build(checked(scene.table(), given))


def loaded(joint):
    """Return what numba has loaded or compiled for a kind of joint."""
    kernels = [bind(joint.layout, active) for active in ((), joint.library)]
    return [loop.signatures for kernel in kernels for loop in (kernel.advance, kernel.outputs)]


@pytest.mark.needs_numba
@pytest.mark.parametrize('kind', ARRANGEMENTS, ids=lambda kind: kind.name)
@pytest.mark.parametrize(('before', 'after'), [({}, FRICTION), (FRICTION, {})])
def test_a_change_of_effects_finds_its_machine_code_loaded(kind, before, after):
    """While it is loaded, or even compiled, time stands still and no state is published."""
    bind.cache_clear()  # as in a program of its own
    plant = Plant(simulation(kind, **before))
    joint = plant.setup.joints[0]
    at_start = loaded(joint)
    plant.change(simulation(kind, **after))
    plant.take([3e5], [0])
    plant.advance(10)
    plant.read()
    assert all(at_start)
    assert loaded(joint) == at_start
