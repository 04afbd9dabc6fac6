# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read a recording and the models to compare with it, from the files of a command line."""

import json
from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from pam_ros.plot.compared import Comparison, compare
from pam_ros.plot.options import ModelOption
from pam_ros.recording.mapping import ColumnMapping
from pam_ros.recording.read import read_recording
from pam_ros.recording.recording import Recording
from pam_ros.settings.nominal import NominalJoint, example_mass, nominal_joint

REPORT = 'report.json'


class Found(NamedTuple):
    """A comparison, and notes on the recording and on the models."""

    comparison: Comparison
    notes: tuple[str, ...]


def read_comparison(
    path: Path,
    models: Sequence[ModelOption],
    namespace: str | None,
    mapping: ColumnMapping,
    columns: Sequence[str] = (),
    sheet: str | None = None,
    variable: str | None = None,
) -> Found:
    """Return the free runs of *models*, at least one, over the recording at *path*.

    The other arguments are those of :func:`pam_ros.plot.recorded.read`. The first model gives the
    names of muscles in the recording. Raises PamError for what cannot be used.
    """
    nominal = [nominal_joint(one.params, one.values) for one in models]
    first = nominal[0]
    recording = read_recording(
        path,
        first.joint,
        mapping=mapping,
        namespace=namespace,
        muscles=first.recorded_muscles,
        columns=columns,
        sheet=sheet,
        variable=variable,
    )
    named = [(one.name, own.joint) for one, own in zip(models, nominal, strict=True)]
    comparison = compare(recording, named)
    notes = [*recording.warnings]
    for one, own in zip(models, nominal, strict=True):
        notes += _notes(one, own, recording)
    return Found(comparison, tuple(dict.fromkeys(notes)))


def _notes(model: ModelOption, nominal: NominalJoint, recording: Recording) -> list[str]:
    """Return sentences on what may mislead in a comparison with this model."""
    notes = []
    if recording.digest in _fitted_digests(Path(model.params)):
        notes.append(
            f'{model.name} was fitted to this recording: its error on a new one is larger'
        )
    if recording.kind == 'free':
        names = {text.partition('=')[0].strip() for text in model.values}
        assumed = example_mass(model.params, nominal.joint, names)
        notes += [f'{model.name}: {assumed}'] if assumed else []
    if recording.kind != 'held':
        joint = nominal.joint
        effects = [joint.effects, *(actuator.effects for actuator in joint.actuators)]
        notes += [
            f'{model.name}: {one.name} begins at {one.onset:g} s, as its file says'
            for one in chain(*effects)
            if one.onset > 0.0
        ]
    return notes


def _fitted_digests(params: Path) -> set[str]:
    """Return the digests of the recordings to which an ``identified.yaml`` was fitted.

    They are in the report beside it; the set is empty without a report that can be read.
    """
    try:
        report = json.loads(params.with_name(REPORT).read_text(encoding='utf-8'))
        recordings = report['data']['recordings']
        return {one['sha256'] for one in recordings if one['role'] == 'fit' and one['sha256']}
    except (OSError, ValueError, KeyError, TypeError):
        return set()
