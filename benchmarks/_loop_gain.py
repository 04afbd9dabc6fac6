# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Margins of the loop of the sliding-mode law, from its measured frequency response.

The loop is cut where the command enters the rig: a small sine is added to the command. The loop
gain is the command of the law divided by the sum that the rig receives, with the sign reversed
(Middlebrook 1975). So it is the gain of the running law and the running plant, around rest.
"""

from dataclasses import dataclass
from math import pi, sin

import numpy as np

from pam_ros.control.gains import Gains
from pam_ros.control.rest.rejection import Rejection
from pam_ros.control.signals import Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.rig.joint import Joint
from truth import TruthPlant

RATE, SIZE, SETTLES, PERIODS = 500.0, 500.0, 3.0, 6  # Hz, Pa, s, counted
FREQUENCIES = np.geomspace(1.0, 60.0, 48)  # Hz


@dataclass(frozen=True)
class Margins:
    """Highest frequency of gain 1, Hz; margins of phase in degrees, delay in s, gain in dB."""

    crossover: float
    phase: float
    delay: float
    gain: float


class HeldLevel(Rejection):
    """A rejection whose level does not change."""

    def hold(self, level: float) -> None:
        """Keep the *level*."""
        self.level = level

    def see(self, *seen: object, **more: object) -> None:
        """Ignore all measurements."""


def margins_of(level: float, plant: TruthPlant, joint: Joint) -> Margins:
    """Return the margins at a *level*, for a noiseless *plant* that is configured as *joint*."""
    response = np.array([_gain(level, plant, joint, f) for f in FREQUENCIES])
    size, phase = np.log(np.abs(response)), np.degrees(np.unwrap(np.angle(response)))
    fine = np.geomspace(FREQUENCIES[0], FREQUENCIES[-1], 20_000)
    size, phase = (np.interp(np.log(fine), np.log(FREQUENCIES), x) for x in (size, phase))
    cross = np.flatnonzero((size[:-1] > 0.0) & (size[1:] <= 0.0))[-1]
    turn = np.flatnonzero((phase[:-1] > -180.0) & (phase[1:] <= -180.0))
    margin = 180.0 + float(phase[cross])
    gain = -20.0 / np.log(10.0) * float(size[turn[-1]]) if turn.size else float('inf')
    at = float(fine[cross])
    return Margins(at, margin, margin / 360.0 / at, gain)


def _gain(level: float, plant: TruthPlant, joint: Joint, frequency: float) -> complex:
    """Return the gain of the loop at a *frequency* in Hz."""
    law = SlidingMode(joint, Gains(learning=False))
    law._estimates.rejection.__class__ = HeldLevel
    origin, dt = plant.reset(300e3), 1.0 / RATE
    law.start(origin, (plant.state.u,))
    law._estimates.rejection.hold(level)
    count, settles = round(PERIODS / frequency * RATE), round(SETTLES * RATE)
    measured, given, received = plant.measure(), [], []
    for n in range(settles + count):
        (command,) = law.update(dt, Reference(origin), measured)
        total = command + SIZE * sin(2.0 * pi * frequency * n * dt)
        measured = plant.step(total, dt)
        given.append(command)
        received.append(total)
    turn = np.exp(-2j * pi * frequency * dt * np.arange(settles, settles + count))
    answer, excitation = (
        complex(np.sum((np.array(x[settles:]) - np.mean(x[settles:])) * turn))
        for x in (given, received)
    )
    return -answer / excitation
