# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The identification of one rig, in a process of its own: its report, and a row of the table."""

import argparse
from dataclasses import dataclass
from pathlib import Path

from pam_ros.batch.rigs import Rig
from pam_ros.batch.row import RigRow, row_of
from pam_ros.report.provenance import provenance
from pam_ros.report.write import write_report
from pam_ros.settings.inputs import read_inputs


@dataclass(frozen=True)
class RigTask:
    """A rig, the options of the command line, the folder for its report, and the command."""

    rig: Rig
    given: argparse.Namespace
    folder: Path
    command: str


def identify_rig(task: RigTask) -> RigRow:
    """Identify a rig and write its report; raises PamError if its recordings cannot be used."""
    rig = task.rig
    # What is set before one of several files is the nominal model of this rig alone.
    own = [*task.given.set, *(f'{name}={value}' for name, value in rig.values.items())]
    given = argparse.Namespace(**{**vars(task.given), 'set': own})
    inputs = read_inputs(given, ([rig.path], []), ([{}], []))
    source = provenance(inputs, own, task.command)
    answer = inputs.identify()
    write_report(task.folder, answer, source)
    return row_of(rig.name, rig.path, answer)
