# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Warn of poor data in a recording, after a check that refuses an unusable recording."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.bounds import Bounds
from pam_ros.recording.inputs import (
    Input,
    driving,
    input_of,
    is_constant,
    is_stretched,
    outputs,
)
from pam_ros.recording.recording import Recording
from pam_ros.recording.unusable import PERIODS, refuse_unusable

Array = NDArray[np.float64]

SHORT = 10.0  # s
SLOW = 0.05  # s between samples; above, there are few in an oscillation of a free load
RESTING = 0.02  # share of samples at an extreme value above which it may be a stop
SATURATED = 0.6  # an input with a greater share of samples at one end of its range is poor
LEVELS = 100  # a signal with fewer distinct values is called coarse
SMALL_RANGE = 0.2  # of the input's largest value
AGAINST = -0.5  # correlation of position and pressure below which one has the wrong sign
UNKNOWN = Bounds()
SMALL_MOTION = 1e-3  # of the length or the reach; a muscle normally moves by some hundredths


def check(recording: Recording, bounds: Bounds = UNKNOWN) -> tuple[str, ...]:
    """Return the warnings on *recording*; raise RecordingError if it cannot be used.

    *bounds* are those of its joint, if they are known: they make the checks of units stricter.
    """
    l0, reach = bounds.l0, bounds.reach
    inputs = driving(recording, bounds.p_max or None)
    refuse_unusable(recording, inputs, l0, reach)
    return (
        *_warn_slow(recording),
        *_warn_gaps(recording),
        *_warn_range(recording, l0, inputs),
        *_warn_small(recording, l0, inputs, reach),
        *_warn_direction(recording, inputs),
        *_warn_idle_force(recording),
        *_warn_extremes(recording, inputs),
        *_warn_coarse(recording),
        *_warn_excitation(recording, inputs),
    )


def _warn_slow(recording: Recording) -> tuple[str, ...]:
    if recording.period <= (PERIODS[1] if recording.kind == 'held' else SLOW):
        return ()
    return (f'samples are {recording.period:.4g} s apart: is the time in another unit?',)


def _warn_gaps(recording: Recording) -> list[str]:
    if not recording.gaps:
        return []
    longest = max(recording.gaps, key=lambda gap: gap[1] - gap[0])
    total = sum(end - start for start, end in recording.gaps)
    return [
        f'{len(recording.gaps)} gap(s) without samples, {total:.3g} s in all, the longest '
        f'{longest[1] - longest[0]:.3g} s at {longest[0]:.4g} s: each part is simulated separately'
    ]


def _warn_range(recording: Recording, l0: float | None, inputs: Sequence[Input]) -> list[str]:
    found = []
    if l0 is not None and recording.position is not None:
        most = float(np.max(np.abs(recording.position)))
        if most > 0.6 * l0:
            found.append(f'position reaches {most:.4g} m, l0 is {l0:g} m: are both correct?')
    for one in inputs:
        most = float(np.max(one.values))
        if one.p_max is not None and most > 1.05 * one.p_max:
            found.append(f'{one.name} reaches {most:.6g} Pa, above p_max = {one.p_max:g} Pa')
    if recording.pressure is not None and recording.command is not None:
        lowest = float(np.min(recording.pressure))
        if 8e4 < lowest < 1.15e5 and np.min(recording.command) < 2e4:
            found.append(
                f'pressure never falls below {lowest:.6g} Pa though the command does: is it '
                "absolute? Pressures are gauge: --column 'NAME=pressure_Pa-101325'"
            )
    return found


def _warn_small(
    recording: Recording,
    l0: float | None,
    inputs: Sequence[Input],
    reach: tuple[float, float] | None,
) -> list[str]:
    """Warn of a free load that hardly moves while its pressure changes (or m was labelled mm)."""
    whole = (reach[1] - reach[0] if reach is not None else None) if l0 is None else l0
    if recording.kind != 'free' or recording.position is None or whole is None:
        return []
    moved = float(np.ptp(recording.position))
    changes = [float(np.ptp(one.values)) / one.p_max for one in inputs if one.p_max is not None]
    if moved >= SMALL_MOTION * whole or max(changes, default=0.0) < SMALL_RANGE:
        return []
    of = 'its reach' if l0 is None else f'l0 = {l0:g} m'
    return [
        f'position moves by {moved:.3g} {recording.unit} only, {100 * moved / whole:.2g} % of '
        f'{of}, while the pressure changes by {100 * max(changes):.0f} % of p_max: is it in '
        f'another unit (position_{recording.unit}), or does something block the load?'
    ]


def _warn_direction(recording: Recording, inputs: Sequence[Input]) -> list[str]:
    """Warn of a position that increases when the muscle gets longer."""
    y = recording.position
    if recording.kind != 'free' or y is None or recording.unit != 'm' or np.ptp(y) == 0.0:
        return []
    p = inputs[0].values
    if np.ptp(p) == 0.0 or float(np.corrcoef(p, y)[0, 1]) > AGAINST:
        return []
    return [
        f'position falls where {inputs[0].name} rises: a shorter muscle has a greater position; '
        "change its sign with --column 'NAME=position_mm*-1+OFFSET', where NAME is the column, mm "
        'its unit and OFFSET what it gives where the muscle has its length at rest'
    ]


def _warn_idle_force(recording: Recording) -> list[str]:
    return [
        f'{name} is {values[0]:.6g} {si} in every sample: is the force cell connected?'
        for name, values, si in outputs(recording)
        if name.rpartition('.')[2] == 'force' and np.ptp(values) == 0.0
    ]


def _warn_extremes(recording: Recording, inputs: Sequence[Input]) -> list[str]:
    """Warn of measured outputs that stay at their lowest or highest value.

    A pressure that does so at a constant command is not a sensor at its limit.
    """
    found = []
    for name, value, si in outputs(recording):
        if np.ptp(value) == 0.0:
            continue
        quantity, drive = name.rpartition('.')[2], input_of(name, inputs)
        for word, extreme in (('lowest', np.min(value)), ('highest', np.max(value))):
            at = value == extreme
            runs = np.count_nonzero(at[1:] & at[:-1])
            if at.mean() < RESTING or runs < 0.5 * np.count_nonzero(at):
                continue
            under = drive.values[at]
            is_commanded = drive.quantity != quantity and np.ptp(under) < 0.01 * np.ptp(
                drive.values
            )
            if quantity != 'pressure' or not is_commanded:
                found.append(
                    f'{name} stays at its {word} value, {extreme:.6g} {si}, in '
                    f'{100 * at.mean():.0f} % of the samples: a sensor at its limit, or a stop?'
                )
    return found


def _warn_coarse(recording: Recording) -> list[str]:
    found = []
    for name, value, si in outputs(recording):
        if np.ptp(value) == 0.0 or value.size < 10 * LEVELS:
            continue
        levels = np.unique(value)
        if levels.size < LEVELS:
            step = float(np.median(np.diff(levels)))
            found.append(
                f'{name} takes only {levels.size} values, {step:.3g} {si} apart: smaller '
                'changes cannot be seen'
            )
    return found


def _warn_excitation(recording: Recording, inputs: Sequence[Input]) -> list[str]:
    found = []
    if recording.duration < SHORT:
        found.append(f'only {recording.duration:.3g} s long: slow effects cannot be seen')
    if not is_stretched(recording):
        for one in inputs:
            found += _excited(one.name, one.values, one.p_max)
    return found


def _excited(name: str, value: Array, p_max: float | None) -> list[str]:
    """Return warnings on poor excitation by one input."""
    if is_constant(value):
        return [f'{name} is constant at {value[0]:.6g} Pa: its influence cannot be seen']
    found = []
    scale = p_max if p_max is not None else float(np.max(np.abs(value)))
    share = float(np.ptp(value)) / scale
    if share < SMALL_RANGE:
        whole = 'p_max' if p_max is not None else 'its largest value'
        found.append(f'{name} covers only {100 * share:.0f} % of {whole}: poor excitation')
    for word, extreme in (('lowest', np.min(value)), ('highest', np.max(value))):
        at = 100 * float(np.mean(value == extreme))
        if at > 100 * SATURATED:
            found.append(f'{name} is at its {word} value in {at:.0f} % of the samples')
    levels = np.unique(value)
    if levels.size < 4:
        found.append(
            f'{name} has only {levels.size} levels: poor excitation, curvature cannot be seen'
        )
    turns = _turns(value)
    if turns < 3:
        found.append(
            f'{name} reverses {turns} time(s): poor excitation, hysteresis and friction need '
            'both directions several times'
        )
    return found


def _turns(value: Array) -> int:
    """Return how often a signal changes its direction by more than a tenth of its range."""
    least = 0.1 * float(np.ptp(value))
    turns, direction = 0, 0
    low = high = float(value[0])
    for x in value.tolist():
        low, high = min(low, x), max(high, x)
        if direction <= 0 and x - low > least:
            turns += direction < 0
            direction, high, low = 1, x, x
        elif direction >= 0 and high - x > least:
            turns += direction > 0
            direction, high, low = -1, x, x
    return turns
