# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a recording (refused) and what is poor in it (warned of)."""

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.assemble import AT_REST, spread
from pam_ros.recording.quantities import QUANTITIES
from pam_ros.recording.recording import OUTPUTS, Recording

Array = NDArray[np.float64]

FEWEST = 100  # samples
# s between samples: outside, the unit of time must be wrong. Milliseconds at 1 kHz that are taken
# for seconds are 1 s apart, seconds at 100 Hz that are taken for milliseconds 10 us.
PERIODS = (5e-5, 0.25)
HELD_PERIOD = 2.0  # s: a muscle that is held has no oscillation that samples must resolve
CONTRACTIONS = (-0.2, 1.0)  # of a muscle of length l0: outside, zero or direction must be wrong
TOO_LOW = 1e-3  # an input that stays below this share of p_max is in another unit
SHORT = 10.0  # s
RESTING = 0.02  # share of samples at an extreme value from which it may be a stop
SATURATED = 0.6  # share of samples of an input at one end of its range that is too much
LEVELS = 100  # distinct values, fewer of which are called coarse
SMALL_RANGE = 0.2  # of the input's largest value


def check(
    recording: Recording, l0: float | None = None, p_max: float | None = None
) -> tuple[str, ...]:
    """Return the warnings on *recording*; raise RecordingError for what cannot be used.

    ``l0`` (m) and ``p_max`` (gauge Pa) of the muscle sharpen the checks of units where known.
    """
    _refuse_few(recording)
    _refuse_units(recording, p_max)
    _refuse_position(recording, l0)
    _refuse_constant(recording)
    return (
        *_warn_slow(recording),
        *_warn_gaps(recording),
        *_warn_range(recording, l0, p_max),
        *_warn_extremes(recording),
        *_warn_coarse(recording),
        *_warn_excitation(recording, p_max),
    )


def driving(recording: Recording) -> tuple[str, Array]:
    """Return (name, values) of the input over the samples: the command, or the pressure."""
    if recording.command is not None and recording.command_t is not None:
        at = np.searchsorted(recording.command_t, recording.t, side='right') - 1
        return 'pressure_command', recording.command[np.maximum(at, 0)]
    if recording.pressure is None:
        raise RecordingError(f'{recording.name}: nothing drives it')
    return 'pressure', recording.pressure


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
            f'{high:g} s: is the time in another unit (t_ms, t_us, t_ns)?'
        )


def _refuse_units(recording: Recording, p_max: float | None) -> None:
    values = {name: getattr(recording, name) for name in OUTPUTS}
    values['pressure_command'] = recording.command
    for name, value in values.items():
        if value is None:
            continue
        worst = float(value[np.argmax(np.abs(value))])
        limit, si = QUANTITIES[name].limit, QUANTITIES[name].si
        if abs(worst) > limit:
            raise RecordingError(
                f'{recording.name}: {name} reaches {worst:.6g} {si}, which cannot be right (at '
                f'most {limit:g} {si}): is it in another unit?'
            )
    name, value = driving(recording)
    highest = float(np.max(value))
    if p_max is not None and highest < TOO_LOW * p_max:
        raise RecordingError(
            f'{recording.name}: {name} stays below {highest:.4g} Pa, the muscle takes up to '
            f'{p_max:g} Pa: is it in another unit ({name}_bar, {name}_kPa)?'
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
            "position_mm*-1+120' turns and moves them"
        )


def _refuse_constant(recording: Recording) -> None:
    name, value = driving(recording)
    if _is_constant(value) and not _is_stretched(recording):
        raise RecordingError(
            f'{recording.name}: {name} is constant at {float(np.mean(value)):.6g} Pa: nothing '
            'can be found from it'
        )
    output = 'position' if recording.kind == 'free' else 'force'
    if np.ptp(getattr(recording, output)) == 0.0:
        raise RecordingError(
            f'{recording.name}: {output} is constant while {name} changes: was the sensor read?'
        )


def _is_constant(value: Array) -> bool:
    """Say whether a signal is one level, with or without white noise on it."""
    low, high = np.percentile(value, (2.0, 98.0))
    if np.ptp(value) <= 1e-9 * np.max(np.abs(value)):
        return True
    if high - low > 0.02 * np.max(np.abs(value)) or np.unique(value).size < 20:
        return False
    x = value - value.mean()
    return bool(np.sum(x[1:] * x[:-1]) < 0.5 * np.sum(x * x))


def _warn_slow(recording: Recording) -> tuple[str, ...]:
    if recording.period <= PERIODS[1]:
        return ()
    return (f'samples are {recording.period:.4g} s apart: is the time in another unit?',)


def _warn_gaps(recording: Recording) -> list[str]:
    if not recording.gaps:
        return []
    longest = max(recording.gaps, key=lambda gap: gap[1] - gap[0])
    total = sum(end - start for start, end in recording.gaps)
    return [
        f'{len(recording.gaps)} gap(s) without samples, {total:.3g} s in all, the longest '
        f'{longest[1] - longest[0]:.3g} s at {longest[0]:.4g} s: each part is simulated on its own'
    ]


def _warn_range(recording: Recording, l0: float | None, p_max: float | None) -> list[str]:
    found = []
    if l0 is not None and recording.position is not None:
        most = float(np.max(np.abs(recording.position)))
        if most > 0.6 * l0:
            found.append(f'position reaches {most:.4g} m, l0 is {l0:g} m: are both right?')
    if p_max is not None:
        name, value = driving(recording)
        if np.max(value) > 1.05 * p_max:
            found.append(f'{name} reaches {np.max(value):.6g} Pa, above p_max = {p_max:g} Pa')
    if recording.pressure is not None and recording.command is not None:
        lowest = float(np.min(recording.pressure))
        if 8e4 < lowest < 1.15e5 and np.min(recording.command) < 2e4:
            found.append(
                f'pressure never falls below {lowest:.6g} Pa though the command does: is it '
                "absolute? Pressures are gauge: --column 'NAME=pressure_Pa-101325'"
            )
    return found


def _warn_extremes(recording: Recording) -> list[str]:
    """Warn of measured outputs that rest at their lowest or highest value.

    A pressure that does so under one command is no sensor at its limit.
    """
    found = []
    driver, drive = driving(recording)
    for name in OUTPUTS:
        value = getattr(recording, name)
        if value is None or np.ptp(value) == 0.0:
            continue
        for word, extreme in (('lowest', np.min(value)), ('highest', np.max(value))):
            at = value == extreme
            runs = np.count_nonzero(at[1:] & at[:-1])
            if at.mean() < RESTING or runs < 0.5 * np.count_nonzero(at):
                continue
            is_commanded = driver != name and np.ptp(drive[at]) < 0.01 * np.ptp(drive)
            if name != 'pressure' or not is_commanded:
                found.append(
                    f'{name} rests at its {word} value, {extreme:.6g} {QUANTITIES[name].si}, in '
                    f'{100 * at.mean():.0f} % of the samples: a sensor at its limit, or a stop?'
                )
    return found


def _warn_coarse(recording: Recording) -> list[str]:
    found = []
    for name in OUTPUTS:
        value = getattr(recording, name)
        if value is None or np.ptp(value) == 0.0 or value.size < 10 * LEVELS:
            continue
        levels = np.unique(value)
        if levels.size < LEVELS:
            step = float(np.median(np.diff(levels)))
            found.append(
                f'{name} takes only {levels.size} values, {step:.3g} {QUANTITIES[name].si} apart: '
                'what is smaller cannot be seen'
            )
    return found


def _warn_excitation(recording: Recording, p_max: float | None) -> list[str]:
    name, value = driving(recording)
    found = []
    if recording.duration < SHORT:
        found.append(f'only {recording.duration:.3g} s long: slow effects cannot be seen')
    if _is_stretched(recording):
        return found
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
            f'{name} turns round {turns} time(s): poor excitation, hysteresis and friction need '
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


def _is_stretched(recording: Recording) -> bool:
    """Say whether a prescribed length moves: an input beside the pressure."""
    return (
        recording.kind == 'held'
        and recording.position is not None
        and spread(recording.position) > AT_REST
    )
