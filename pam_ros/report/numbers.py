# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``report.json``: the whole identification in numbers, SI, described in ``docs/report.md``."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from pam_ros.identification.data.noise import noise_of
from pam_ros.identification.fit.places import effect_of, muscle_of
from pam_ros.identification.identification import Identification
from pam_ros.identification.result import Candidate, Estimate, Finding
from pam_ros.recording.recording import OUTPUTS, Recording
from pam_ros.report.provenance import Provenance
from pam_ros.report.runs import STAGES, Run, pressure_runs_of, sizes

# The first number increases when a key is removed or changes its meaning, the second when a key
# is added.
SCHEMA_VERSION = '2.12'

Table = dict[str, Any]


def numbers(result: Identification, runs: list[Run], source: Provenance) -> Table:
    """Return the content of ``report.json``; *runs* are those of the result."""
    return {
        'schema_version': SCHEMA_VERSION,
        'verdict': str(result.verdict),
        'complete': result.is_complete,
        'sentence': result.sentence,
        'effects': [_effect(finding) for finding in result.effects],
        'since': None if result.since is None else asdict(result.since),
        'transition': _transition(result),
        'error': _error(result, runs),
        'pressures': _pressures(pressure_runs_of(result)),
        'structure': {
            'ceiling': result.structure.ceiling,
            'whiteness_p': result.structure.whiteness,
            'share_above_noise': result.structure.share,
        },
        'candidates': [_candidate(candidate) for candidate in result.candidates],
        'parameters': {
            name: _estimates(stage.parameters)
            for name, stage in zip(STAGES, result.stages, strict=True)
        },
        'fits': {
            name: asdict(stage.log) for name, stage in zip(STAGES, result.stages, strict=True)
        },
        'data': _data(runs, source),
        'warnings': list(result.warnings),
        'next_experiment': result.next_experiment,
        'next_command': result.next_command,
        'provenance': _provenance(result, source),
    }


def _transition(result: Identification) -> Table | None:
    """Return the samples that were left out, and the time within which effects develop."""
    if result.transition is None:
        return None
    start, end = result.transition
    return {'start': start, 'end': end, 'development': result.development}


def to_json(content: Table) -> str:
    """Return *content* as JSON; numbers that are not finite become null, as JSON lacks them."""
    return json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False) + '\n'


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _effect(finding: Finding) -> Table:
    return {
        'name': effect_of(finding.name),
        'muscle': muscle_of(finding.name) or None,
        'parameters': _estimates(finding.parameters),
        'alternatives': list(finding.alternatives),
        'or_constants': finding.or_constants,
        'reason': finding.reason,
    }


def _estimates(parameters: Mapping[str, Estimate]) -> Table:
    return {name: asdict(estimate) for name, estimate in parameters.items()}


def _error(result: Identification, runs: list[Run]) -> Table:
    table: Table = {
        'quantity': result.quantity,
        'unit': result.unit,
        'noise_floor': result.noise.sigma,
        'noise_correlation': result.noise.rho,
        'held_out': 'test recordings' if result.test else 'part held out',
    }
    for k, (name, stage) in enumerate(zip(STAGES, result.stages, strict=True)):
        fit, held = sizes(runs, k)
        table[name] = {
            'fit': stage.fit_error,
            'held_out': stage.held_error,
            'details': {'fit': asdict(fit), 'held_out': asdict(held)},
        }
    return table


def _pressures(runs: list[Run]) -> list[Table]:
    """Return a row for each run of a measured pressure: its noise, and the error of each model."""
    return [
        {
            'run': run.name,
            'noise_floor': noise_of([(run.t, run.target)]).sigma,
            **{
                name: float(np.sqrt(np.mean(run.residual(k) ** 2)))
                for k, name in enumerate(STAGES)
            },
        }
        for run in runs
    ]


def _candidate(candidate: Candidate) -> Table:
    return {
        'name': effect_of(candidate.effect),
        'muscle': muscle_of(candidate.effect) or None,
        'on_top_of': list(candidate.parents),
        'fit_error': candidate.fit_error,
        'held_out_error': candidate.choose_error,
        'test': {
            'score_fall': candidate.score_fall,
            'p': candidate.p,
            'gain': candidate.gain,
            'interval_clear': candidate.interval_clear,
        },
        'parameters': _estimates(candidate.parameters),
        'decision': candidate.decision,
        'reason': candidate.reason,
    }


def _data(runs: list[Run], source: Provenance) -> Table:
    fitted, held = (
        sum(int(np.count_nonzero(mask)) for mask in masks)
        for masks in ((run.fitted for run in runs), (run.held for run in runs))
    )
    return {
        'segments': len(runs),
        'fit_samples': fitted,
        'held_out_samples': held,
        'recordings': [
            *(_recording(recording, 'fit') for recording in source.recordings),
            *(_recording(recording, 'test') for recording in source.test),
        ],
    }


def _recording(recording: Recording, role: str) -> Table:
    steps = np.diff(recording.t)
    period = float(np.median(steps))
    regular = steps[steps < 3.0 * period]
    command = recording.command
    signals = [(name, getattr(recording, name)) for name in OUTPUTS]
    ranges: Table = {}
    for name, values in (*signals, ('pressure_command', command)):
        if values is not None:
            names = [f'{muscle}.{name}' for muscle in recording.muscles]
            columns = values.reshape(len(values), -1).T
            own = names if values.ndim > 1 else [name]
            ranges |= {one: _range(column) for one, column in zip(own, columns, strict=True)}
    return {
        'name': recording.name,
        'role': role,
        'kind': recording.kind,
        'samples': recording.t.size,
        'origin': recording.origin,
        'duration': recording.duration,
        'rate': 1.0 / period,
        'jitter': float(np.std(regular)),
        'gaps': [list(gap) for gap in recording.gaps],
        'commands': None if command is None else len(command),
        'unit': recording.unit,
        'ranges': ranges,
        'numbers': dict(recording.numbers),
        'note': recording.note,
        'warnings': list(recording.warnings),
        'sha256': recording.digest or None,
    }


def _range(values: Any) -> list[float]:
    return [float(np.min(values)), float(np.max(values))]


def _provenance(result: Identification, source: Provenance) -> Table:
    return {
        'date': source.date,
        'command': source.command,
        'parameters': {
            'file': source.parameters,
            'sha256': source.digest or None,
            'overrides': list(source.overrides),
        },
        'configuration': dict(source.configuration),
        'uncertain': dict(result.uncertain),
        'recordings': [
            {'name': recording.name, 'sha256': recording.digest or None}
            for recording in (*source.recordings, *source.test)
        ],
        'versions': dict(source.versions),
    }
