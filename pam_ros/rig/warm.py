# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Compile the kernels and keep them on disk, so that a node is up at once: run at set-up."""

import time

import numpy as np

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.effects import EFFECTS
from pam_ros.rig.bind import bind
from pam_ros.rig.joint_model import JointModel
from pam_ros.rig.layout import layout_of
from pam_ros.rig.model import RigModel, start_row
from pam_ros.rig.rig import Rig


def warm() -> None:
    """Call every loop of all kernels once, with the types that the package uses."""
    for effects in ({}, {'viscous_friction': {'coefficient': 1.0}}):
        rig = Rig([JointModel(effects=effects)])
        rig.advance()
        rig.outputs()
    layout = layout_of(EFFECTS)
    q = RigModel().row()
    for active in ((), EFFECTS):
        kernel = bind(layout, active)
        x = start_row(layout, q, 0.0, 0.0, 0.0)
        rows, scratch, q2 = x[None].copy(), np.zeros((1, len(x))), q[None].copy()
        queue = np.zeros((1, 16))
        count = np.zeros(1, dtype=np.int64)
        kernel.advance(rows, scratch, q2, np.zeros(1), queue, queue.copy(), count, 0, 1, 1e-3)
        kernel.outputs(rows, scratch, q2, 0.0, np.zeros((1, 4)))
        t = np.array([0.0, 1e-3])
        kernel.simulate(x, x.copy(), q, t, t, t, 1e-3, np.zeros((2, 4)), True)
        kernel.simulate_held(x, x.copy(), q, t, t, t, t, 1e-3, np.zeros((2, 4)))
        kernel.simulate_along(x, x.copy(), q, t, t, t, t, t, np.zeros((1, 2)))


if __name__ == '__main__':
    began = time.perf_counter()
    warm()
    how = 'compiled or found on disk' if HAVE_NUMBA else 'run as plain Python (no numba)'
    print(f'kernels {how} in {time.perf_counter() - began:.1f} s')
