# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Refuse recordings that cannot be used, with a sentence that gives the reason."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.inputs import (
    Input,
    input_of,
    is_constant,
    is_stretched,
    outputs,
    quantity_of,
)
from pam_ros.recording.recording import OUTPUTS, PREDICTED, Recording

Array = NDArray[np.float64]

FEWEST = 100  # samples
# s between samples; outside this range the unit of time must be wrong. Milliseconds at 1 kHz that
# are taken for seconds are 1 s apart, seconds at 100 Hz that are taken for milliseconds 10 us.
PERIODS = (5e-5, 0.25)
HELD_PERIOD = 2.0  # s: at a prescribed length there is no oscillation that samples must resolve
NEEDED = {
    'free': ('position',),
    'held': ('position', 'force'),
    'pressure': ('command', 'pressure'),
}
CONTRACTIONS = (-0.2, 1.0)  # of a muscle of length l0; outside, the zero or the sign must be wrong
EXCEL_DAYS = (3e4, 6e4)  # of the years 1982 to 2064
TOO_LOW = 1e-3  # an input that stays below this share of p_max is in another unit


def refuse_unusable(
    recording: Recording,
    inputs: Sequence[Input],
    l0: float | None,
    reach: tuple[float, float] | None,
) -> None:
    """Raise RecordingError if *recording* cannot be used.

    *inputs* are those of the recording, ``l0`` (m) is the length of its muscle, and ``reach`` (m
    or rad) the least and the greatest position of its joint. The last two are None if unknown.
    """
    _refuse_missing(recording)
    _refuse_few(recording)
    _refuse_units(recording)
    _refuse_low(recording, inputs)
    _refuse_position(recording, l0)
    _refuse_beyond(recording, reach)
    _refuse_constant(recording, inputs)


def _refuse_missing(recording: Recording) -> None:
    """Refuse a recording that is made of arrays, and lacks one that a model must predict."""
    for name in NEEDED[recording.kind]:
        if getattr(recording, name) is None:
            raise RecordingError(f'{recording.name}: no {name} was recorded')


def _refuse_few(recording: Recording) -> None:
    n = recording.t.size
    if n < FEWEST:
        raise RecordingError(
            f'{recording.name} has {n} usable samples: at least {FEWEST} are needed'
        )
    low, high = PERIODS[0], HELD_PERIOD if recording.kind == 'held' else PERIODS[1]
    if not low <= recording.period <= high:
        raise RecordingError(
            f'{recording.name}: samples are {recording.period:.4g} s apart, outside {low:g} to '
            f'{high:g} s: is the time in another unit ({_likely_units(recording, low)})?'
        )


def _likely_units(recording: Recording, low: float) -> str:
    """Return the units in which stamps are that are too far apart as s, or too near."""
    if recording.period > low:
        return 't_ms, t_us, t_ns'
    if EXCEL_DAYS[0] < recording.origin < EXCEL_DAYS[1]:
        return f't_days: Excel counts days, and has {recording.origin:.0f} for a day of our time'
    return 't_min, t_h, t_days'


def _refuse_units(recording: Recording) -> None:
    values = {name: getattr(recording, name) for name in OUTPUTS}
    values['pressure_command'] = recording.command
    for name, value in values.items():
        if value is None:
            continue
        worst = float(value.flat[np.argmax(np.abs(value))])
        limit, si = quantity_of(recording, name).limit, quantity_of(recording, name).si
        if abs(worst) > limit:
            raise RecordingError(
                f'{recording.name}: {name} reaches {worst:.6g} {si}, which cannot be right (at '
                f'most {limit:g} {si}): is it in another unit?'
            )


def _refuse_low(recording: Recording, inputs: Sequence[Input]) -> None:
    """Refuse inputs that are all so low that they must be in another unit."""
    highest = [float(np.max(one.values)) for one in inputs]
    if all(
        one.p_max is not None and most < TOO_LOW * one.p_max
        for one, most in zip(inputs, highest, strict=True)
    ):
        name, p_max = inputs[0].name, inputs[0].p_max
        raise RecordingError(
            f'{recording.name}: {name} stays below {highest[0]:.4g} Pa, and p_max of the '
            f'muscle is {p_max:g} Pa: is it in another unit ({name}_bar, {name}_kPa)?'
        )


def _refuse_position(recording: Recording, l0: float | None) -> None:
    """Refuse a position that a muscle of length *l0* cannot have: the model has no force there."""
    if l0 is None or recording.position is None:
        return
    low, high = CONTRACTIONS[0] * l0, CONTRACTIONS[1] * l0
    outside = np.flatnonzero((recording.position < low) | (recording.position > high))
    if outside.size:
        i = int(outside[0])
        value, at = recording.position[i], recording.t[i]
        raise RecordingError(
            f'{recording.name}: position = {value:.6g} m at {at:.6g} s is not a '
            f'contraction of a muscle of l0 = {l0:g} m: positions are {low:g} to '
            f"{high:g} m, 0 at length l0 and positive where it is shorter: --column 'NAME="
            "position_mm*-1+120' inverts and shifts them"
        )


def _refuse_beyond(recording: Recording, reach: tuple[float, float] | None) -> None:
    """Refuse a position that the joint cannot have."""
    if reach is None or recording.position is None:
        return
    low, high = reach
    outside = np.flatnonzero((recording.position < low) | (recording.position > high))
    if outside.size:
        i = int(outside[0])
        value, at, unit = recording.position[i], recording.t[i], recording.unit
        other = 'position_deg' if unit == 'rad' else 'position_mm'
        raise RecordingError(
            f'{recording.name}: position = {value:.6g} {unit} at {at:.6g} s is outside {low:.4g} '
            f'to {high:.4g} {unit}, where the muscles of this joint have a length: is it in '
            f"another unit ({other}), or is its zero elsewhere (--column 'NAME=position_{unit}"
            "*-1+0.5' inverts and shifts it)?"
        )


def _refuse_constant(recording: Recording, inputs: Sequence[Input]) -> None:
    if all(is_constant(one.values) for one in inputs) and not is_stretched(recording):
        names = ' and '.join(one.name for one in inputs)
        levels = ' and '.join(f'{float(np.mean(one.values)):.6g} Pa' for one in inputs)
        verb = 'is' if len(inputs) == 1 else 'are'
        raise RecordingError(
            f'{recording.name}: {names} {verb} constant at {levels}, so that no parameter can '
            'be identified'
        )
    for name, values, _ in outputs(recording):
        if name.rpartition('.')[2] != PREDICTED[recording.kind] or np.ptp(values) > 0.0:
            continue
        drive = input_of(name, inputs)
        if recording.kind == 'pressure' and is_constant(drive.values):
            continue  # the pressure of a muscle that is not moved
        raise RecordingError(
            f'{recording.name}: {name} is constant while {drive.name} changes: was the '
            'sensor read?'
        )
