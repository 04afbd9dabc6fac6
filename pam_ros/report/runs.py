# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The segments of a result for the report: measured, three times simulated, inputs."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.segment import FreeSegment, HeldSegment, Segment
from pam_ros.identification.result import Identification
from pam_ros.report.diagnostics import Size, size_of

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
STAGES = ('declared', 'retuned', 'augmented')
FAR = 1e6  # m or N: where a simulation that diverges is cut, so that it can be drawn


@dataclass(frozen=True, eq=False)
class Run:
    """One gapless segment, every array (n,).

    t in s on its recording's clock; target measured, simulated by the three models in the order
    of ``STAGES``, in SI; held marks what no fit has seen. pressure (Pa), contraction and velocity
    (m/s) are those of a free load's last model, without the measurement's noise, and as measured
    of a held one.
    """

    name: str
    t: Array
    target: Array
    simulated: tuple[Array, Array, Array]
    held: Mask
    is_test: bool
    pressure: Array
    contraction: Array
    velocity: Array

    def residual(self, stage: int) -> Array:
        """Return measured - simulated (n,) of a stage."""
        return self.target - self.simulated[stage]


def runs_of(result: Identification) -> list[Run]:
    """Return the runs of an identification: its segments, then those of the test recordings."""
    l0 = result.stages[0].model.muscle.l0
    found = []
    for k, segment in enumerate(result.segments):
        a, b, c = (_cut(stage.simulated[k]) for stage in result.stages)
        held = np.zeros_like(segment.fit) if result.test else ~segment.fit
        found.append(_run(segment, (a, b, c), held, False, l0))
    for k, segment in enumerate(result.test):
        a, b, c = (_cut(stage.tested[k]) for stage in result.stages)
        found.append(_run(segment, (a, b, c), np.ones_like(segment.fit), True, l0))
    return found


def _cut(simulated: Array) -> Array:
    return np.clip(np.nan_to_num(simulated, nan=FAR), -FAR, FAR)


def _run(
    segment: Segment, simulated: tuple[Array, Array, Array], held: Mask, is_test: bool, l0: float
) -> Run:
    if isinstance(segment, FreeSegment):
        position = simulated[-1]
        velocity = np.asarray(np.gradient(position, segment.t), dtype=float)
        at = np.searchsorted(segment.drive_t, segment.t, side='right') - 1
        pressure = segment.drive[np.maximum(at, 0)]
    else:
        assert isinstance(segment, HeldSegment)
        position, velocity, pressure = segment.position, segment.velocity, segment.pressure
    return Run(
        segment.name,
        segment.t,
        segment.target,
        simulated,
        held,
        is_test,
        pressure,
        position / l0,
        velocity,
    )


def sizes(runs: list[Run], stage: int) -> tuple[Size, Size]:
    """Return how large the errors of a stage are: over what was fitted, and over the rest."""
    fit, held = (
        size_of([r.residual(stage)[m] for r, m in picked], [r.target[m] for r, m in picked])
        for picked in ([(r, ~r.held) for r in runs], [(r, r.held) for r in runs])
    )
    return fit, held
