# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One muscle, and two against each other: what a test gives to either, and in which units."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from pam_ros.rig.joint import Joint
from support import closed_loop, pair_loop
from truth.pair import pair_plant


@dataclass(frozen=True)
class Kind:
    """A joint on which laws are judged.

    configured  returns it as a controller knows it, with effects in each muscle
    truth     returns a plant of the benchmarks by name, with noise and seed
    close     runs a law on such a plant: law, plant, target, seconds
    unit      what errors are counted in: 1 mm or 1 degree, in m or rad
    step      a target that moves once; swing: a sine
    """

    name: str
    nominal: Callable[..., Joint]
    truth: Callable[..., Any]
    close: Callable[..., Any]
    unit: float
    step: Callable[[float], float]
    swing: Callable[[float], float]

    def __str__(self):
        return self.name


def _nominal(effects=()):
    return closed_loop.nominal(effects=effects)


ONE = Kind(
    *('one muscle', _nominal, closed_loop.truth, closed_loop.close_loop, 1e-3),
    *(closed_loop.step_target(0.02), closed_loop.sine_target(0.01, 0.5)),
)
PAIR = Kind(
    *('pair', pair_loop.nominal, pair_plant, pair_loop.close_pair, math.radians(1.0)),
    lambda t: 0.2 if t > 0.5 else 0.0,
    closed_loop.sine_target(math.radians(15.0), 0.5),
)
EACH_KIND = pytest.mark.parametrize('kind', [ONE, PAIR], ids=str)


def rms(kind, run, seconds=4.0):
    """Return the RMS of the error in the last *seconds*, in units of the kind."""
    return np.sqrt(np.mean(run.error[run.last(seconds)] ** 2)) / kind.unit


def at_end(kind, run, seconds=2.0):
    """Return the largest error in units of the kind and swing of a pressure in Pa at the end."""
    end = run.last(seconds)
    error = np.max(np.abs(run.error[end])) / kind.unit
    return error, np.max(np.ptp(np.atleast_2d(run.pressure)[:, end], axis=1))
