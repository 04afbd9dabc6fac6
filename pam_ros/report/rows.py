# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The rows of a page's tables: numbers of the result as texts, in convenient units."""

from dataclasses import dataclass
from typing import Any

from pam_ros.identification.identification import Identification
from pam_ros.identification.result import Candidate, Estimate
from pam_ros.identification.wording import (
    ABSENT,
    Scale,
    interval,
    listed,
    name_in_words,
    number,
    percent,
    probability,
    scale_for,
)
from pam_ros.recording.quantities import quantity_in
from pam_ros.report import tried as tried_effects
from pam_ros.report.numbers import Table
from pam_ros.report.provenance import Provenance
from pam_ros.report.runs import STAGES
from pam_ros.settings.nominal import NominalJoint

ORDER = {kind: k for k, kind in enumerate((*tried_effects.OPEN, 'rejected', 'untestable'))}


@dataclass(frozen=True)
class Row:
    """Cells by the name of their column, and a word that selects the style of the row."""

    cells: dict[str, Any]
    kind: str = ''


def errors(content: Table, scale: Scale, labels: dict[int, str]) -> list[Row]:
    """Return a row for each model in *labels* (stage -> name): RMSE, fit, maximum."""
    error = content['error']
    floor = error['noise_floor']
    found = []
    for stage, label in labels.items():
        sizes = error[STAGES[stage]]['details']
        cells: dict[str, Any] = {'model': label}
        for which, size in sizes.items():
            rmse, low, high = (size[key] for key in ('rmse', 'low', 'high'))
            cells[which] = {
                'rmse': scale.text(rmse),
                'interval': interval(scale.factor * low, scale.factor * high, 2),
                'fit': number(size['fit_percent'], 4),
                'maximum': scale.text(size['maximum']),
                'times': number(rmse / floor, 2) if floor > 0.0 else ABSENT,
            }
        found.append(Row(cells, STAGES[stage]))
    return found


@dataclass(frozen=True)
class Round:
    """The effects that were added to a model: rows to be seen, and those that are folded."""

    title: str
    shown: list[Row]
    folded: list[Row]

    @property
    def summary(self) -> str:
        """How many rows are folded, and why."""
        count = len(self.folded)
        hidden = sum(row.kind == 'untestable' for row in self.folded)
        cannot = f', {hidden} of them since these data cannot show it' if hidden else ''
        return f'{count} more effect{"" if count == 1 else "s"}, not chosen{cannot}'


def rounds(result: Identification, scale: Scale) -> list[Round]:
    """Return the rounds of the search.

    Within a round the candidates are in the order of ``ORDER``, then of their score. Those that
    were chosen or nearly chosen are shown; without any, the best one is.
    """
    found = []
    for parents, tried in tried_effects.rounds_of(result).items():
        rows = [
            _candidate(candidate, result, scale)
            for candidate in sorted(
                tried,
                key=lambda c: (ORDER[tried_effects.kind_of(c, result)], -c.score_fall),
            )
        ]
        count = sum(row.kind in tried_effects.OPEN for row in rows) or 1
        base = listed([name_in_words(name) for name in parents]) or 're-tuning'
        found.append(Round(f'In addition to {base}', rows[:count], rows[count:]))
    return found


def _candidate(candidate: Candidate, result: Identification, scale: Scale) -> Row:
    decision, reason = tried_effects.decision_of(candidate, result)
    cells = {
        'effect': name_in_words(candidate.effect),
        'error': scale.text(candidate.choose_error),
        'bar': round(100.0 * min(1.0, 1.0 - candidate.gain), 1),
        'score': number(candidate.score_fall, 4 if candidate.score_fall >= 1e3 else 3),
        'gain': percent(candidate.gain),
        'p': probability(candidate.p),
        'decision': decision,
        'reason': reason,
    }
    return Row(cells, tried_effects.kind_of(candidate, result))


def parameters(result: Identification, nominal: NominalJoint) -> list[Row]:
    """Return a row for each parameter that a stage fitted: value and interval in each stage."""
    names: dict[str, None] = {}
    for stage in result.stages:
        names.update(dict.fromkeys(stage.parameters))
    found = []
    for name in names:
        stages = [stage.parameters.get(name) for stage in result.stages]
        known = next(estimate for estimate in stages if estimate is not None)
        is_at_bound = any(estimate is not None and estimate.at_bound for estimate in stages)
        cells: dict[str, Any] = {
            'name': name,
            'unit': known.unit,
            'text': nominal.text(name),
        }
        for key, estimate in zip(STAGES, stages, strict=True):
            cells[key] = _estimate(estimate)
        found.append(Row(cells, 'bound' if is_at_bound else ''))
    return found


def _estimate(estimate: Estimate | None) -> dict[str, Any]:
    if estimate is None:
        return {'value': ABSENT, 'interval': '', 'at_bound': False}
    is_fitted = estimate.low != estimate.high
    return {
        'value': number(estimate.value, 5 if abs(estimate.value) >= 100.0 else 4),
        'interval': interval(estimate.low, estimate.high) if is_fitted else '',
        'at_bound': estimate.at_bound,
    }


def recordings(content: Table) -> list[Row]:
    """Return a row for each recording: its sampling and its ranges."""
    found = []
    for one in content['data']['recordings']:
        period = 1.0 / one['rate']
        cells = {
            'name': one['name'],
            'role': 'fitted' if one['role'] == 'fit' else 'test',
            'kind': one['kind'],
            'samples': f'{one["samples"]:,}'.replace(',', ' '),
            'duration': f'{number(one["duration"], 4)} s',
            'rate': f'{number(one["rate"], 4)} Hz',
            'jitter': _jitter(one['jitter'] / period),
            'gaps': str(len(one['gaps'])),
            'commands': ABSENT if one['commands'] is None else str(one['commands']),
            'stated': [
                *(f'{name} = {value:g}' for name, value in one['numbers'].items()),
                *([one['note']] if one['note'] else []),
            ],
            'ranges': [
                _range(name, low, high, one['unit']) for name, (low, high) in one['ranges'].items()
            ],
        }
        found.append(Row(cells, one['role']))
    return found


def _jitter(share: float) -> str:
    return 'below 0.1 %' if share < 1e-3 else f'{percent(share)} of a period'


def _range(name: str, low: float, high: float, unit: str) -> str:
    si = quantity_in(unit, name.rpartition('.')[2]).si
    scale = scale_for(si, max(abs(low), abs(high)))
    if low == high:
        return f'{name_in_words(name)} {scale.text(low)} {scale.unit}'
    ends = interval(scale.factor * low, scale.factor * high)
    return f'{name_in_words(name)} {ends} {scale.unit}'


def configuration(source: Provenance) -> list[tuple[str, str]]:
    """Return name and value, with its unit, of everything that was configured."""
    found = []
    for name, value in source.configuration.items():
        unit = source.nominal.unit(name)
        text = f'{value:g}' if isinstance(value, float) else str(value)
        if isinstance(value, tuple):
            text = ', '.join(value)
        if text:
            found.append((name, f'{text} {unit}'.strip()))
    return found
