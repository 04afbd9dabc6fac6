# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Free runs of models over a recording: plots with the residuals, and a table of the errors."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import RecordingError
from pam_ros.identification.data.noise import noise_of
from pam_ros.identification.data.segment import require_joint
from pam_ros.identification.free_run import simulate_recording
from pam_ros.identification.wording import ABSENT, Scale, interval, number, scale_for
from pam_ros.plot.colours import GREY
from pam_ros.plot.column_names import word
from pam_ros.plot.panels import Panel, PanelLine, with_gaps
from pam_ros.recording.recording import PREDICTED, Recording
from pam_ros.report.diagnostics import Size, size_of
from pam_ros.rig.joint import Joint
from pam_ros.rig.run import Trajectory

Array = NDArray[np.float64]

_TITLES = {'position': 'position', 'force': 'force', 'pressure': 'pressure (gauge)'}


@dataclass(frozen=True, eq=False)
class FreeRun:
    """The free run of a model over a recording.

    ``trajectory`` has the samples at the ``rows`` (m,) of the recording, in SI. ``sizes`` are
    those of its residuals, measured - simulated: one, or one for each muscle if pressures are
    predicted.
    """

    name: str
    trajectory: Trajectory
    rows: NDArray[np.int_]
    sizes: tuple[Size, ...]

    def predicted(self, quantity: str) -> Array:
        """Return what it predicts of *quantity*, a column for each signal (m, signals)."""
        return _columns(getattr(self.trajectory, quantity))


@dataclass(frozen=True, eq=False)
class Comparison:
    """Models beside a recording; ``noises`` are those of each measured signal, in SI."""

    recording: Recording
    runs: tuple[FreeRun, ...]
    noises: tuple[float, ...]

    @property
    def quantity(self) -> str:
        """What the models predict: ``position``, ``force`` or ``pressure``."""
        return PREDICTED[self.recording.kind]

    @property
    def unit(self) -> str:
        """The SI unit of what the models predict."""
        units = {'position': self.recording.unit, 'force': 'N', 'pressure': 'Pa'}
        return units[self.quantity]

    @property
    def end(self) -> float:
        """The last stamp in s."""
        return float(self.recording.t[-1])

    def panels(self) -> list[Panel]:
        """Return the plots: what is predicted, its residuals, and the pressures.

        A measured pressure of a load that moves has the simulated ones beside it.
        """
        signals = range(len(self.noises))
        made = [panel for k in signals for panel in self._predicted(k)]
        if self.quantity != 'pressure':
            made += [self._pressures(k) for k in range(len(self.recording.muscles) or 1)]
        return [panel for panel in made if panel.lines]

    def _predicted(self, k: int) -> tuple[Panel, Panel]:
        """Return the plots of the predicted signal *k*, and of its residuals."""
        t, signal = self.recording.t, _columns(_measured(self.recording))[:, k]
        muscle = self._muscle(k) if self.quantity == 'pressure' else ''
        lines = [_line('measured', GREY, t, signal, _column(muscle, self.quantity), is_below=True)]
        left = []
        for i, run in enumerate(self.runs):
            own_t, simulated = run.trajectory.t, run.predicted(self.quantity)[:, k]
            lines.append(_line(run.name, i, own_t, simulated))
            left.append(_line(run.name, i, own_t, signal[run.rows] - simulated))
        of = f' of {muscle}' if muscle else ''
        return (
            Panel(f'{_TITLES[self.quantity]}{of}, {self.unit}', lines, self.quantity),
            Panel(f'residual (measured − simulated){of}, {self.unit}', left, self.quantity),
        )

    def _pressures(self, k: int) -> Panel:
        """Return the plot of the pressures of muscle *k*: commanded, measured and simulated."""
        recording, muscle, lines = self.recording, self._muscle(k), []
        if recording.command is not None and recording.command_t is not None:
            t, value = recording.command_t, _columns(recording.command)[:, k]
            if t[-1] < self.end:
                t, value = np.append(t, self.end), np.append(value, value[-1])
            # They are held, so that a pause between two of them is no gap.
            column = _column(muscle, 'pressure_command')
            lines.append(PanelLine('commanded', GREY, True, True, t, value, column))
        if recording.pressure is not None:
            measured = _columns(recording.pressure)[:, k]
            column = _column(muscle, 'pressure')
            lines.append(_line('measured', GREY, recording.t, measured, column))
            if len(lines) > 1 and recording.kind == 'free':
                for i, run in enumerate(self.runs):
                    own = run.predicted('pressure')[:, k]
                    lines.append(_line(run.name, i, run.trajectory.t, own))
        of = f' of {muscle}' if muscle else ''
        return Panel(f'{_TITLES["pressure"]}{of}, Pa', lines, 'pressure')

    def _muscle(self, k: int) -> str:
        """Return the name of muscle *k* of a joint that has several, else ''."""
        return self.recording.muscles[k] if self.recording.muscles else ''

    def table(self) -> list[str]:
        """Return the errors of the models as lines of a text, all in the same unit."""
        rows = [['model', 'RMSE', '95 % interval', 'largest', 'fit, %', 'noise floors']]
        several = len(self.noises) > 1
        for run in self.runs:
            for k, (size, noise) in enumerate(zip(run.sizes, self.noises, strict=True)):
                muscle = f' ({self.recording.muscles[k]})' if several else ''
                rows.append([run.name + muscle, *self._row(size, noise)])
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = [
            '  '.join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]).rstrip()
            for row in rows
        ]
        return [self._heading(), *lines]

    def _scale(self) -> Scale:
        finite = [s.rmse for run in self.runs for s in run.sizes if np.isfinite(s.rmse)]
        return scale_for(self.unit, min(finite, default=1.0))

    def _heading(self) -> str:
        scale = self._scale()
        noises = ', '.join(map(scale.text, self.noises))
        return (
            f'{self.recording.name}: errors of free runs in {scale.unit}, over '
            f'{self.recording.t.size} samples with a noise of {noises} {scale.unit}'
        )

    def _row(self, size: Size, noise: float) -> list[str]:
        if not np.isfinite(size.rmse):
            return ['diverges', ABSENT, ABSENT, ABSENT, ABSENT]
        scale = self._scale()
        return [
            scale.text(size.rmse),
            interval(scale.factor * size.low, scale.factor * size.high),
            scale.text(size.maximum),
            number(size.fit_percent),
            number(size.rmse / noise) if noise > 0.0 else ABSENT,
        ]


def compare(recording: Recording, models: Sequence[tuple[str, Joint]]) -> Comparison:
    """Return the free runs of *models* over *recording*, by their names.

    Raises RecordingError if it cannot be a recording of one of the models.
    """
    runs = []
    for name, joint in models:
        try:
            require_joint([recording], joint)
            trajectory = simulate_recording(joint, recording)
        except RecordingError as error:
            raise RecordingError(f'model {name}: {error}') from error
        runs.append(_run(name, trajectory, recording))
    parts = [(part.t, _columns(_measured(part))) for part in recording.segments()]
    noises = tuple(
        noise_of([(t, measured[:, k]) for t, measured in parts]).sigma
        for k in range(parts[0][1].shape[1])
    )
    return Comparison(recording, tuple(runs), noises)


def _run(name: str, trajectory: Trajectory, recording: Recording) -> FreeRun:
    rows = np.searchsorted(recording.t, trajectory.t)
    measured = _columns(_measured(recording))[rows]
    simulated = _columns(getattr(trajectory, PREDICTED[recording.kind]))
    sizes = tuple(size_of([y - x], [y]) for y, x in zip(measured.T, simulated.T, strict=True))
    return FreeRun(name, trajectory, rows, sizes)


def _measured(recording: Recording) -> Array:
    """Return the measured signal that models predict."""
    value = getattr(recording, PREDICTED[recording.kind])
    if value is None:
        raise RecordingError(f'{recording.name}: no {PREDICTED[recording.kind]} was recorded')
    return np.asarray(value)


def _columns(value: Array) -> Array:
    """Return signals (n,) or (n, muscles) with a column for each."""
    return value.reshape(value.shape[0], -1)


def _column(muscle: str, quantity: str) -> str:
    """Return the name of a column of a CSV file, without its unit."""
    return f'{word(muscle)}.{quantity}' if muscle else quantity


def _line(
    name: str, number: int, t: Array, value: Array, column: str = '', *, is_below: bool = False
) -> PanelLine:
    drawn_t, drawn = with_gaps(t, np.where(np.isfinite(value), value, np.nan))
    return PanelLine(name, number, is_below, False, drawn_t, drawn, column)
