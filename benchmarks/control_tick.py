# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time that one tick of the sliding-mode law takes, for one muscle, a pair and a crank.

A closed loop at 500 Hz follows a sine of 0.5 Hz on a simulated joint; only the ticks are timed.
One row has a valve lag that is not configured, so that the law uses its learned parameters. Claim:
a tick takes at most a tenth of its period. All rows are measured in turn; each number is the
median of the turns. The last column is relative to one evaluation of a muscle in plain Python, its
force and its damping (``MuscleModel.pull``), which is timed once after each tick.
"""

import os
import sys
import time
from math import cos, pi, sin

import numpy as np

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.effects import PressureLag
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import antagonistic_joint, single_muscle_joint
from pam_ros.rig.transmissions import Lever

TURNS = 15
TICKS = 1000  # of one turn: a period of the sine
PERIOD, STEPS = 2e-3, 2  # s, and the steps of the simulation in it
SWING, FREQUENCY = 0.1, 0.5  # of the reach, Hz
NOISE = 2e-4  # of the reach
LIMIT = 0.1  # of the period


class Loop:
    """A law on a joint, nominal or another *true* one."""

    def __init__(self, joint: Joint, true: Joint | None = None) -> None:
        """Rest in the middle of the reach."""
        self.law, self.rig = SlidingMode(joint), Simulation([true or joint])
        low, high = self.law.allocation.reach
        self._middle, self._reach = 0.5 * (low + high), high - low
        self.rig.reset(self.law.terms.pressures, self._middle, 0.0)
        self._rng = np.random.default_rng(1)

    def turn(self) -> tuple[float, float]:
        """Return the median times in s of a tick and of the force law over one sine."""
        law, rig, w = self.law, self.rig, 2.0 * pi * FREQUENCY
        pull, inertia = law.model.muscles[0].pull, law.model.inertia
        amplitude = SWING * self._reach
        noise = NOISE * self._reach * self._rng.normal(size=TICKS)
        took = np.zeros((TICKS, 2))
        for n in range(TICKS):
            angle = w * n * PERIOD
            s, c = amplitude * sin(angle), amplitude * cos(angle)
            reference = Reference(self._middle + s, w * c, -w * w * s, -w * w * w * c)
            measured = float(rig.position[0] + noise[n])
            begin = time.perf_counter()
            pressures = law.update(PERIOD, reference, measured)
            middle = time.perf_counter()
            pull(pressures[0], measured, reference.velocity, inertia)
            took[n] = middle - begin, time.perf_counter() - middle
            rig.command(pressures)
            rig.advance(STEPS)
        tick, once = np.median(took, axis=0).tolist()
        return tick, once


def main() -> None:
    """Measure all in turn and print the table."""
    if not HAVE_NUMBA:
        sys.exit('this benchmark needs numba')
    single = single_muscle_joint()
    contestants = {
        'one muscle': Loop(single),
        'one muscle, unknown lag': Loop(
            single, single_muscle_joint(effects=[PressureLag.example()])
        ),
        'pair': Loop(antagonistic_joint()),
        'crank': Loop(Joint((Actuator(contraction=0.1),), Arm(), Lever())),
    }
    took: dict[str, list[tuple[float, float]]] = {name: [] for name in contestants}
    for loop in contestants.values():
        loop.turn()
    for _ in range(TURNS):
        for name, loop in contestants.items():
            took[name].append(loop.turn())
    print(
        f'median of {TURNS} turns of {TICKS} ticks, load {os.getloadavg()[0]:.1f} on '
        f'{os.cpu_count()} cores'
    )
    print(f'{"":26}{"us/tick":>9}{"best":>9}{"of the period":>15}{"of the force law":>18}')
    for name, turns in took.items():
        tick, once = np.median(turns, axis=0).tolist()
        best, share = min(turns)[0], tick / PERIOD
        verdict = 'ok' if share <= LIMIT else 'SHORT'
        print(
            f'{name:26}{1e6 * tick:9.1f}{1e6 * best:9.1f}{100.0 * share:13.1f} %'
            f'{tick / once:18.1f}  {verdict}'
        )


if __name__ == '__main__':
    main()
