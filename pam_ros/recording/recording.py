# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A measured experiment: arrays in SI on one clock, with its gaps."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.arguments import (
    along,
    array,
    instance,
    number,
    refuse,
    refuse_shape,
    sequence,
    stamps,
)
from pam_ros.errors import ParameterError, RecordingError
from pam_ros.recording.bounds import Bounded
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.series import Series

Array = NDArray[np.float64]
KINDS = ('free', 'held', 'pressure')
PREDICTED = {'free': 'position', 'held': 'force', 'pressure': 'pressure'}
UNITS = ('m', 'rad')
OUTPUTS = ('position', 'velocity', 'force', 'pressure')
OF_MUSCLES = ('command', 'pressure')  # each muscle of a joint has these


@dataclass(frozen=True, eq=False)
class Recording:
    """The commands and the measured outputs of an experiment, with their stamps.

    Contraction is positive (the load moves up), pressures are gauge. Arrays contain no NaN. A
    signal that was not recorded is None, which is the default. A sample that a masked array of
    numpy masks is left out of all outputs, and a masked command out of the commands; a long
    stretch of them becomes a gap. Raises RecordingError for arrays that do not match each other
    or contain values that are not finite numbers.

    ``name``
        File or bag, for reports.
    ``t``
        (n,) s since the recording's first sample, strictly ascending: stamps of the outputs. A
        value with stamp t is the state before a command with the same stamp acts.
    ``command_t``, ``command``
        (m,) s on the same clock, ascending, and (m,) Pa; each is constant until the next stamp.
        The first is at or before t[0]. None if no command was recorded.
    ``position``, ``velocity``, ``force``, ``pressure``
        (n,) m, m/s, N and Pa measured, or None; rad and rad/s if ``unit`` is ``rad``.
    ``kind``
        ``free``: the load moves; ``held``: the length is prescribed, constant or moving;
        ``pressure``: only the pressures were recorded, with their commands, such as those of a
        regulator on a closed volume.
    ``gaps``
        Stretches (from, to) in s without samples: a simulation is restarted after each.
    ``warnings``
        Sentences on poor properties of the data.
    ``digest``
        SHA-256 of the file or files, for provenance.
    ``command_spread``
        Standard deviation in s of a constant delay (or lead) between the stamps of the commands
        and their effect; 0 if one clock stamped all.
    ``muscles``
        Names of the muscles of a joint that has several. ``command`` and ``pressure`` then have a
        column for each, (m, muscles) and (n, muscles), and there is no ``force``.
    ``unit``
        Of the position: ``m``, or ``rad`` for a revolute joint.
    ``origin``
        Time in s of the stamp 0 in the file: on the time axis of a CSV file, or since the first
        message of a bag.
    ``numbers``
        Numbers of load, transmission and mounting that this recording has instead of those of the
        joint, in SI, by the names of their parameters: ``{'mass': 10.0}``.
    ``note``
        A text on the experiment for reports, such as the temperature.
    """

    name: str
    t: Array
    command_t: Array | None = None
    command: Array | None = None
    position: Array | None = None
    velocity: Array | None = None
    force: Array | None = None
    pressure: Array | None = None
    kind: str = 'free'
    gaps: tuple[tuple[float, float], ...] = ()
    warnings: tuple[str, ...] = ()
    digest: str = ''
    command_spread: float = 0.0
    muscles: tuple[str, ...] = ()
    unit: str = 'm'
    origin: float = 0.0
    numbers: Mapping[str, float] = field(default_factory=dict)
    note: str = ''

    def __post_init__(self) -> None:
        """Check that the arrays match each other, and store them as arrays."""
        try:
            self._check()
        except ParameterError as error:
            raise RecordingError(f'{self.name}: {error}') from error

    def _check(self) -> None:
        instance('name', self.name, str, 'a text')
        if self.kind not in KINDS:
            refuse('kind', self.kind, f'one of {", ".join(KINDS)}')
        if self.unit not in UNITS:
            refuse('unit', self.unit, f'one of {", ".join(UNITS)}')
        self._check_muscles()
        self._leave_out_masked()
        t = stamps('t', self.t, strict=True)
        checked: dict[str, Any] = {'t': t}
        for name in OUTPUTS:
            value = getattr(self, name)
            checked[name] = None if value is None else self._along(name, value, 't', t.size)
        if self.command_t is None and self.command is not None:
            refuse('command_t', None, 'the stamps of command')
        if self.command_t is not None:
            checked['command_t'] = at = stamps('command_t', self.command_t)
            checked['command'] = self._along('command', self.command, 'command_t', at.size)
            if at[0] > t[0]:
                raise ParameterError(
                    f'command_t[0] = {at[0]} s is after t[0] = {t[0]} s: give the command that '
                    'acts at the first sample, too'
                )
        self._check_gaps()
        instance('warnings', self.warnings, Sequence, 'texts')
        instance('note', self.note, str, 'a text')
        numbers = instance('numbers', self.numbers, Mapping, "numbers by name, {'mass': 10.0}")
        checked['numbers'] = {
            instance('a name in numbers', name, str, 'a text'): number(name, value)
            for name, value in numbers.items()
        }
        number('origin', self.origin)
        if number('command_spread', self.command_spread) < 0.0:
            refuse('command_spread', self.command_spread, 'at least 0 s')
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    def _leave_out_masked(self) -> None:
        """Leave out the samples and the commands that masked arrays mask."""
        for names in (('t', *OUTPUTS), ('command_t', 'command')):
            given = {name: getattr(self, name) for name in names}
            masks = [np.ma.getmaskarray(one) for one in given.values() if np.ma.is_masked(one)]
            if not masks:
                continue
            # Arrays that do not match each other are refused below.
            lengths = {np.shape(one)[:1] for one in given.values() if one is not None}
            if len(lengths) > 1:
                continue
            is_masked = np.any([m.reshape(m.shape[0], -1).any(axis=1) for m in masks], axis=0)
            for name, one in given.items():
                if one is not None:
                    kept = np.ma.getdata(one)[~is_masked]
                    object.__setattr__(self, name, kept)
            if 't' in names and not self.gaps:
                object.__setattr__(self, 'gaps', tuple(Series('', self.t, self.t).holes()))

    def _check_gaps(self) -> None:
        gaps = array('gaps', self.gaps)
        if gaps.size and (gaps.ndim != 2 or gaps.shape[1] != 2):
            refuse_shape('gaps', gaps, '(k, 2), from and to of each in s')
        edges = gaps.ravel()
        if (np.diff(edges)[::2] <= 0.0).any() or (np.diff(edges) < 0.0).any():
            refuse('gaps', self.gaps, 'from and to of each in s, in the order of time')

    def _check_muscles(self) -> None:
        muscles = sequence('muscles', self.muscles, str, 'the name of a muscle')
        object.__setattr__(self, 'muscles', muscles)
        if len(muscles) == 1 or len({*muscles}) < len(muscles):
            refuse('muscles', muscles, 'no name, or those of several muscles, each once')
        if muscles and self.kind == 'held':
            refuse('kind', self.kind, 'free for a joint of several muscles')
        if muscles and self.force is not None:
            refuse('force', self.force, 'None for a joint of several muscles')

    def _along(self, name: str, value: Any, clock: str, count: int) -> Array:
        """Return *value* as (count,), or (count, muscles) if each muscle has its own."""
        if not (self.muscles and name in OF_MUSCLES):
            return along(name, value, clock, count)
        found, wanted = array(name, value), (count, len(self.muscles))
        if found.shape != wanted:
            refuse_shape(name, found, f'{wanted}, a row for each stamp, a column for each muscle')
        return found

    @classmethod
    def from_dataframe(
        cls,
        frame: Any,
        joint: Bounded | None = None,
        *,
        name: str = 'dataframe',
        mapping: ColumnMapping | None = None,
        kind: str | None = None,
        muscles: Sequence[str] = (),
    ) -> 'Recording':
        """Return the recording in a DataFrame, such as that of pandas, checked.

        Its columns have the names of those of a CSV file, which contain the unit: ``t_s``,
        ``pressure_command_kPa``, ``position_mm``. NaN means that no sample was taken. An index
        with such a name is a column, too; an index of dates is the time. *name* is the name of the
        recording; *joint*, *mapping*, *kind* and *muscles* are those of
        :func:`pam_ros.read_recording`, and so are the errors.
        """
        from pam_ros.recording.read import read_dataframe

        return read_dataframe(frame, joint, name=name, mapping=mapping, kind=kind, muscles=muscles)

    @property
    def period(self) -> float:
        """Return the median sampling period in s."""
        return float(np.median(np.diff(self.t)))

    @property
    def duration(self) -> float:
        """Return the time in s from the first sample to the last, gaps included."""
        return float(self.t[-1] - self.t[0])

    def segments(self) -> list['Recording']:
        """Return the parts between the gaps, in order, each without a gap.

        Times stay on the recording's clock; the commands of a part begin with the one that is
        active at its first sample.
        """
        cuts = [int(np.searchsorted(self.t, start, side='right')) for start, _ in self.gaps]
        edges = [0, *cuts, self.t.size]
        return [self.part(i, j) for i, j in pairwise(edges) if j > i]

    def part(self, start: int, stop: int) -> 'Recording':
        """Return samples start..stop-1 with the commands that are active in them.

        Raises ParameterError if there is no sample.
        """
        t = self.t[start:stop]
        if not t.size:
            refuse('start, stop', (start, stop), f'a slice of {self.t.size} samples, not empty')
        changes: dict[str, Any] = {
            name: None if value is None else value[start:stop]
            for name in OUTPUTS
            for value in (getattr(self, name),)
        }
        if self.command_t is not None and self.command is not None:
            first = max(int(np.searchsorted(self.command_t, t[0], side='right')) - 1, 0)
            last = int(np.searchsorted(self.command_t, t[-1], side='right'))
            changes |= {
                'command_t': self.command_t[first:last],
                'command': self.command[first:last],
            }
        inside = tuple(gap for gap in self.gaps if t[0] <= gap[0] and gap[1] <= t[-1])
        return replace(self, t=t, gaps=inside, **changes)

    def drive(self, step: float) -> tuple[Array, Array]:
        """Return (stamps in s, values in Pa) of the input, each constant until the next stamp.

        Values are (m,) like the stamps, or (m, muscles) for several muscles. They are the command
        as it was recorded. Without a command, they are the measured pressure: it is interpolated
        linearly between its samples, and each interval of at most *step* s gets its mean, so that
        the zero-order hold adds no delay.

        Raises RecordingError if neither was recorded, and ParameterError for a *step* that is not
        positive.
        """
        if number('step', step) <= 0.0:
            refuse('step', step, 'a number of s above 0')
        if self.command_t is not None and self.command is not None:
            return self.command_t, self.command
        if self.pressure is None:
            raise RecordingError(
                f'{self.name}: neither pressure_command nor pressure was recorded'
            )
        count = np.maximum(np.ceil(np.diff(self.t) / step - 1e-9), 1.0).astype(int)
        left = np.repeat(self.t[:-1], count)
        width = np.repeat(np.diff(self.t) / count, count)
        inside = np.arange(left.size) - np.repeat(np.cumsum(count) - count, count)
        stamps = left + inside * width
        middle = stamps + 0.5 * width
        return stamps, interpolated(middle, self.t, self.pressure)


def interpolated(t: Array, known_t: Array, values: Array) -> Array:
    """Return *values* (n,) or (n, muscles) at *known_t*, interpolated linearly at *t*."""
    if values.ndim == 1:
        return np.interp(t, known_t, values)
    return np.stack([np.interp(t, known_t, column) for column in values.T], axis=1)
