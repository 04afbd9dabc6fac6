# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The unknowns of a fit: entries of the parameter row, and the state at the start of a run.

Every unknown has a prior, a normal distribution of its coordinate u around 0. The priors of
constants and of starts are prior knowledge; those of an effect's parameters are wide, see
:func:`proper`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, log, sqrt

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.segment import CommandedSegment, Segment, start_of
from pam_ros.identification.fit.of_rig import OfRig
from pam_ros.identification.fit.places import INITIAL, Place, names_of_muscles
from pam_ros.muscle.constants import CONSTANTS
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import Layout

Array = NDArray[np.float64]

# Expected relative difference of a specimen's constants from the nominal ones of its type. The
# small a1 is a correction to a5, and published values differ by more than its size: a share of
# a5 is added. The damping ratio is a guess rather than a constant.
SPECIMEN = 0.03
A1_OF_A5 = 0.01
DAMPING = 0.5
# Standard deviations of the state at a run's start, relative to that of the noise: 1 and 1/s. A
# parabola through 30 ms gives the velocity with an error of some 100 times the noise per second.
START_Y_SPREAD, START_V_SPREAD = 2.0, 200.0
# Standard deviations of the prior of an effect's parameters. That of a strength is three times its
# typical size, which is an order of magnitude. A positive parameter is expected within a factor
# e^1.5 = 4.5 of its starting value, and starting values are a factor of 5 to 10 apart.
STRENGTH, FACTOR = 3.0, 1.5


@dataclass(frozen=True)
class Constant:
    """A constant of a muscle; *indices* are its places among the parameters.

    *which* is its index in the kernel's row: A1 to A6, or ZETA. *muscle* is the muscle's number.
    """

    name: str
    indices: tuple[int, ...]
    which: int
    muscle: int = 0


@dataclass(frozen=True)
class OfEffect:
    """A parameter of an effect; *indices* are its places among the parameters.

    *place* is the name of the effect's place, *parameter* that of its parameter, and *name* is its
    name in a file of parameters.
    """

    place: str
    parameter: str
    name: str
    indices: tuple[int, ...]


@dataclass(frozen=True)
class OnsetTime:
    """The time in s, on the clock of the recording, at which all unknown effects begin."""

    name: str = 'onset'


@dataclass(frozen=True)
class RunStart:
    """The position or the velocity at the start of the run with this number."""

    run: int
    is_velocity: bool

    @property
    def name(self) -> str:
        """Its name in tables."""
        return f'{"v" if self.is_velocity else "y"}0[{self.run}]'


@dataclass(frozen=True)
class MemoryStart:
    """A hidden state of an effect at the start of a run, relative to its value after a long rest.

    ``row`` and ``column`` are its place in the state x, and ``place`` is the name of the effect's
    place. A rig that is already moving, or moved a minute ago, does not start from such a rest.
    """

    run: int
    row: int
    column: int
    place: str
    state: str

    @property
    def name(self) -> str:
        """Its name in tables."""
        of = '' if self.row <= at.MUSCLE else f' {self.row - at.MUSCLE + 1}'
        return f'{self.place}{of}: {self.state}[{self.run}]'


@dataclass(frozen=True)
class RunLevel:
    """The offset of the force of a run from that of the last run at the same length, in N.

    A muscle that was brought to another length settles there for many minutes, and the zero of a
    force cell drifts. The best prediction of a drifting value is its last value (the local level
    model; Durbin and Koopman 2012, section 2.2). So the force law is that of the last runs, which
    have no level.
    """

    run: int

    @property
    def name(self) -> str:
        """Its name in tables."""
        return f'level[{self.run}]'


@dataclass(frozen=True)
class RunNumber:
    """The number *of* a rig in the runs of one recording, if it differs from the other ones."""

    runs: tuple[int, ...]
    of: OfRig

    @property
    def name(self) -> str:
        """Its name in tables."""
        return f'{self.of.name}[{self.runs[0]}]'


@dataclass(frozen=True)
class CommandTime:
    """The time in s by which commands acted before their stamps of receipt, equal in all runs.

    It is unknown if the clock of the commands is not that of the outputs. A lag or a dead time is
    known no more accurately than this time.
    """

    name: str = 'command time'


OF_RUNS = (RunStart, MemoryStart, RunLevel)
OF_RETUNING = (Constant, OfRig)


@dataclass(frozen=True)
class Unknown:
    """One number to be fitted, without unit: value = base + scale u, or base exp(scale u).

    ``of`` is the quantity that it describes. ``prior`` is the prior standard deviation of u around
    0, infinite if nothing is known. ``low``, ``high`` bound the value.
    """

    of: (
        Constant
        | OfRig
        | OfEffect
        | OnsetTime
        | CommandTime
        | RunStart
        | MemoryStart
        | RunLevel
        | RunNumber
    )
    base: float
    scale: float
    low: float = -np.inf
    high: float = np.inf
    prior: float = np.inf
    logarithmic: bool = False

    @property
    def name(self) -> str:
        """Its name in tables."""
        return self.of.name

    @property
    def is_parameter(self) -> bool:
        """Whether it is a parameter of the model, which all runs share."""
        return isinstance(self.of, Constant | OfRig | OfEffect)

    def value(self, u: float) -> float:
        """Return the physical value at u, limited to its bounds in spite of rounding."""
        move = self.scale * u
        value = self.base * exp(move) if self.logarithmic else self.base + move
        return min(max(value, self.low), self.high)

    def coordinate(self, value: float) -> float:
        """Return u at a physical value; infinite if its logarithm is not finite."""
        if self.logarithmic:
            if value <= 0.0:
                return -np.inf
            return log(value / self.base) / self.scale if np.isfinite(value) else np.inf
        return (value - self.base) / self.scale

    @property
    def bounds(self) -> tuple[float, float]:
        """Bounds of u."""
        return self.coordinate(self.low), self.coordinate(self.high)


def nominal_unknowns(model: Joint, muscles: Sequence[str] = ()) -> list[Unknown]:
    """Return the nominal parameters that re-tuning may change: a1..a6 and zeta if not 0.

    Each muscle has its own, since muscles are specimens; *muscles* are the names of several. The
    mass, the length and the limits are measured with a scale and a ruler: a residual that they
    explain is an effect (payload, length offset).
    """
    names = names_of_muscles(model, muscles)
    several = len(names) > 1
    return [
        unknown
        for i, name in enumerate(names)
        for unknown in _constants(model, i, f'{name}.' if several else '')
    ]


def _constants(model: Joint, i: int, whose: str) -> list[Unknown]:
    """Return the constants of muscle number i, whose names begin with *whose*."""
    q, layout = model.parameters().ravel(), model.layout
    found = []
    for name, which in zip(CONSTANTS, range(at.A1, at.A6 + 1), strict=True):
        index = layout.constant(which, i)
        if q[index] != 0.0:
            scale = SPECIMEN * abs(q[index])
            if which == at.A1:
                scale += A1_OF_A5 * abs(q[layout.constant(at.A5, i)])
            of = Constant(f'{whose}{name}', (index,), which, i)
            found.append(Unknown(of, q[index], scale, prior=1.0))
    index = layout.constant(at.ZETA, i)
    if q[index] != 0.0:
        zeta = Constant(f'{whose}zeta', (index,), at.ZETA, i)
        found.append(Unknown(zeta, q[index], DAMPING, 0.0, 5.0, 1.0, logarithmic=True))
    return found


def run_unknowns(segments: Sequence[Segment], sigma: float) -> list[Unknown]:
    """Return position and velocity at the start of each free run with samples to fit.

    *sigma* is the noise of the position in m or rad. A start without a prior would hide an error
    of the model, above all if no spring returns the load. So it stays as near to the measurement
    as its noise and the curvature of the first samples allow. With an infinite *sigma*, for short
    runs of a load without a spring, it is free.
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
            for is_velocity, first, scale in ((False, s.y0, y), (True, s.v0, v)):
                found.append(Unknown(RunStart(k, is_velocity), first, scale, prior=prior))
    return found


def time_unknowns(segments: Sequence[Segment]) -> list[Unknown]:
    """Return the time between the stamps and the effect of commands, if it is unknown."""
    commanded = [s for s in segments if isinstance(s, CommandedSegment)]
    spread = max((s.drive_spread for s in commanded), default=0.0)
    return [Unknown(CommandTime(), 0.0, spread, prior=1.0)] if spread else []


def onset_unknown(segments: Sequence[Segment], near: float, is_searched: bool = True) -> Unknown:
    """Return the time in s at which effects begin, as an unknown that is searched *near* a time.

    The only prior knowledge is that it lies within the recording. It is not searched if the
    samples that show it are left out.
    """
    first, last = segments[0].t[0], max(s.t[-1] for s in segments)
    spread = (last - first) / sqrt(12.0)  # of a uniform distribution
    low, high = (first, last) if is_searched else (near, near)
    return Unknown(OnsetTime(), near, 1.0, low, high, spread)


def effect_unknowns(model: Joint, place: Place, start: Mapping[str, float]) -> list[Unknown]:
    """Return the parameters of the effect at *place* that a fit from *start* changes.

    These are the ones named in *start*; a parameter that is not named keeps its default. Strengths
    are linear in u, so that they can reach 0; other parameters are exponential in u if they must
    be positive.
    """
    found = []
    for k, p in enumerate(place.parameters):
        if p.name not in start:
            continue
        positive = p.low > 0.0 or (p.low == 0.0 and not p.strength and start[p.name] > 0.0)
        for name, indices in place.split(model.layout, k):
            of = OfEffect(place.name, p.name, name, indices)
            if positive and not p.strength:
                low = max(p.low, 1e-6 * start[p.name])
                unknown = Unknown(of, start[p.name], 1.0, low, p.high, logarithmic=True)
            else:
                unknown = Unknown(of, 0.0, p.scale, p.low, p.high)
            found.append(unknown)
    return found


def proper(unknown: Unknown) -> Unknown:
    """Return *unknown* with a wide prior if it has none, since an evidence needs a proper one."""
    if np.isfinite(unknown.prior):
        return unknown
    return replace(unknown, prior=FACTOR if unknown.logarithmic else STRENGTH)


def memory_unknowns(layout: Layout, place: Place, runs: int) -> list[Unknown]:
    """Return the hidden states of the effect at *place* at the start of each of *runs* runs.

    These are the states with a spread above 0, which the effect defines; each muscle has its own.
    There are none if a parameter of the effect, ``initial``, already gives its initial memory.
    """
    if any(p.name == INITIAL for p in place.parameters):
        return []
    return [
        Unknown(
            MemoryStart(run, row, layout.state_at[place.effect.name] + i, place.name, state.name),
            0.0,
            state.spread,
            prior=1.0,
        )
        for run in range(runs)
        for row in place.rows
        for i, state in enumerate(place.states)
        if state.spread > 0.0
    ]


def parameters_of(unknowns: Sequence[Unknown], place: str) -> set[str]:
    """Return the names of those parameters of the effect at *place* that are among *unknowns*."""
    return {k.of.parameter for k in unknowns if isinstance(k.of, OfEffect) and k.of.place == place}
