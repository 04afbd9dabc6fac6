# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The inputs and the measured outputs of a recording, for each muscle."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import one_each
from pam_ros.errors import RecordingError
from pam_ros.recording.assemble import AT_REST, spread
from pam_ros.recording.quantities import Quantity, quantity_in
from pam_ros.recording.recording import OUTPUTS, Recording

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Input:
    """An input at the samples (n,) in Pa: the command or the pressure of a muscle.

    ``p_max`` is the muscle's highest pressure in Pa, None if it is not known.
    """

    name: str
    values: Array
    p_max: float | None

    @property
    def quantity(self) -> str:
        """Return the quantity, without the name of a muscle."""
        return self.name.rpartition('.')[2]


def driving(recording: Recording, p_max: float | Sequence[float] | None = None) -> list[Input]:
    """Return the inputs at the samples: the commands of the muscles, else their pressures.

    *p_max* in Pa is a value for each muscle, or one for all. Raises RecordingError if neither
    commands nor pressures were recorded.
    """
    if recording.command is not None and recording.command_t is not None:
        at = np.searchsorted(recording.command_t, recording.t, side='right') - 1
        name, values = 'pressure_command', recording.command[np.maximum(at, 0)]
    elif recording.pressure is not None:
        name, values = 'pressure', recording.pressure
    else:
        raise RecordingError(
            f'{recording.name}: neither pressure_command nor pressure was recorded'
        )
    names = [f'{muscle}.{name}' for muscle in recording.muscles] or [name]
    highest: Sequence[float | None] = [None] * len(names)
    if p_max is not None:
        highest = one_each('p_max', p_max, len(names), 'muscle').tolist()
    columns = values.reshape(recording.t.size, -1).T
    return [Input(*one) for one in zip(names, columns, highest, strict=True)]


def input_of(output: str, inputs: Sequence[Input]) -> Input:
    """Return that of *inputs* which drives an *output*: of its muscle, or the first one."""
    muscle = output.rpartition('.')[0]
    return next(one for one in inputs if one.name.rpartition('.')[0] == muscle or not muscle)


def refuse_idle(recordings: Sequence[Recording]) -> None:
    """Raise RecordingError if a muscle has the same constant input in all *recordings*.

    All are of the same joint. The effect of such a muscle cannot be distinguished from the
    effects of the others.
    """
    if not recordings[0].muscles:
        return
    for one in zip(*map(driving, recordings), strict=True):
        values = np.concatenate([each.values for each in one])
        if is_constant(values):
            where = recordings[0].name if len(recordings) == 1 else 'all recordings'
            raise RecordingError(
                f'{where}: {one[0].name} is constant at {float(np.mean(values)):.6g} Pa: record '
                'changes of the pressures of all muscles'
            )


def refuse_copies(recordings: Sequence[Recording]) -> None:
    """Raise RecordingError if two of *recordings* have the same samples.

    A recording that is fitted twice counts twice, and a recording that is fitted must not serve
    as a test.
    """
    for k, one in enumerate(recordings):
        for other in recordings[:k]:
            pairs = zip(_samples(one), _samples(other), strict=True)
            if all(np.array_equal(*pair) for pair in pairs):
                raise RecordingError(
                    f'{one.name} has the same samples as {other.name}: give each recording once, '
                    'to be fitted or to test'
                )


def _samples(recording: Recording) -> list[Array]:
    """Return stamps, commands and outputs, an empty array for each that was not recorded."""
    all_of_it = (recording.t, *(getattr(recording, name) for name in ('command', *OUTPUTS)))
    return [np.zeros(0) if one is None else one for one in all_of_it]


def quantity_of(recording: Recording, name: str) -> Quantity:
    """Return the quantity of the output *name* of *recording*."""
    return quantity_in(recording.unit, name)


def outputs(recording: Recording) -> list[tuple[str, Array, str]]:
    """Return name, values (n,) and SI unit of each measured output, for each muscle."""
    found = []
    for name in OUTPUTS:
        value = getattr(recording, name)
        if value is not None:
            names = [name] if value.ndim == 1 else [f'{m}.{name}' for m in recording.muscles]
            si = quantity_of(recording, name).si
            columns = value.reshape(recording.t.size, -1).T
            found += [(one, column, si) for one, column in zip(names, columns, strict=True)]
    return found


def is_constant(value: Array) -> bool:
    """Return whether a signal is constant, with or without white noise."""
    low, high = np.percentile(value, (2.0, 98.0))
    if np.ptp(value) <= 1e-9 * np.max(np.abs(value)):
        return True
    if high - low > 0.02 * np.max(np.abs(value)) or np.unique(value).size < 20:
        return False
    x = value - value.mean()
    return bool(np.sum(x[1:] * x[:-1]) < 0.5 * np.sum(x * x))


def is_stretched(recording: Recording) -> bool:
    """Return whether a prescribed length moves: it is then an input in addition to pressure."""
    return (
        recording.kind == 'held'
        and recording.position is not None
        and spread(recording.position) > AT_REST
    )
