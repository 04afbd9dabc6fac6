# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The closed loop in numbers: a rig and two simulators that received the same commands."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from pam_ros.errors import PamError
from pam_ros.identification.wording import Scale, interval, number
from pam_ros.recording.bag.read import read_bag
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.report import style, time_plots
from pam_ros.report.diagnostics import Size, size_of
from pam_ros.report.runs import Run
from pam_ros.report.time_plots import Curve

Array = NDArray[np.float64]

MUSCLE = 'dmsp_20_400n'
# Properties of the rig that the nominal model lacks: friction of the guide, a slow valve, a
# specimen that differs from the manufacturer's data, and noise of the sensor.
HIDDEN: dict[str, Any] = {
    'muscle': MUSCLE,
    'a2': 290.0,
    'a5': 299.0,
    'zeta': 0.2,
    'effects.coulomb_friction.level': 12.0,
    'effects.pressure_lag.fill': 0.04,
    'effects.pressure_lag.vent': 0.04,
    'sensor.position_noise': 5e-5,
}
NOISE = float(HIDDEN['sensor.position_noise'])
CURVES = (Curve(0, 'nominal'), Curve(2, 'identified'))
MM = Scale(1e3, 'mm')
TICK = 1e-6  # s up to which stamps are equal


@dataclass(frozen=True, eq=False)
class Replay:
    """Positions (n,) in m at stamps t (n,) in s: measured, and simulated by two models."""

    t: Array
    measured: Array
    nominal: Array
    identified: Array

    @property
    def run(self) -> Run:
        """The replay in the form for the plots of a report, without a re-tuned model."""
        nothing = np.zeros_like(self.t)
        return Run(
            'replay',
            self.t,
            self.measured,
            (self.nominal, self.nominal, self.identified),
            np.ones(self.t.size, dtype=bool),
            True,
            nothing[:, None],
            nothing,
            nothing,
            nothing,
        )

    def size(self, stage: int) -> Size:
        """Return the error of a stage of :attr:`run`."""
        return size_of([self.run.residual(stage)], [self.measured])


def read_replay(rig: Path, nominal: Path, identified: Path) -> Replay:
    """Return the positions of three bags, of rigs that received the same commands.

    Time starts at the first state of each. The stamps are those of *rig*; the positions of the
    others are interpolated linearly. Raises PamError if their commands differ.
    """
    positions, commands = [], []
    for bag in (rig, nominal, identified):
        series = read_bag(bag, ColumnMapping())[0]
        position, command = (series[k].ascending() for k in ('position', 'pressure_command'))
        start = position.t[0]
        positions.append((position.t - start, position.value))
        commands.append((np.rint((command.t - start) / TICK).astype(int), command.value))
    for at, value in commands[1:]:
        _, mine, others = np.intersect1d(commands[0][0], at, return_indices=True)
        if not np.array_equal(commands[0][1][mine], value[others]):
            raise PamError(f'{rig}, {nominal} and {identified} received different commands')
    t, measured = positions[0]
    inside = t <= min(stamps[-1] for stamps, _ in positions)
    t, measured = t[inside], measured[inside]
    return Replay(t, measured, *(np.interp(t, *other) for other in positions[1:]))


def figure(replay: Replay) -> Figure:
    """Return measured and simulated over the whole replay, with the residuals below."""
    with style.styled():
        drawn = time_plots.measured_and_simulated(
            time_plots.whole([replay.run]), list(CURVES), MM, 'position', NOISE, style.WIDE
        )
        drawn.axes[0].set_title(
            'grey: the rig, dashed: nominal, line: identified', loc='right', color=style.INK
        )
    return drawn


def table(replay: Replay, report: Mapping[str, Any]) -> str:
    """Return the errors before and after the identification, and true and found parameters."""
    lines = [f'{"commands not used to fit":<26}{"RMSE, mm":>10}{"max, mm":>10}{"fit, %":>10}']
    sizes = [(curve.label, replay.size(curve.stage)) for curve in CURVES]
    for label, size in sizes:
        lines.append(
            f'{label:<26}{number(1e3 * size.rmse):>10}{number(1e3 * size.maximum):>10}'
            f'{number(size.fit_percent, 4):>10}'
        )
    lines.append(f'{"noise of the sensor":<26}{number(1e3 * NOISE):>10}')
    lines += ['', f'{"hidden in the rig":<34}{"true":>8}{"found":>10}  95 % interval']
    found = report['parameters']['augmented']
    for name, value in HIDDEN.items():
        if name.startswith('effects.'):
            one = found.get(name)
            text = (
                f'{number(one["value"]):>10}  {interval(one["low"], one["high"])}' if one else ''
            )
            unit = f' [{one["unit"]}]' if one else ''
            lines.append(f'{name.removeprefix("effects.") + unit:<34}{value:>8g}{text}')
    before, after = (size.rmse for _, size in sizes)
    lines += ['', f'{report["verdict"]}: the RMS error fell to 1/{before / after:.0f}']
    return '\n'.join(lines)
