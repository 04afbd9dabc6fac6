# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The signals of a joint of several muscles, combined with a column for each muscle."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.recording.recording import interpolated
from pam_ros.recording.series import Series, refuse_backwards

Array = NDArray[np.float64]


def of_joint(
    name: str, series: dict[str, Series], muscles: Sequence[str], notes: list[str]
) -> tuple[dict[str, Series], tuple[str, ...]]:
    """Return *series* with the signals of several muscles combined, and the names of the muscles.

    Signals such as ``agonist.pressure`` become one ``pressure`` whose values are (n, muscles), in
    the order of *muscles*, or in that of their first appearance if *muscles* is empty. Commands
    are a zero-order hold, measured pressures are interpolated linearly. The signals of one muscle
    keep their values, and the names are then empty. A note on each signal that is left out is
    added to *notes*.

    Raises RecordingError, with the name of the recording, if a muscle is missing or unknown.
    """
    found = dict.fromkeys(key.partition('.')[0] for key in series if '.' in key)
    names = tuple(muscles) or tuple(found)
    if len(names) <= 1:
        return _of_one(name, series, tuple(found), names), ()
    for stranger in found:
        if stranger not in names:
            raise RecordingError(
                f'{name}: {_source_of(series, stranger)} is of a muscle {stranger!r}, which the '
                f'joint does not have: its muscles are {", ".join(names)}; give its muscle with '
                f"--column 'NAME={names[0]}.pressure_command_kPa', or leave it out with "
                "--column 'NAME=ignore'"
            )
    made = {key: one for key, one in series.items() if '.' not in key}
    for quantity in ('pressure_command', 'pressure'):
        if quantity in made:
            raise RecordingError(
                f'{name}: {made[quantity].source} does not name a muscle, and the joint '
                f'has {len(names)}: name it {names[0]}.{quantity}_kPa, or likewise with another '
                f'of {", ".join(names)}'
            )
        own = [series.get(f'{muscle}.{quantity}') for muscle in names]
        given = [one for one in own if one is not None]
        if quantity == 'pressure' and len(given) < len(names) and 'pressure_command' in made:
            notes += [f'{one.source} is not used: not all muscles have one' for one in given]
            continue
        if given and len(given) < len(names):
            missing = names[own.index(None)]
            raise RecordingError(
                f'{name} has {given[0].source} but no {missing}.{quantity}: a column is needed '
                f'for each of {", ".join(names)}'
            )
        if given:
            made[quantity] = _together(name, given, is_held=quantity == 'pressure_command')
    if 'force' in made:
        source = made.pop('force').source
        notes.append(f'{source} is not used: its muscle is not known')
    forces = [one.source for key, one in series.items() if key.endswith('.force')]
    if forces:
        notes.append(f'{", ".join(forces)}: forces of the muscles of a joint are not used')
    return made, names


def _source_of(series: dict[str, Series], muscle: str) -> str:
    """Return the source of the first signal of a muscle."""
    return next(one.source for key, one in series.items() if key.startswith(f'{muscle}.'))


def _of_one(
    name: str, series: dict[str, Series], found: tuple[str, ...], names: tuple[str, ...]
) -> dict[str, Series]:
    """Return the signals of one muscle by quantity, without the name of the muscle."""
    if names and found and found != names:
        raise RecordingError(
            f'{name} has signals of {", ".join(found)}, and the model one muscle, {names[0]}: '
            'give the parameters of the joint'
        )
    made: dict[str, Series] = {}
    for key, one in series.items():
        plain = key.rpartition('.')[2]
        if plain in made:
            raise RecordingError(
                f'{name}: {made[plain].source} and {one.source} both give the {plain}: leave one '
                f"out with --column '{one.source}=ignore'"
            )
        made[plain] = one
    return made


def _together(name: str, given: list[Series], *, is_held: bool) -> Series:
    """Return signals of several muscles as one with a column for each."""
    for one in given:
        refuse_backwards(one.t, f'{name}: time of {one.source}')
    start = max(float(one.t[0]) for one in given)
    t: Array
    if is_held:
        t = np.unique(np.concatenate([one.t for one in given]))
        t = t[t >= start]
    else:
        end = min(float(one.t[-1]) for one in given)
        t = given[0].t[(given[0].t >= start) & (given[0].t <= end)]
    if t.size == 0:
        sources = ', '.join(one.source for one in given)
        raise RecordingError(f'{name}: {sources} do not overlap in time')
    columns = []
    for one in given:
        if is_held:
            columns.append(one.value[np.searchsorted(one.t, t, side='right') - 1])
        else:
            columns.append(interpolated(t, one.t, one.value))
    return replace(
        given[0],
        source=', '.join(one.source for one in given),
        t=t,
        value=np.stack(columns, axis=1),
        is_received=any(one.is_received for one in given),
    )
