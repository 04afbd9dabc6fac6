# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The paper's experiment in numbers: its printed values next to those of a recorded run.

Sárosi (2015): a DMSP-20-400N at 600 kPa, loaded with 20 kg, released from its length at rest.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pam_ros.demo.run import PublishedRun
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint

PRESSURE = 600e3  # Pa gauge
MASS = 20.0  # kg
SPRING_FORCE = 198.0  # N, section 3: the result of the paper's simulation
STATIC_FORCE = 196.2  # N: m g with the paper's 9.81 m/s^2
SETTLED = 0.25  # s at the end of a run over which its resting values are averaged


@dataclass(frozen=True)
class StepRow:
    """One quantity: the expected value, the source of that value, and our value."""

    quantity: str
    unit: str
    wanted: float
    source: str
    ours: float
    digits: int = 1

    @property
    def difference(self) -> float:
        """Our value minus the expected one, in the row's unit."""
        return self.ours - self.wanted

    def cells(self) -> tuple[str, ...]:
        """Return the row as text, column by column."""
        return (
            f'{self.quantity} [{self.unit}]',
            f'{self.wanted:.{self.digits}f}',
            self.source,
            f'{self.ours:.{self.digits}f}',
            signed(self.difference, self.digits),
            signed(100.0 * self.difference / self.wanted, 2) + ' %',
        )


HEAD = ('quantity', 'paper', 'where', 'ours', 'difference', 'relative')


def signed(value: float, digits: int) -> str:
    """Return a number with its sign; a number that is rounded to 0 has no sign."""
    text = f'{value:+.{digits}f}'
    return text if float(text) else f'{0.0:.{digits}f}'


def resting(run: PublishedRun) -> PublishedRun:
    """Return the last part of a run, in which the load is at rest."""
    return run.between(float(run.t[-1]) - SETTLED, np.inf)


def compare(released: PublishedRun, model: Joint) -> list[StepRow]:
    """Return the paper's values next to those of the released load."""
    end = resting(released)
    l0 = model.muscle.l0
    kappa = model.muscle.equilibrium(PRESSURE, STATIC_FORCE)
    k = float(model.muscle.stiffness(PRESSURE, kappa))
    return [
        StepRow('F_spring at rest', 'N', SPRING_FORCE, 'section 3', float(end.force.mean())),
        StepRow('F_spring at rest', 'N', STATIC_FORCE, 'm g', float(end.force.mean())),
        StepRow(
            'contraction at rest',
            '%',
            100.0 * kappa,
            'equation (1) = m g',
            100.0 * float(end.position.mean()) / l0,
            2,
        ),
        StepRow('stiffness at rest', 'N/m', k, 'equation (2)', float(end.stiffness.mean())),
        StepRow(
            'damping at rest',
            'N s/m',
            2.0 * model.muscle.zeta * float(np.sqrt(MASS * k)),
            'equation (4)',
            float(end.damping.mean()),
        ),
        StepRow(
            'frequency',
            'Hz',
            float(np.sqrt(k / MASS * (1.0 - model.muscle.zeta**2)) / (2.0 * np.pi)),
            'k and c, linearised',
            frequency(released),
            3,
        ),
    ]


def frequency(run: PublishedRun) -> float:
    """Return the frequency in Hz of the last oscillations of a decaying run that can be resolved.

    It follows from the times at which the velocity changes its sign, interpolated linearly.
    """
    v, t = run.velocity, run.t
    turns = np.flatnonzero(v[:-1] * v[1:] < 0.0)
    turns = turns[np.abs(run.position[turns] - run.position[-1]) > 1e-6]
    at = t[turns] - v[turns] * (t[turns + 1] - t[turns]) / (v[turns + 1] - v[turns])
    last = at[-9:]
    return float(0.5 * (len(last) - 1) / (last[-1] - last[0]))


def steps(runs: Sequence[PublishedRun], model: Joint) -> list[StepRow]:
    """Return the contraction at rest after each pressure step, next to that of equation (1)."""
    rows = []
    for run in runs:
        end = resting(run)
        p = float(end.pressure.mean())
        rows.append(
            StepRow(
                f'contraction at {p / 1e3:.0f} kPa',
                '%',
                100.0 * model.muscle.equilibrium(p, float(statics.weight(model, 0.0))),
                'equation (1) = m g',
                100.0 * float(end.position.mean()) / model.muscle.l0,
                2,
            )
        )
    return rows


def table(rows: Sequence[StepRow]) -> str:
    """Return rows as a table in plain text, with numbers aligned to the right."""
    lines = [HEAD, *(row.cells() for row in rows)]
    widths = [max(len(line[i]) for line in lines) for i in range(len(HEAD))]
    left = (0, 2)
    return '\n'.join(
        '  '.join(
            cell.ljust(width) if i in left else cell.rjust(width)
            for i, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )
