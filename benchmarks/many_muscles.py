# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The time of a step of 1, 8 and 64 muscles, each alone with its load or in pairs.

Claims: the time of a step grows at most in proportion to the number of muscles, and a muscle of a
joint takes at most 1.3 times as long as one with its own load. All are called once for STEPS
steps of 1 ms a muscle. All rigs are measured in turn; each number is the median of the turns, in
CPU time, which depends least on other programs.
"""

import os
import sys
import time
from collections.abc import Sequence

import numpy as np

from pam_ros.compiled import HAVE_NUMBA
from pam_ros.effects import ViscousFriction
from pam_ros.effects.base import Effect
from pam_ros.rig.joint import Actuator, Joint
from pam_ros.rig.loads import Arm, Mass
from pam_ros.rig.simulation import Simulation
from pam_ros.rig.standard_joints import single_muscle_joint
from pam_ros.rig.transmissions import Pulley

STEPS = 64_000  # of one muscle; with n muscles a share of 1/n, so that each turn takes as long
STEP = 1e-3  # s
TURNS = 15
MUSCLES = (1, 8, 64)
# An effect that is present but negligible: the kernel then computes all effects of the library.
SLIGHT = [ViscousFriction(coefficient=1e-9)]


def rigs(effects: Sequence[Effect]) -> dict[str, Simulation]:
    """Return rigs by name, with as many muscles as the name says."""
    single = single_muscle_joint(effects=effects)
    hung = Actuator(contraction=0.1)
    pair = Joint((hung, hung), Arm(), Pulley(), effects)
    parallel = Joint((Actuator(), Actuator()), Mass(mass=40.0), effects=effects)
    found = {f'{n:2} alone': Simulation([single] * n, STEP) for n in MUSCLES}
    found |= {f'{2 * n:2} in {n} pairs': Simulation([pair] * n, STEP) for n in (1, 4, 32)}
    found[' 2 in parallel'] = Simulation([parallel], STEP)
    found['64, 32 alone, 16 pairs'] = Simulation([single] * 32 + [pair] * 16, STEP)
    return found


def start(rig: Simulation) -> None:
    """Start a rig again away from its equilibrium, so that it moves."""
    still = np.zeros(len(rig.position))
    rig.reset(np.full(len(rig.pressure), 3e5), still, still)


def main() -> None:
    """Measure all in turn and print the table."""
    if not HAVE_NUMBA:
        sys.exit('this benchmark needs numba')
    kinds = {'no effects': rigs(()), 'all effects bound': rigs(SLIGHT)}
    contestants = {(kind, name): rig for kind in kinds for name, rig in kinds[kind].items()}
    took: dict[tuple[str, str], list[float]] = {key: [] for key in contestants}
    for turn in range(TURNS + 1):
        for key, rig in contestants.items():
            steps = STEPS // len(rig.pressure)
            start(rig)
            begin = time.thread_time()
            rig.advance(steps)
            spent = time.thread_time() - begin
            if turn:  # the first is a warm-up
                took[key].append(spent / (steps * len(rig.pressure)) * 1e9)
    print(f'median of {TURNS} turns, load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores')
    print(f'{"muscles":24} {"effects":18} {"ns/step/muscle":>15} {"best":>8} {"of 1 alone":>11}')
    for (kind, name), times in took.items():
        median, alone = float(np.median(times)), float(np.median(took[kind, ' 1 alone']))
        print(f'{name:24} {kind:18} {median:15.1f} {min(times):8.1f} {median / alone:11.2f}')


if __name__ == '__main__':
    main()
