# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``residual.csv``: every sample, measured and simulated, with its residuals."""

from itertools import repeat

import numpy as np
from numpy.typing import NDArray

from pam_ros.report.runs import STAGES, Run

Array = NDArray[np.float64]


def header(quantity: str, unit: str) -> list[str]:
    """Return the column names, each with its unit: ``position_m``, ``residual_retuned_m``."""
    return [
        'recording',
        'segment',
        'set',
        't_s',
        f'{quantity}_{unit}',
        *(f'{quantity}_{name}_{unit}' for name in STAGES),
        *(f'residual_{name}_{unit}' for name in STAGES),
    ]


def residual_csv(runs: list[Run], quantity: str, unit: str) -> str:
    """Return the text of ``residual.csv``.

    One row for each sample: recording, number of the gapless segment (from 0), fit or held_out,
    stamp on the recording's clock, measured, simulated by each model, residuals measured -
    simulated.
    """
    lines = [','.join(header(quantity, unit))]
    for k, run in enumerate(runs):
        columns = [
            run.target,
            *run.simulated,
            *(run.residual(stage) for stage in range(len(STAGES))),
        ]
        sets = np.where(run.held, 'held_out', 'fit').tolist()
        rows = zip(
            repeat(f'{_quoted(run.name)},{k}'),
            sets,
            map('{:.9g}'.format, run.t.tolist()),
            *(map('{:.9g}'.format, column.tolist()) for column in columns),
            strict=False,
        )
        lines.extend(map(','.join, rows))
    return '\n'.join(lines) + '\n'


def _quoted(name: str) -> str:
    if set(name) & set('",\r\n'):
        return '"' + name.replace('"', '""') + '"'
    return name
