# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Compile the kernels and keep them on disk, so that a node is up at once: run at set-up."""

import time

import numpy as np

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.rig.arrangements import ANTAGONISTIC, PARALLEL
from pam_ros.rig.bind import bind
from pam_ros.rig.joint import Actuator, Joint, one_muscle
from pam_ros.rig.rig import Rig
from pam_ros.rig.start import start_state

# An effect that is present but does nothing to speak of: the kernel steps all of the library.
SLIGHT = {'viscous_friction': {'coefficient': 1e-9}}


def warm() -> None:
    """Call every loop of the kernels that most users need, with the types of the package.

    What is not among them, such as a joint of one's own, is compiled and kept when it is first
    used.
    """
    for effects in ({}, SLIGHT):
        for kind in (PARALLEL, ANTAGONISTIC):
            actuator = Actuator(contraction=kind.contraction)
            joint = Joint((actuator,) * kind.muscles, kind.load(), kind.transmission(), effects)
            _step(joint)
        alone = one_muscle(effects=effects)
        _step(alone)
        _run(alone)


def _step(joint: Joint) -> None:
    rig = Rig([joint])
    rig.advance()
    rig.outputs()


def _run(joint: Joint) -> None:
    layout, q = joint.layout, joint.parameters()
    kernel = bind(layout, joint.active)
    t, u = np.array([0.0, 1e-3]), np.zeros((2, layout.muscles))
    x, xn = start_state(layout, q, u[0], 0.0, 0.0), layout.scratch()
    out = np.zeros((2, layout.run_columns))
    kernel.simulate(x, xn, q, t, t, u, 1e-3, out, True)
    kernel.simulate_held(x, xn, q, t, u, t, t, 1e-3, out)
    kernel.simulate_along(x, xn, q, t, t, t, t, u, np.zeros((1, 2)))


if __name__ == '__main__':
    began = time.perf_counter()
    warm()
    how = 'compiled or found on disk' if HAVE_NUMBA else 'run as plain Python (no numba)'
    print(f'kernels {how} in {time.perf_counter() - began:.1f} s')
