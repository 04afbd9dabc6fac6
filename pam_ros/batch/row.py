# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What was found of one rig, as a row of the table of all."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from pam_ros.identification.fit.places import spelled
from pam_ros.identification.identification import Identification
from pam_ros.identification.wording import listed, number, scale_for

NOT_IDENTIFIED = 'not_identified'  # instead of a verdict


@dataclass(frozen=True)
class RigRow:
    """The result of a rig: errors on held-out data and the noise floor in SI, None if not known.

    ``rig`` is its name, and that of the folder of its report. Without a report, ``verdict`` is
    NOT_IDENTIFIED and ``sentence`` says why; else it is the sentence of the verdict.
    """

    rig: str
    recording: str
    verdict: str
    effects: str
    unit: str
    error_nominal: float | None
    error_retuned: float | None
    error_augmented: float | None
    noise_floor: float | None
    sentence: str

    @property
    def is_identified(self) -> bool:
        """Whether there is a report."""
        return self.verdict != NOT_IDENTIFIED

    def text(self, value: float | None) -> str:
        """Return a value in the unit of the row, in the same for all values."""
        scale = scale_for(self.unit, self.error_nominal or 0.0)
        return number(None if value is None else scale.factor * value)

    @property
    def unit_text(self) -> str:
        """The unit of :meth:`text`."""
        return scale_for(self.unit, self.error_nominal or 0.0).unit


def row_of(rig: str, recording: str, answer: Identification) -> RigRow:
    """Return the row of an identification."""
    nominal, retuned, augmented = (stage.held_error for stage in answer.stages)
    return RigRow(
        rig,
        recording,
        str(answer.verdict),
        listed([spelled(finding.name) for finding in answer.effects]),
        answer.unit,
        nominal,
        retuned,
        augmented,
        answer.noise.sigma,
        answer.sentence,
    )


def failed_row(rig: str, recording: str, reason: str) -> RigRow:
    """Return the row of a rig that could not be identified for a *reason*."""
    return RigRow(rig, recording, NOT_IDENTIFIED, '', '', None, None, None, None, reason)


def row_from(content: Mapping[str, Any]) -> RigRow:
    """Return the row that was stored as *content*; raises ValueError if it is something else."""
    names = {field.name for field in fields(RigRow)}
    if not isinstance(content, dict) or set(content) != names:
        raise ValueError(f'a row does not have {", ".join(sorted(names))}')
    return RigRow(**content)


def line(row: RigRow) -> str:
    """Return *row* as a line of text."""
    head = f'{row.rig:<16}  {row.verdict:<21}'
    if not row.is_identified:
        return f'{head}  {row.sentence}'
    errors = f'{row.text(row.error_nominal)} -> {row.text(row.error_augmented)} {row.unit_text}'
    noise = f'noise {row.text(row.noise_floor)} {row.unit_text}'
    return f'{head}  held-out error {errors}, {noise}  {row.effects}'.rstrip()
