# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A gapless stretch of a recording, prepared for many simulations."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from pam_ros.errors import RecordingError
from pam_ros.identification.data.noise import noise_of
from pam_ros.recording.recording import Recording
from pam_ros.rig import layout as at
from pam_ros.rig.joint import Joint

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
# In standard deviations of the noise of a pressure: what smoothing may remove at most (slow
# changes give 1 to 1.3), and what a constant may leave at most, a tenth more than noise alone.
NOISES, CONSTANT = 2.0, 1.1


@dataclass(frozen=True, eq=False, kw_only=True)
class Segment(ABC):
    """A run of the simulator, compared with the measurement.

    t (n,) s; target (n,) the measured values of the simulated output, in ``unit``; fit (n,) marks
    the samples that may be used for fitting, the others are held out. y0, v0: first guess of the
    state at t[0]. ``recording`` is the number of its recording, and ``numbers`` are the numbers
    of the rig that this recording has instead of those of the joint.
    """

    kind: ClassVar[str]  # that of the recording
    quantity: ClassVar[str]  # name of the target

    name: str
    unit: str
    t: Array
    target: Array
    fit: Mask
    y0: float
    v0: float
    recording: int = 0
    numbers: Mapping[str, float] = field(default_factory=dict)

    @property
    @abstractmethod
    def column(self) -> int:
        """The column of its target in the runs of the simulator."""

    @property
    @abstractmethod
    def first_pressures(self) -> Array:
        """Pressure in Pa of each muscle, commanded or measured, at the start of the run."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CommandedSegment(Segment):
    """A run whose input are commands.

    drive_t (m,), drive (m, muscles): stamps in s and values in Pa of the commands. They may have
    acted earlier or later by a constant time, whose standard deviation is drive_spread in s.
    """

    drive_t: Array
    drive: Array
    drive_spread: float = 0.0

    @property
    def first_pressures(self) -> Array:
        """Commanded pressure in Pa of each muscle at the start of the run."""
        return np.asarray(self.commands(self.t[:1])[0])

    def commands(self, t: Array) -> Array:
        """Return the commands (n, muscles) in Pa that act at the times t (n,) in s."""
        before = np.searchsorted(self.drive_t, t, side='right') - 1
        return np.asarray(self.drive[np.maximum(before, 0)])


@dataclass(frozen=True, eq=False, kw_only=True)
class FreeSegment(CommandedSegment):
    """A run of a rig whose load moves: the output is its position in m or rad."""

    kind: ClassVar[str] = 'free'
    quantity: ClassVar[str] = 'position'

    @property
    def column(self) -> int:
        """The column of the coordinate."""
        return at.RUN_S


@dataclass(frozen=True, eq=False, kw_only=True)
class PressureSegment(CommandedSegment):
    """A run of the pressure path alone: the output is the pressure in a chamber in Pa.

    ``muscle`` is the number of the muscle whose chamber it is.
    """

    kind: ClassVar[str] = 'pressure'
    quantity: ClassVar[str] = 'pressure'

    muscle: int = 0

    @property
    def column(self) -> int:
        """The column of the pressure in its muscle."""
        return at.RUN_P + 2 * self.muscle


@dataclass(frozen=True, eq=False, kw_only=True)
class HeldSegment(Segment):
    """A run at a prescribed length.

    The inputs are the pressure in Pa (measured, or the command if it was not measured), position
    and velocity; the output is in N.
    """

    kind: ClassVar[str] = 'held'
    quantity: ClassVar[str] = 'force'

    pressure: Array
    position: Array
    velocity: Array

    @property
    def column(self) -> int:
        """The column of the force of the one muscle."""
        return at.RUN_F

    @property
    def first_pressures(self) -> Array:
        """Pressure in Pa at the start of the run."""
        return self.pressure[:1]


def require_one_kind(recordings: Sequence[Recording]) -> None:
    """Raise RecordingError if kinds are mixed, since one error cannot be in m and in N."""
    kinds = {r.kind for r in recordings}
    if len(kinds) > 1:
        names = ', '.join(f'{r.name} is {r.kind}' for r in recordings)
        raise RecordingError(f'recordings of one kind are needed: {names}')


def require_joint(recordings: Sequence[Recording], joint: Joint) -> None:
    """Raise RecordingError if one of *recordings* cannot be a recording of *joint*."""
    first = recordings[0]
    for recording in recordings:
        _require_joint(recording, joint)
        if recording.muscles != first.muscles:
            raise RecordingError(
                f'{recording.name} has the muscles {", ".join(recording.muscles)}, and '
                f'{first.name} has {", ".join(first.muscles)}: give the muscles in one order'
            )


def _require_joint(recording: Recording, joint: Joint) -> None:
    count, named = len(joint.muscles), len(recording.muscles) or 1
    if named != count:
        raise RecordingError(
            f'{recording.name} is a recording of {named} muscle(s), and the joint has {count}'
        )
    unit = joint.transmission.equations.unit
    if recording.kind != 'pressure' and recording.unit != unit:
        raise RecordingError(
            f'{recording.name}: the position is in {recording.unit}, and the joint moves in {unit}'
        )
    if recording.kind == 'held' and (count > 1 or joint.is_revolute):
        raise RecordingError(
            f'{recording.name} has a prescribed position (kind held), which is supported only '
            'for one muscle in line with its load: record the joint while it moves freely'
        )


def segments_of(recordings: Sequence[Recording]) -> list[Segment]:
    """Return the gapless stretches of *recordings*, ready for simulation, with all samples to fit.

    Raises RecordingError for recordings of several kinds, and if required data are missing.
    """
    require_one_kind(recordings)
    return [
        replace(segment, recording=k, numbers=recording.numbers)
        for k, recording in enumerate(recordings)
        for part in recording.segments()
        if part.t.size > 3
        for segment in (_of_chambers(part) if part.kind == 'pressure' else [_segment(part)])
    ]


def _of_chambers(part: Recording) -> list[Segment]:
    """Return the runs of the pressures in *part*, one for each muscle."""
    for name in ('command', 'pressure'):
        if getattr(part, name) is None:
            raise RecordingError(f'{part.name}: no {name} was recorded')
    drive_t, drive = part.drive(1e-3)
    assert part.pressure is not None
    return [
        PressureSegment(
            name=f'{part.name} ({part.muscles[i]})' if part.muscles else part.name,
            unit='Pa',
            t=part.t,
            target=target,
            fit=np.ones(part.t.size, dtype=bool),
            y0=0.0,
            v0=0.0,
            drive_t=drive_t,
            drive=drive.reshape(drive_t.size, -1),
            drive_spread=part.command_spread,
            muscle=i,
        )
        for i, target in enumerate(part.pressure.reshape(part.t.size, -1).T)
    ]


def _segment(part: Recording) -> Segment:
    fit = np.ones(part.t.size, dtype=bool)
    if part.position is None:
        raise RecordingError(f'{part.name}: no position was recorded')
    if part.kind == 'free':
        drive_t, drive = part.drive(1e-3)
        y0, v0 = start_of(part.t, part.position)
        return FreeSegment(
            name=part.name,
            unit=part.unit,
            t=part.t,
            target=part.position,
            fit=fit,
            y0=y0,
            v0=v0,
            drive_t=drive_t,
            drive=drive.reshape(drive_t.size, -1),
            drive_spread=part.command_spread,
        )
    if part.pressure is not None:
        pressure = _without_noise(part.t, part.pressure)
    else:
        assert part.command_t is not None
        assert part.command is not None
        # A sample is the state before a command of the same stamp has acted.
        at = np.searchsorted(part.command_t, part.t, side='left') - 1
        pressure = part.command[np.maximum(at, 0)]
    if part.force is None:
        raise RecordingError(f'{part.name}: no force was recorded')
    position, velocity = _motion(part.t, part.position)
    return HeldSegment(
        name=part.name,
        unit='N',
        t=part.t,
        target=part.force,
        fit=fit,
        y0=position[0],
        v0=velocity[0],
        pressure=pressure,
        position=position,
        velocity=velocity,
    )


def windows(segment: Segment, length: float) -> list[Segment]:
    """Return a free run cut into runs of *length* s, each starting from its own measurement.

    A load without a spring integrates every error without limit, so that a long run of a wrong
    model contains no information any more; short runs stay near the measurement.
    """
    span = segment.t[-1] - segment.t[0]
    edges = np.linspace(segment.t[0], segment.t[-1], max(1, round(span / length)) + 1)
    found = []
    for start, end in pairwise(edges):
        rows = np.flatnonzero((segment.t >= start) & (segment.t <= end))
        t, y = segment.t[rows], segment.target[rows]
        fit = np.ones(rows.size, dtype=bool)
        y0, v0 = start_of(t, y)
        found.append(replace(segment, t=t, target=y, fit=fit, y0=y0, v0=v0))
    return found


def start_of(t: Array, y: Array, degree: int = 2) -> tuple[float, float]:
    """Return position and velocity at t[0], from a polynomial through the first 30 ms.

    It is fitted to at least 6 samples.
    """
    n = min(t.size, max(6, int(np.searchsorted(t, t[0] + 0.03))))
    curve = np.polynomial.Polynomial.fit(t[:n] - t[0], y[:n], min(degree, n - 1))
    return float(curve(0.0)), float(curve.deriv()(0.0))


def _motion(t: Array, y: Array) -> tuple[Array, Array]:
    """Return the position without fast noise, at which friction would reverse, and its rate."""
    if np.ptp(y) == 0.0:
        return y, np.zeros_like(y)
    smooth = _smooth(t, y)
    return smooth, np.asarray(np.gradient(smooth, t), dtype=float)


def _without_noise(t: Array, p: Array) -> Array:
    """Return the pressure, as a constant or smoothed if this removes hardly more than noise.

    Noise of the input becomes noise of the simulated force. A lag of the pressure would reduce it,
    so that the search would find a lag. A pressure that jumps is not changed.
    """
    # The levels of a pressure that jumps can be multiples of a step, which is no resolution.
    noise = noise_of([(t, p)], [0.0]).sigma
    if float(np.std(p)) <= CONSTANT * noise:
        return np.full_like(p, np.mean(p))
    smooth = _smooth(t, p)
    return smooth if float(np.std(p - smooth)) <= NOISES * noise else p


def _smooth(t: Array, y: Array) -> Array:
    """Return the values of parabolas fitted to the 0.1 s around each sample."""
    n = min(t.size, max(5, int(0.1 / np.median(np.diff(t))))) | 1
    return np.asarray(savgol_filter(y, n if n <= t.size else n - 2, 2), dtype=float)
