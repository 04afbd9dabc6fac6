# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A pressure programme that distinguishes the effects of a joint, within its limits."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import PamError
from pam_ros.excitation.segments import SEGMENTS
from pam_ros.excitation.settings import Excitation

Array = NDArray[np.float64]

RAMP = 1.5  # s of a ramp: between segments, at the start and at the end
REST = 1.0  # s vented at the start and at the end


@dataclass(frozen=True)
class ProgrammeSegment:
    """A part of a programme: commands start..stop-1, and the effects that it shows."""

    name: str
    start: int
    stop: int
    text: str


@dataclass(frozen=True, eq=False)
class Programme:
    """Commands in gauge Pa, (n, muscles), *rate* a second, in segments; vented at both ends."""

    rate: float
    pressure: Array
    segments: tuple[ProgrammeSegment, ...]

    @property
    def t(self) -> Array:
        """Return the times of the commands in s, (n,)."""
        return np.arange(len(self.pressure)) / self.rate

    @property
    def duration(self) -> float:
        """Return the length in s."""
        return len(self.pressure) / self.rate

    def at(self, elapsed: float) -> Array:
        """Return the pressures in Pa to command *elapsed* s after the start, (muscles,)."""
        k = int(elapsed * self.rate + 1e-6)
        row: Array = self.pressure[min(max(k, 0), len(self.pressure) - 1)]
        return row

    def segment_at(self, elapsed: float) -> ProgrammeSegment:
        """Return the segment that is played *elapsed* s after the start."""
        k = int(elapsed * self.rate + 1e-6)
        return next((s for s in self.segments if k < s.stop), self.segments[-1])


def programme(settings: Excitation, sides: Sequence[int] = (1,)) -> Programme:
    """Return the programme of *settings*; equal arguments give bitwise equal programmes.

    *sides* has a number for each muscle: 1 if it moves the joint in the same direction as the
    first muscle, -1 if in the opposite direction. The default is one muscle. Vented, ramp in, the
    segments of the settings in their order, ramp out, vented. The segments share the duration:
    each is longer if there are fewer. All is within the limit of the rate and, between the ramps
    in and out, within the limits of pressure.
    """
    rate = settings.rate
    time = settings.duration - 2.0 * REST - (len(settings.segments) + 1) * RAMP
    # Of this time, each segment has its share if all are played.
    time *= sum(s.share for s in SEGMENTS.values()) / sum(
        SEGMENTS[n].share for n in settings.segments
    )
    levels: list[Array] = []
    segments: list[ProgrammeSegment] = []
    count = 0
    low, span = settings.pressure_min, settings.pressure_max - settings.pressure_min
    vented = np.zeros((round(REST * rate), len(sides)))
    last = vented[0]

    def add(name: str, pressure: Array, text: str) -> None:
        nonlocal count
        levels.append(pressure)
        segments.append(ProgrammeSegment(name, count, count + len(pressure), text))
        count += len(pressure)

    add('vented', vented, 'the state to start from')
    rng = np.random.default_rng(settings.seed)
    for name in settings.segments:
        kind = SEGMENTS[name]
        # The steps that are repeated have the levels of the first ones.
        source = np.random.default_rng(settings.seed) if name == 'steps_again' else rng
        part = kind.levels(rate, kind.share * time, source, settings.frequency_max, sides)
        pressure = low + span * part
        add(name, np.concatenate((_ramp(last, pressure[0], rate), pressure)), kind.text)
        last = pressure[-1]
    add('ramp out, vented', np.concatenate((_ramp(last, vented[0], rate), vented)), '')
    step = settings.pressure_rate / rate
    whole = np.concatenate(levels)
    limited = np.column_stack([limit_rate(of_muscle, step) for of_muscle in whole.T])
    # With a slow limit of the rate the pressure may not be 0 yet.
    rest: list[Array] = [limited[-1]]
    while np.any(rest[-1] > 0.0):
        rest.append(np.maximum(rest[-1] - step, 0.0))
    limited = np.concatenate((limited, np.array(rest)[1:]))
    segments[-1] = ProgrammeSegment(segments[-1].name, segments[-1].start, len(limited), '')
    return Programme(rate, limited, tuple(segments))


def limit_rate(pressure: Array, step: float) -> Array:
    """Return *pressure*, (n,), with changes of at most *step* from one command to the next."""
    limited = np.empty_like(pressure)
    now = float(pressure[0])
    for k, wanted in enumerate(pressure.tolist()):
        now = min(max(wanted, now - step), now + step)
        limited[k] = now
    return limited


def _ramp(start: Array, stop: Array, rate: float) -> Array:
    """Return a smooth path from some pressures to others: a raised cosine over RAMP s."""
    x = np.arange(1, round(RAMP * rate) + 1)[:, None] / round(RAMP * rate)
    wave: Array = start + (stop - start) * 0.5 * (1.0 - np.cos(np.pi * x))
    return wave


def plan(programme: Programme, settings: Excitation) -> str:
    """Return the table of a programme for the user to read before it starts."""
    lines = [f'{"segment":<18} {"from":>7} {"to":>7}  {"pressure":<15} shows']
    for s in programme.segments:
        part = programme.pressure[s.start : s.stop] / 1e3
        span = f'{part.min():.0f} to {part.max():.0f} kPa'
        lines.append(
            f'{s.name:<18} {s.start / programme.rate:6.1f}s {s.stop / programme.rate:6.1f}s  '
            f'{span:<15} {s.text}'.rstrip()
        )
    fastest = float(np.max(np.abs(np.diff(programme.pressure, axis=0)))) * programme.rate
    lines.append(
        f'total {programme.duration:.1f} s, up to {programme.pressure.max() / 1e3:.0f} kPa and '
        f'{fastest / 1e3:.0f} kPa/s, {programme.rate:g} commands a second, seed {settings.seed}'
    )
    return '\n'.join(lines)


def write_csv(programme: Programme, path: Path, muscles: Sequence[str]) -> None:
    """Write the commands as ``t_s,pressure_command_Pa``; raises PamError if this fails.

    Of several *muscles* each column has the name of its muscle: ``flexor.pressure_command_Pa``.
    """
    names = [f'{muscle}.' for muscle in muscles] if len(muscles) > 1 else ['']
    rows = np.column_stack((programme.t, programme.pressure)).tolist()
    partial = path.with_name(path.name + '.part')
    try:
        with partial.open('w', newline='', encoding='utf-8') as stream:
            writer = csv.writer(stream, lineterminator='\n')
            writer.writerow(('t_s', *(f'{name}pressure_command_Pa' for name in names)))
            writer.writerows(rows)
        partial.replace(path)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise PamError(f'{path} cannot be written: {error.strerror}') from error
