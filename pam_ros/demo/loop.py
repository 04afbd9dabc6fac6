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

from pam_ros.recording.bag import read_bag
from pam_ros.recording.mapping import read_mapping
from pam_ros.report import style, time_plots
from pam_ros.report.diagnostics import Size, size_of
from pam_ros.report.runs import Run
from pam_ros.report.time_plots import Curve
from pam_ros.report.wording import Scale, interval, number

Array = NDArray[np.float64]

MUSCLE = 'dmsp_20_400n'
# Properties of the rig that the nominal model lacks: friction of the guide, a slow valve, a
# specimen that differs from the maker's data, and noise of the sensor.
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


@dataclass(frozen=True, eq=False)
class Replay:
    """Positions (n,) in m at stamps t (n,) in s: measured, and simulated by two models."""

    t: Array
    measured: Array
    declared: Array
    identified: Array

    @property
    def run(self) -> Run:
        """The replay in the form for the plots of a report, without a re-tuned model."""
        nothing = np.zeros_like(self.t)
        return Run(
            'replay',
            self.t,
            self.measured,
            (self.declared, self.declared, self.identified),
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


def read_replay(bag: Path, command: str, rig: str, declared: str, identified: str) -> Replay:
    """Return the positions that three rigs of a bag published, named by their namespaces.

    *command* is the topic that all of them received: time starts at its first message. The stamps
    are those of *rig*; the positions of the others are interpolated linearly.
    """
    mapping = read_mapping([f'{command}=pressure_command_Pa'])
    stamps, values = [], []
    for space in (rig, declared, identified):
        series = read_bag(bag, mapping, space)[0]
        stamps.append(series['position'].t - series['pressure_command'].t[0])
        values.append(series['position'].value)
    inside = (stamps[0] >= 0.0) & (stamps[0] <= min(t[-1] for t in stamps))
    t = stamps[0][inside]
    first, second = (np.interp(t, stamps[k], values[k]) for k in (1, 2))
    return Replay(t, values[0][inside], first, second)


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
    lines += ['', f'{report["verdict"]}: the error fell to 1/{before / after:.0f}']
    return '\n'.join(lines)
