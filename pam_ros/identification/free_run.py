# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate any joint under the inputs of a recording."""

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from pam_ros.arguments import instance
from pam_ros.identification.data.checked import checked
from pam_ros.identification.data.segment import (
    FreeSegment,
    HeldSegment,
    require_joint,
    segments_of,
)
from pam_ros.identification.fit.of_rig import joint_with
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Joint
from pam_ros.rig.run import Trajectory, simulate, simulate_held, simulate_pressure
from pam_ros.rig.step_limit import longest_step

STEP = 1e-3  # s, longest step of a simulation; a light load needs a shorter one


def simulate_recording(joint: Joint, recording: Recording) -> Trajectory:
    """Simulate *joint* under the inputs of *recording*, from its first sample.

    It is a free run: the measurement of the output has no influence on it after the start. The
    inputs are the commands, or the measured pressures if no commands were recorded; for a
    prescribed length (kind ``held``) they are the measured pressure and position. Each stretch
    between gaps begins where it was measured. Effects begin at their ``onset`` on the clock of the
    recording. The result has the stamps of the samples, in SI; stretches of fewer than four
    samples are left out. If only pressures were recorded, position, velocity and force are not
    simulated: they are NaN. Raises RecordingError for a recording of another joint or one that
    cannot be used, and ParameterError for objects of a wrong type.
    """
    instance('joint', joint, Joint, 'a Joint')
    instance('recording', recording, Recording, 'a Recording')
    require_joint([recording], joint)
    usable = checked(recording, joint)
    joint = joint_with(joint, recording.numbers)
    if usable.kind == 'pressure':
        return _pressures(joint, usable)
    step = min(STEP, *(longest_step(stage) for _, stage in joint.stages))
    runs = []
    for part in segments_of([usable]):
        if isinstance(part, HeldSegment):
            held = part.pressure, part.position, part.velocity
            runs.append(simulate_held(from_start(joint), part.t, *held))
        else:
            assert isinstance(part, FreeSegment)
            inputs = part.t, part.drive, part.drive_t
            start = {'position': part.y0, 'velocity': part.v0, 'step': step}
            runs.append(simulate(joint, *inputs, **start, hidden=None))
    return _joined(runs)


def from_start(joint: Joint) -> Joint:
    """Return *joint* with all effects acting from the start."""
    return joint.map_effects(lambda effects: [replace(one, onset=0.0) for one in effects])


def _joined(runs: Sequence[Trajectory]) -> Trajectory:
    """Return runs one after the other as one."""
    return Trajectory(
        *(np.concatenate([getattr(run, one.name) for run in runs]) for one in fields(Trajectory))
    )


def _pressures(joint: Joint, recording: Recording) -> Trajectory:
    """Return the pressures in the chambers of *joint*, each stretch after a rest at its start."""
    runs = []
    for part in recording.segments():
        drive_t, drive = part.drive(STEP)
        pressure = simulate_pressure(joint, part.t, drive, drive_t, step=STEP)
        nothing = np.full(part.t.size, np.nan)
        runs.append(
            Trajectory(part.t, nothing, nothing, pressure, np.full(pressure.shape, np.nan))
        )
    return _joined(runs)
