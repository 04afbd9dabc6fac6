# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What set-up compiles is all that a program will call."""

import subprocess
import sys

import pytest

LOOPS_NOT_COMPILED = """
from dataclasses import fields
from pam_ros.effects import EFFECTS
from pam_ros.rig.bind import Kernel, bind
from pam_ros.rig.layout import layout_of
from pam_ros.rig.warm import warm

warm()
kernels = [bind(layout_of(EFFECTS), active) for active in ((), EFFECTS)]
loops = [(loop.name, getattr(k, loop.name)) for loop in fields(Kernel) for k in kernels]
print([name for name, loop in loops if not loop.signatures])
"""


@pytest.mark.needs_numba
def test_every_loop_is_compiled_at_set_up():
    # In a process of its own: other tests have called some of them.
    asked = [sys.executable, '-c', LOOPS_NOT_COMPILED]
    done = subprocess.run(asked, capture_output=True, text=True, check=True)
    assert done.stdout == '[]\n'
