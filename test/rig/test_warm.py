# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What set-up compiles is all that most programs will call."""

import subprocess
import sys

import pytest

COMPILED_AFTERWARDS = """
import numpy as np
from numba.core import event
from pam_ros.effects import ViscousFriction
from pam_ros.rig.arrangements import ARRANGEMENTS
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.run import simulate, simulate_held
from pam_ros.settings.scene import Scene
from pam_ros.settings.tables import checked
from pam_ros.simulator.plant import Plant

class Listener(event.Listener):
    def on_start(self, event):
        print(event.data['dispatcher'].py_func.__qualname__)

    def on_end(self, event):
        pass

event.register('numba:compile', Listener())
for kind in ARRANGEMENTS:
    for effects in ({}, {'effects.viscous_friction.coefficient': 0.1}):
        given = {'joint': kind.name, **effects}
        scene = Scene(given)
        plant = Plant(scene.build(checked(scene.table(), given)))
        plant.take([2e5], [0])
        plant.advance(10)
        plant.read()
t, p = np.array([0.0, 0.01]), np.array([1e5, 2e5])
for effects in ((), [ViscousFriction(coefficient=0.1)]):
    alone = single_muscle_joint(effects=effects)
    simulate(alone, t, p)
    simulate_held(alone, t, p, t)
"""


@pytest.mark.slow
@pytest.mark.needs_numba
def test_a_program_that_starts_later_compiles_nothing():
    """Any kind of joint is stepped, one muscle run over recordings; without effects, and with.

    Not even a small function: the first one costs half a second, more than all imports.
    """
    asked = [sys.executable, '-c', COMPILED_AFTERWARDS]
    subprocess.run([sys.executable, '-m', 'pam_ros.rig.warm'], capture_output=True, check=True)
    done = subprocess.run(asked, capture_output=True, text=True, check=True)
    assert done.stdout == ''
