# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Compile the kernels and keep them on disk, so that nodes start quickly; run during set-up."""

import argparse
import logging
import multiprocessing
import signal
import sys
import time
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from pam_ros import code_cache
from pam_ros.compiled import HAVE_NUMBA
from pam_ros.processes.prompt_end import end_promptly
from pam_ros.rig.arrangements import ARRANGEMENTS, Arrangement
from pam_ros.rig.bind import bind
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.start import start_state

INTERRUPTED = 130  # exit code
WORKERS = 2  # processes: each compiles all effects itself, and needs half a gigabyte


def warm() -> None:
    """Call every loop of the kernels that most users need, with the types of the package.

    The stepping loops are compiled for all kinds of joints that users choose by name, the loops
    over recordings for one muscle on a mass only; each without effects, and with all effects.
    Others, such as those of a custom joint, are compiled and kept at their first use.
    """
    with ProcessPoolExecutor(WORKERS, initializer=_prepare_worker) as pool:
        try:
            for done in [*(pool.submit(_step, kind) for kind in ARRANGEMENTS), pool.submit(_run)]:
                code_cache.warn(done.result())
        except BaseException:
            # Else the end of the pool waits for what is compiled at present.
            for worker in multiprocessing.active_children():
                worker.kill()
            raise
    _run()  # from disk: an identification in this process then finds them loaded


def _prepare_worker() -> None:
    # Each worker would log the same warnings; they are logged in the main process once.
    logging.disable()
    # A handler in Python would not be called before the compiler returns.
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def _step(kind: Arrangement) -> str:
    """Return why nothing is kept on disk, or '' if it is kept; :func:`_run` does the same."""
    actuator = Actuator(contraction=kind.contraction)
    Simulation([Joint((actuator,) * kind.muscles, kind.load(), kind.transmission())]).prepare()
    return code_cache.warned()


def _run() -> str:
    joint = single_muscle_joint()
    layout, q = joint.layout, joint.parameters()
    t, u = np.array([0.0, 1e-3]), np.zeros((2, layout.muscles))
    out = np.zeros((2, layout.run_columns))
    for active in ((), joint.library):
        kernel = bind(layout, active)
        x, xn = start_state(layout, q, u[0], 0.0, 0.0), layout.scratch()
        kernel.simulate(x, xn, q, t, t, u, 1e-3, out, True)
        kernel.simulate_pressures(x, xn, q, t, t, u, 1e-3, out)
        kernel.simulate_held(x, xn, q, t, u, t, t, 1e-3, out)
    return code_cache.warned()


def main() -> None:
    """Compile the kernels as a command: ``python3 -m pam_ros.rig.warm``."""
    argparse.ArgumentParser(prog='python3 -m pam_ros.rig.warm', description=__doc__).parse_args()
    began = time.perf_counter()
    try:
        with end_promptly():
            warm()
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    how = 'compiled or found on disk' if HAVE_NUMBA else 'run as plain Python (no numba)'
    print(f'kernels {how} in {time.perf_counter() - began:.1f} s')


if __name__ == '__main__':
    main()
