# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a fit may change: entries of the parameter row, and the state at the start of a run."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log

import numpy as np
from numpy.typing import NDArray

from pam_ros.effects.base import Effect
from pam_ros.identification.segment import Segment, start_of
from pam_ros.rig import layout as at
from pam_ros.rig.model import RigModel

Array = NDArray[np.float64]

CONSTANTS = ('a1', 'a2', 'a3', 'a4', 'a5', 'a6')
# How far a specimen's constants are expected from those declared for its type, relative. The
# small a1 is a correction to a5 and published values differ by more than its size: a share of
# a5 comes on top. The damping ratio is a guess more than a constant.
SPECIMEN = 0.03
A1_OF_A5 = 0.01
DAMPING = 0.5
# Standard deviations of the state at a run's start, in those of the noise: 1 and 1/s. A
# parabola through 30 ms knows the velocity to some 100 noises a second.
START_Y_SPREAD, START_V_SPREAD = 2.0, 200.0
# Indices of what a run has for itself, beside those of the parameter row.
START_Y, START_V = -1, -2


@dataclass(frozen=True)
class Unknown:
    """One number to be fitted, without unit: value = base + scale u, or base exp(scale u).

    ``index`` is the entry of the parameter row, or one of START_Y, START_V of the run
    ``segment``. ``prior`` is the standard deviation of u around 0 that is expected
    beforehand, infinite where nothing is known. ``low``, ``high`` bound the value.
    """

    name: str
    index: int
    base: float
    scale: float
    low: float = -np.inf
    high: float = np.inf
    prior: float = np.inf
    logarithmic: bool = False
    segment: int = -1

    def value(self, u: float) -> float:
        """Return the physical value at u, which rounding does not carry past its bounds."""
        move = self.scale * u
        value = self.base * exp(move) if self.logarithmic else self.base + move
        return min(max(value, self.low), self.high)

    def coordinate(self, value: float) -> float:
        """Return u at a physical value; infinite beyond what a logarithm can say."""
        if self.logarithmic:
            if value <= 0.0:
                return -np.inf
            return log(value / self.base) / self.scale if np.isfinite(value) else np.inf
        return (value - self.base) / self.scale

    @property
    def bounds(self) -> tuple[float, float]:
        """Bounds of u."""
        return self.coordinate(self.low), self.coordinate(self.high)


def declared_unknowns(model: RigModel) -> list[Unknown]:
    """Return the declared parameters that re-tuning may change: a1..a6 and zeta where not 0.

    The mass, the length and the limits are measured with a scale and a rule: a residual that
    they explain is an effect (payload, length offset).
    """
    q = model.row()
    found = []
    for name, index in zip(CONSTANTS, range(at.A1, at.A6 + 1), strict=True):
        if q[index] != 0.0:
            scale = SPECIMEN * abs(q[index])
            if index == at.A1:
                scale += A1_OF_A5 * abs(q[at.A5])
            found.append(Unknown(name, index, q[index], scale, prior=1.0))
    if q[at.ZETA] != 0.0:
        found.append(
            Unknown('zeta', at.ZETA, q[at.ZETA], DAMPING, 0.0, 5.0, 1.0, logarithmic=True)
        )
    return found


def run_unknowns(segments: Sequence[Segment], sigma: float) -> list[Unknown]:
    """Return position and velocity at the start of each free run that is fitted at all.

    *sigma* is the noise of the position in m. A start that is free to move would hide an error
    of the model, above all where no spring brings the load back: it stays as near to the
    measurement as its noise and the curvature of the first samples allow. With an infinite
    *sigma*, for thinned runs, it is free.
    """
    found = []
    for k, s in enumerate(segments):
        if s.kind == 'free' and s.fit.any():
            y, v, prior = 1e-3, 1e-2, np.inf
            if np.isfinite(sigma):
                bent = start_of(s.t, s.target, 3)
                y = START_Y_SPREAD * sigma + abs(bent[0] - s.y0) + 1e-9
                v = START_V_SPREAD * sigma + abs(bent[1] - s.v0) + 1e-9
                prior = 1.0
            found.append(Unknown(f'y0[{k}]', START_Y, s.y0, y, prior=prior, segment=k))
            found.append(Unknown(f'v0[{k}]', START_V, s.v0, v, prior=prior, segment=k))
    return found


def effect_unknowns(model: RigModel, effect: Effect, start: dict[str, float]) -> list[Unknown]:
    """Return the parameters of *effect* that a fit from *start* changes.

    Those named in *start*; a parameter that it leaves at its default stays there. Strengths
    move linearly, so that they can reach 0; the others by their logarithm where they must be
    positive.
    """
    j = model.layout.parameter_at[effect.name]
    found = []
    for k, p in enumerate(effect.parameters):
        if p.name not in start:
            continue
        positive = p.low > 0.0 or (p.low == 0.0 and not p.strength and start[p.name] > 0.0)
        name = f'effects.{effect.name}.{p.name}'
        if positive and not p.strength:
            low = max(p.low, 1e-6 * start[p.name])
            unknown = Unknown(name, j + k, start[p.name], 1.0, low, p.high, logarithmic=True)
        else:
            unknown = Unknown(name, j + k, 0.0, p.scale, p.low, p.high)
        found.append(unknown)
    return found
