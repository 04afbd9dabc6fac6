# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Combine signals with different stamps into one recording on one clock, with its gaps."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.of_joint import of_joint
from pam_ros.recording.outliers import TooManyOutliersError, without_outliers
from pam_ros.recording.quantities import ANGULAR
from pam_ros.recording.recording import KINDS, OUTPUTS, PREDICTED, Recording, interpolated
from pam_ros.recording.repeats import without_repeats
from pam_ros.recording.series import GAP_SECONDS, Series, refuse_backwards

Array = NDArray[np.float64]

# Quantities that become position and velocity.
AS_POSITION = {angular: linear for linear, angular in ANGULAR.items()}
AS_POSITION |= {'contraction': 'position'}
AT_REST = 5e-4  # m (half a millimetre): a position that moves less is constant
OVERLAP = 0.9  # share of the samples that a signal must cover to be kept if it is not needed
# Standard deviation in s of the time between the receipt of a command by the recorder and its
# effect. On one machine 0.2 to 0.6 ms was measured, earlier or later; on two it is 1 ms or more.
RECEIPT = 1e-3
STREAM = 0.1  # s: commands at shorter intervals are a stream, in which a pause is worth a note


class MissingSignalError(RecordingError):
    """A recording lacks a signal that its kind needs, under the names that are known."""


def assemble(
    name: str,
    series: dict[str, Series],
    notes: list[str],
    kind: str | None = None,
    l0: float | None = None,
    muscles: Sequence[str] = (),
) -> Recording:
    """Return the recording that the signals *series* (signal -> its values in SI) give.

    A joint of several muscles has signals for each muscle, called ``agonist.pressure``; *muscles*
    are their names in the order of the joint.

    All outputs get the stamps of the predicted signal: the position of a free load, the force at
    a prescribed length, or the pressure if nothing else was measured. The other signals are
    interpolated linearly. Samples before the first command are left out. Samples at which a signal
    is missing are left out, too: they become gaps.
    If *kind* is None it is found from the data: ``held`` if a force was measured and the position
    is constant; ``pressure`` if commands and pressures were recorded, and neither position nor
    force; else ``free``.

    Raises RecordingError if a signal is missing that the kind needs.
    """
    notes = list(notes)
    series, unusable = _measured(series, notes)
    series, names = of_joint(name, series, muscles, notes)
    unit = 'rad' if 'angle' in series else 'm'
    _make_position(name, series, l0, notes)
    if 'pressure_command' not in series and 'pressure' not in series:
        raise MissingSignalError(
            f'{name} has neither pressure_command nor pressure: one of them is needed as the input'
        )
    if kind is None and _kind_of(series) == 'pressure':
        notes.append(
            'neither a position nor a force was recorded: only the pressure path is identified'
        )
    kind = _find_kind(name, series, kind)
    predicted = PREDICTED[kind]
    needed = {predicted} if kind == 'pressure' else {predicted, 'position'}
    if 'pressure_command' not in series:
        needed.add('pressure')
    _leave_out(name, series, unusable, needed, notes)
    series = _ascending(name, series, needed, notes)
    main, command = series[predicted], series.get('pressure_command')
    t = _sample_times(name, series, main, needed, notes)
    origin = float(t[0])
    recording = Recording(
        name=name,
        t=t - origin,
        command_t=None,
        command=None,
        position=_at(t, series.get('position')),
        velocity=_at(t, series.get('velocity')),
        force=_at(t, series.get('force')),
        pressure=_at(t, series.get('pressure')),
        kind=kind,
        muscles=names,
        unit=unit,
        origin=origin,
    )
    if command is not None:
        recording = _with_commands(recording, command, is_received=main.is_received)
        _note_stream(recording, notes)
    gaps = tuple(_gaps(recording.t))
    return replace(recording, gaps=gaps, warnings=tuple(notes))


def _measured(
    series: dict[str, Series], notes: list[str]
) -> tuple[dict[str, Series], dict[str, str]]:
    """Return the series with those samples only that are measurements.

    The second value has the quantities that are not usable, with the reason.
    """
    kept, unusable = {}, {}
    for signal, one in series.items():
        if not one.t.size:
            continue
        kept[signal] = one
        quantity = signal.rpartition('.')[2]
        if quantity == 'pressure_command':
            continue
        try:
            kept[signal] = without_outliers(without_repeats(one, notes), notes)
        except TooManyOutliersError as error:
            unusable[AS_POSITION.get(quantity, quantity)] = str(error)
    return kept, unusable


def _leave_out(
    name: str,
    series: dict[str, Series],
    unusable: dict[str, str],
    needed: set[str],
    notes: list[str],
) -> None:
    """Remove the *unusable* quantities from *series*, with a note; raise if one is needed."""
    for quantity, reason in unusable.items():
        if quantity in needed:
            raise RecordingError(f'{name}: {reason}')
        series.pop(quantity, None)
        notes.append(f'{reason}: it is not used')


def _sample_times(
    name: str, series: dict[str, Series], main: Series, needed: set[str], notes: list[str]
) -> Array:
    """Return the stamps of *main* at which all signals have values.

    Signals that are not *needed* and cover too little are removed from *series*, with a note.
    """
    command = series.get('pressure_command')
    t = _common(name, main, [series[quantity] for quantity in needed], command, notes)
    for quantity in OUTPUTS:
        if quantity in series and quantity not in needed:
            _leave_out_short(quantity, series, t, notes)
    for one in (series[q] for q in OUTPUTS if q in series):
        for start, end in one.holes():
            t = t[(t <= start) | (t >= end)]
    if t.size < 2:
        raise RecordingError(f'{name}: its signals do not overlap in time')
    return t


def _with_commands(recording: Recording, command: Series, *, is_received: bool) -> Recording:
    """Return the recording with the commands from the one that is in force at its start on.

    *is_received* is whether its output has the times of receipt instead of stamps.
    """
    first = max(int(np.searchsorted(command.t, recording.origin, side='right')) - 1, 0)
    return replace(
        recording,
        command_t=command.t[first:] - recording.origin,
        command=command.value[first:],
        command_spread=RECEIPT if command.is_received or is_received else 0.0,
    )


def _ascending(
    name: str, series: dict[str, Series], needed: set[str], notes: list[str]
) -> dict[str, Series]:
    """Return the series with strictly ascending stamps; raise if time goes backwards.

    Samples with equal stamps are harmless in a command: the last one is kept. In an output, many
    of them mean that the clock is too coarse: it is refused if it is needed, else left out.
    """
    kept = {}
    for quantity, one in series.items():
        refuse_backwards(one.t, f'{name}: time of {one.source}')
        share = f'of {one.t.size} samples of {one.source} share their time with'
        if one.is_coarse and quantity != 'pressure_command':
            if quantity in needed:
                raise RecordingError(
                    f'{name}: {one.shared} {share} the one before: the clock is too coarse (are '
                    'milliseconds given as seconds, or digits cut off?)'
                )
            notes.append(f'{one.shared} {share} the one before: it is not used')
            continue
        if one.shared:
            notes.append(f'{one.shared} {share} another: the last is kept')
        kept[quantity] = one.ascending()
    return kept


def _make_position(
    name: str, series: dict[str, Series], l0: float | None, notes: list[str]
) -> None:
    for linear, angular in ANGULAR.items():
        if angular in series:
            if linear in series:
                one, other = series[angular].source, series[linear].source
                raise RecordingError(
                    f'{name}: {one} is an angle and {other} a length: one of them is of another '
                    "joint: leave it out with --column 'NAME=ignore'"
                )
            series[linear] = series.pop(angular)
    contraction = series.pop('contraction', None)
    if contraction is None:
        return
    if 'position' in series:
        notes.append(f'{contraction.source} is not used: the position was measured as well')
        return
    if l0 is None:
        raise RecordingError(
            f'{name}: {contraction.source} is a contraction: the length l0 of the muscle is '
            'needed to convert it to a position'
        )
    series['position'] = replace(contraction, value=contraction.value * l0)


def _find_kind(name: str, series: dict[str, Series], kind: str | None) -> str:
    if kind is None:
        kind = _kind_of(series)
    if kind not in KINDS:
        raise RecordingError(f'kind = {kind!r} is not known: give one of ' + ', '.join(KINDS))
    if kind == 'pressure':
        for quantity in ('pressure_command', 'pressure'):
            if quantity not in series:
                raise MissingSignalError(
                    f'{name} has no {quantity}: both are needed for the pressure path alone (kind '
                    'pressure)'
                )
        return kind
    if 'position' not in series:
        what = 'position or contraction, the predicted signal of a free load'
        if kind == 'held' or 'force' in series:
            what = 'position or contraction, at which the force was measured'
        raise MissingSignalError(f'{name} has no {what}')
    if kind == 'held' and 'force' not in series:
        raise MissingSignalError(
            f'{name} has no force, the predicted signal at a prescribed length (kind held)'
        )
    return kind


def _kind_of(series: dict[str, Series]) -> str:
    """Return the kind of a recording with these signals."""
    if 'position' in series:
        is_still = spread(series['position'].value) < AT_REST
        return 'held' if is_still and 'force' in series else 'free'
    is_of_path = {'pressure_command', 'pressure'} <= {*series} and 'force' not in series
    return 'pressure' if is_of_path else 'free'


def _common(
    name: str,
    main: Series,
    needed: list[Series],
    command: Series | None,
    notes: list[str],
) -> Array:
    """Return the stamps of *main* at which all *needed* signals and a command exist."""
    start = max(one.t[0] for one in needed)
    end = min(one.t[-1] for one in needed)
    if command is not None and command.t[0] > start:
        lost = min(float(command.t[0]), end) - start
        if lost > GAP_SECONDS:
            notes.append(f'the first {lost:.3g} s have no command yet and are left out')
        start = float(command.t[0])
    t: Array = main.t[(main.t >= start) & (main.t <= end)]
    if t.size < 2:
        raise RecordingError(f'{name}: its signals do not overlap in time')
    return t


def _leave_out_short(quantity: str, series: dict[str, Series], t: Array, notes: list[str]) -> None:
    """Drop a signal that is not needed if it covers too little of *t*."""
    one = series[quantity]
    covered = (t >= one.t[0] - one.gap_limit) & (t <= one.t[-1] + one.gap_limit)
    for start, end in one.holes():
        covered &= (t <= start) | (t >= end)
    if covered.mean() < OVERLAP:
        notes.append(
            f'{one.source} is not used: it covers {100 * covered.mean():.0f} % of the samples'
        )
        del series[quantity]


def spread(value: Array) -> float:
    """Return the range of a signal between its percentiles 0.5 and 99.5."""
    low, high = np.percentile(value, (0.5, 99.5))
    return float(high - low)


def _at(t: Array, one: Series | None) -> Array | None:
    return None if one is None else interpolated(t, one.t, one.value)


def _gaps(t: Array) -> list[tuple[float, float]]:
    return Series('', t, t).holes()


def _note_stream(recording: Recording, notes: list[str]) -> None:
    """Note where a stream of commands pauses: it is not recorded how the rig reacted."""
    command_t = recording.command_t
    if command_t is None or command_t.size < 10:
        return
    stamps = np.append(command_t, recording.t[-1])
    stamps = stamps[stamps <= recording.t[-1]]
    period = float(np.median(np.diff(command_t)))
    pauses = np.diff(stamps)
    long = pauses > max(50.0 * period, 0.5)
    if period < STREAM and long.any():
        i = int(np.argmax(pauses))
        notes.append(
            f'commands came every {1e3 * period:.3g} ms but pause {int(long.sum())} time(s), the '
            f'longest at {stamps[i]:.4g} s for {pauses[i]:.3g} s: the last command is taken as '
            'constant (wrong if the rig vented)'
        )
