# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The segments of a result for the report: measured, simulated by three models, and inputs."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.data.by_signal import of_chambers
from pam_ros.identification.data.segment import (
    CommandedSegment,
    HeldSegment,
    PressureSegment,
    Segment,
    segments_of,
)
from pam_ros.identification.identification import Identification
from pam_ros.report.diagnostics import Size, size_of
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint
from pam_ros.rig.run import simulate_pressure

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
STAGES = ('declared', 'retuned', 'augmented')
DRAW_LIMIT = 1e8  # m, rad, N or Pa: limit at which a diverging simulation is clipped for drawing


@dataclass(frozen=True, eq=False)
class Run:
    """One gapless segment, every array (n,).

    t is in s on the clock of its recording. target is measured, simulated is by the three models
    in the order of ``STAGES``, both in SI. held marks samples that were not fitted. pressures (n,
    muscles) in Pa are the input of a free load (the commands if they were recorded), or the
    pressures at a prescribed length (measured, if they were recorded). position and velocity (m or
    rad, and per s) are those of the last model for a free load, without the noise of the
    measurement, or measured ones at a prescribed length, or 0 if only pressures were recorded.
    drive (n,) in Pa is the input as one signal, see :func:`drive_of`; that of a pressure is its
    own command. since is the time in s from which effects act, None if from the start, and
    transition are the start and the end in s of samples that no fit has used, None without them.
    """

    name: str
    t: Array
    target: Array
    simulated: tuple[Array, Array, Array]
    held: Mask
    is_test: bool
    pressures: Array
    position: Array
    velocity: Array
    drive: Array
    since: float | None = None
    transition: tuple[float, float] | None = None

    @property
    def fitted(self) -> Mask:
        """Marks the samples that were fitted (n,)."""
        start, end = self.transition or (np.inf, np.inf)
        return ~self.held & ((self.t < start) | (self.t >= end))

    def residual(self, stage: int) -> Array:
        """Return measured - simulated (n,) of a stage."""
        return self.target - self.simulated[stage]


def runs_of(result: Identification) -> list[Run]:
    """Return the runs of an identification: its segments, then those of the test recordings."""
    joint = result.stages[0].model
    found = []
    for k, segment in enumerate(result.segments):
        a, b, c = (_cut(stage.simulated[k]) for stage in result.stages)
        held = np.zeros_like(segment.fit) if result.test else ~segment.fit
        run = _run(segment, (a, b, c), held, False, joint)
        since = None if result.since is None else result.since.value
        found.append(replace(run, since=since, transition=result.transition))
    for k, segment in enumerate(result.test):
        a, b, c = (_cut(stage.tested[k]) for stage in result.stages)
        found.append(_run(segment, (a, b, c), np.ones_like(segment.fit), True, joint))
    return found


def pressure_runs_of(result: Identification) -> list[Run]:
    """Return the runs of the measured pressures of a load that moves, if the result uses them.

    They are those of each muscle of the fitted recordings, simulated from the commands. Effects
    behind the chambers have no influence on them.
    """
    if not result.uses_pressures:
        return []
    found = []
    joints = [stage.model for stage in result.stages]
    for recording in result.recordings:
        for segment in segments_of([of_chambers(recording)]):
            assert isinstance(segment, PressureSegment)
            given = segment.t, segment.drive, segment.drive_t
            a, b, c = (
                _cut(simulate_pressure(joint, *given).reshape(segment.t.size, -1))[
                    :, segment.muscle
                ]
                for joint in joints
            )
            held = np.zeros_like(segment.fit)
            found.append(_run(segment, (a, b, c), held, False, joints[0]))
    return found


def _cut(simulated: Array) -> Array:
    return np.clip(np.nan_to_num(simulated, nan=DRAW_LIMIT), -DRAW_LIMIT, DRAW_LIMIT)


def _run(
    segment: Segment,
    simulated: tuple[Array, Array, Array],
    held: Mask,
    is_test: bool,
    joint: Joint,
) -> Run:
    weights = drive_of(joint)
    if isinstance(segment, CommandedSegment):
        pressures, position = segment.commands(segment.t), simulated[-1]
        if isinstance(segment, PressureSegment):
            weights = np.eye(len(joint.muscles))[segment.muscle]
            position = np.zeros_like(segment.t)
        velocity = np.asarray(np.gradient(position, segment.t), dtype=float)
    else:
        assert isinstance(segment, HeldSegment)
        position, velocity = segment.position, segment.velocity
        pressures = segment.pressure[:, None]
    return Run(
        segment.name,
        segment.t,
        segment.target,
        simulated,
        held,
        is_test,
        pressures,
        position,
        velocity,
        pressures @ weights,
    )


def drive_of(joint: Joint) -> Array:
    """Return the weights (muscles,) of the pressures in the one signal that drives *joint*.

    For antagonistic muscles the signal is the difference of the pressures, positive if they move
    the joint to positive positions. For muscles that pull in the same direction it is their mean.
    """
    if joint.is_driven:
        return np.ones(1)
    signs = np.sign(statics.middle_arms(joint))
    count = max(np.count_nonzero(signs > 0.0), np.count_nonzero(signs < 0.0))
    return np.asarray(signs / count)


def sizes(runs: list[Run], stage: int) -> tuple[Size, Size]:
    """Return the sizes of the errors of a stage: over the fitted and the held-out samples."""
    fit, held = (
        size_of([r.residual(stage)[m] for r, m in picked], [r.target[m] for r, m in picked])
        for picked in ([(r, r.fitted) for r in runs], [(r, r.held) for r in runs])
    )
    return fit, held
