# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A step of the rig compared with MuJoCo and plain C, each called once for 100 000 steps of 1 ms.

Claims: at least 30 times as many steps a second as MuJoCo's ``mj_step`` on a mass on one slide
joint with RK4, and at most 1.5 times the time of the same equations in C (gcc -O2). All are
measured in turn; each number is the median of the turns.
"""

import ctypes
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.effects import ViscousFriction
from pam_ros.effects.base import Effect
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint

STEPS = 100_000
STEP = 1e-3  # s
TURNS = 15
PRESSURE = 600e3  # Pa
SOURCE = Path(__file__).with_name('_plant_step.c')
SLIDER = """
<mujoco>
  <option timestep="0.001" integrator="RK4" gravity="0 0 -9.80665"/>
  <worldbody>
    <body>
      <joint name="slide" type="slide" axis="0 0 1" stiffness="13900" damping="158"/>
      <geom type="sphere" size="0.05" mass="20"/>
    </body>
  </worldbody>
</mujoco>
"""


def mujoco_slider() -> Callable[[], float]:
    """Return MuJoCo's mass on one slide joint, with the muscle's stiffness and damping."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(SLIDER)
    data = mujoco.MjData(model)

    def run() -> float:
        mujoco.mj_resetData(model, data)
        mujoco.mj_step(model, data, nstep=STEPS)
        return float(data.qpos[0])

    return run


def plain_c(folder: str, compiler: str) -> Callable[[], float]:
    """Return the paper's rig in C, compiled here."""
    library = Path(folder, 'plant_step.so')
    subprocess.run([compiler, '-O2', '-shared', '-fPIC', '-o', library, SOURCE, '-lm'], check=True)
    advance = ctypes.CDLL(str(library)).advance
    pointer = ctypes.POINTER(ctypes.c_double)
    advance.argtypes = [pointer, pointer, ctypes.c_double, ctypes.c_long, ctypes.c_double]
    advance.restype = None
    joint = single_muscle_joint()
    muscle, load = joint.muscle, joint.load
    constants = np.array([*muscle.si, muscle.zeta, muscle.l0, load.mass, *load.numbers])

    def run() -> float:
        state = np.zeros(2)
        row, x = constants.ctypes.data_as(pointer), state.ctypes.data_as(pointer)
        advance(row, x, PRESSURE, STEPS, STEP)
        return float(state[0])

    return run


def rig(effects: Sequence[Effect]) -> Callable[[], float]:
    """Return this package's rig as a node steps it."""
    plant = Simulation([single_muscle_joint(effects=effects)], STEP)

    def run() -> float:
        plant.reset([PRESSURE], [0.0], [0.0])
        plant.advance(STEPS)
        return float(plant.position[0])

    return run


def main() -> None:
    """Measure all in turn and print the table."""
    compiler = shutil.which('gcc')
    if compiler is None or not HAVE_NUMBA:
        sys.exit('this benchmark needs gcc (sudo apt install gcc) and numba')
    with tempfile.TemporaryDirectory() as folder:
        contestants = {
            'MuJoCo, one slider, RK4': mujoco_slider(),
            'plain C, gcc -O2': plain_c(folder, compiler),
            'pam_ros': rig(()),
            'pam_ros, one effect of all': rig([ViscousFriction(coefficient=1e-9)]),
        }
        ends = {name: run() for name, run in contestants.items()}  # warm, and checked
        assert abs(ends['pam_ros'] - ends['plain C, gcc -O2']) < 1e-12, 'not the same equations'
        took: dict[str, list[float]] = {name: [] for name in contestants}
        for _ in range(TURNS):
            for name, run in contestants.items():
                begin = time.perf_counter()
                run()
                took[name].append((time.perf_counter() - begin) / STEPS * 1e9)
    medians = {name: float(np.median(times)) for name, times in took.items()}
    print(
        f'median of {TURNS} turns of {STEPS} steps, load {os.getloadavg()[0]:.1f} on '
        f'{os.cpu_count()} cores'
    )
    print(f'{"":28} {"ns/step":>9} {"best":>9} {"steps/s":>12} {"of pam_ros":>11}')
    for name, median in medians.items():
        ratio = median / medians['pam_ros']
        best = min(took[name])
        print(f'{name:28} {median:9.1f} {best:9.1f} {1e9 / median:12.3g} {ratio:11.2f}')
    mujoco, c = (medians[name] for name in list(contestants)[:2])
    print(f'steps a second, pam_ros / MuJoCo: {mujoco / medians["pam_ros"]:.0f} (at least 30)')
    print(f'time a step, pam_ros / plain C: {medians["pam_ros"] / c:.2f} (at most 1.5)')


if __name__ == '__main__':
    main()
