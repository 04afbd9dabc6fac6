# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What set-up compiles is all that most programs will call."""

import subprocess
import sys

import pytest

LOOPS_NOT_COMPILED = """
from dataclasses import fields
from pam_ros.effects import EFFECTS
from pam_ros.rig.arrangements import ANTAGONISTIC, LOAD, PARALLEL
from pam_ros.rig.bind import Kernel, bind
from pam_ros.rig.layout import layout_of
from pam_ros.rig.warm import warm

warm()
for kind in (LOAD, PARALLEL, ANTAGONISTIC):
    layout = layout_of(EFFECTS, kind.transmission.equations, kind.load.equations, kind.muscles)
    wanted = [loop.name for loop in fields(Kernel)] if kind is LOAD else ['advance', 'outputs']
    for active in ((), EFFECTS):
        kernel = bind(layout, active)
        for name in wanted:
            if not getattr(kernel, name).signatures:
                print(kind.name, len(active), name)
"""


COMPILED_AFTERWARDS = """
from numba.core import event
from pam_ros.rig.arrangements import ANTAGONISTIC, LOAD, PARALLEL
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.rig import Rig

class Listener(event.Listener):
    def on_start(self, event):
        print(event.data['dispatcher'].py_func.__qualname__)

    def on_end(self, event):
        pass

event.register('numba:compile', Listener())
for kind in (LOAD, PARALLEL, ANTAGONISTIC):
    muscles = (Actuator(contraction=kind.contraction),) * kind.muscles
    for effects in ({}, {'viscous_friction': {'coefficient': 0.1}}):
        rig = Rig([Joint(muscles, kind.load(), kind.transmission(), effects)])
        rig.command([2e5] * kind.muscles)
        rig.advance(10)
        rig.outputs()
"""


@pytest.mark.needs_numba
def test_a_program_that_starts_later_compiles_nothing():
    """Not even a small function: the first one costs half a second, more than all imports."""
    asked = [sys.executable, '-c', COMPILED_AFTERWARDS]
    subprocess.run([sys.executable, '-m', 'pam_ros.rig.warm'], capture_output=True, check=True)
    done = subprocess.run(asked, capture_output=True, text=True, check=True)
    assert done.stdout == ''


@pytest.mark.needs_numba
def test_every_loop_is_compiled_at_set_up():
    """Those that are stepped, of each of these; those over recordings, of one muscle alone."""
    # In a process of its own: other tests have called some of them.
    asked = [sys.executable, '-c', LOOPS_NOT_COMPILED]
    done = subprocess.run(asked, capture_output=True, text=True, check=True)
    assert done.stdout == ''
