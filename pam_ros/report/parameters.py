# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``identified.yaml``: the best model of a trace as the parameter file of a simulator."""

from pathlib import Path

from pam_ros import parameter_files
from pam_ros.config import Values, flat_rig
from pam_ros.identification.result import Trace
from pam_ros.report.provenance import Provenance
from pam_ros.report.wording import listed, number
from pam_ros.rig.model import RigModel


def identified(trace: Trace) -> RigModel:
    """Return the model that the trace ends with: re-tuned, with the effects that it found."""
    return trace.stages[-1].model


def values(model: RigModel) -> Values:
    """Return the flat parameters of a rig; effects that are absent are left out."""
    present = {effect.name for effect in model.present}
    return {
        name: value
        for name, value in flat_rig(model).items()
        if not name.startswith('effects.') or name.split('.')[1] in present
    }


def write_identified(path: Path, trace: Trace, source: Provenance) -> None:
    """Write the identified model as a ROS parameter file for every node that takes a rig.

    Constants are in the units of the declared file. Read again, it makes the same rig to the bit.
    """
    parameter_files.write(path, values(identified(trace)), about(trace, source))


def about(trace: Trace, source: Provenance) -> str:
    """Return the comment at the head of the file: what it is, and where it comes from."""
    declared, *_, last = trace.stages
    names = [finding.name for finding in trace.effects]
    lines = [
        'Identified by pam_identify: ' + trace.verdict + '.',
        trace.sentence,
        'Effects that were added: ' + (listed(names) or 'none') + '.',
        f'Error on held-out data: {number(declared.held_error)} {trace.unit} as declared, '
        f'{number(last.held_error)} {trace.unit} now; noise {number(trace.noise.sigma)} '
        f'{trace.unit}.',
        f'Declared: {source.parameters}, SHA-256 {source.digest}.',
        *(f'  with {override}' for override in source.overrides),
        *(
            f'Recording: {recording.name}, SHA-256 {recording.digest}.'
            for recording in source.recordings
        ),
        *(
            f'Test recording: {recording.name}, SHA-256 {recording.digest}.'
            for recording in source.test
        ),
        f'Written {source.date} by pam_ros {source.versions["pam_ros"]}. Use it with',
        '  pam_sim --ros-args --params-file identified.yaml',
    ]
    return '\n'.join(lines)
