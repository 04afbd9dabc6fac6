# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The result of an identification as text: in one line, and in a few tables."""

import textwrap
from collections.abc import Sequence

from pam_ros.identification.fit.places import spelled
from pam_ros.identification.result import Conclusion, Estimate
from pam_ros.identification.verdict import onset_text
from pam_ros.identification.wording import ABSENT, interval, listed, number, percent, scale_for

WIDTH = 95  # characters of a line


def last_line(result: Conclusion) -> str:
    """Return the verdict, and the error of each model on held-out data."""
    nominal, retuned, augmented = (stage.held_error for stage in result.stages)
    scale = scale_for(result.unit, augmented)
    names = [spelled(finding.name) for finding in result.effects]
    since = '' if result.since is None else f'from {onset_text(result)} on'
    words = ' '.join(word for word in (listed(names) if names else '', since) if word)
    found = f' ({words})' if words else ''
    errors = (
        f'{number(scale.factor * nominal)} {scale.unit} nominal, '
        f'{number(scale.factor * retuned)} {scale.unit} re-tuned'
    )
    if result.added:
        more = listed([spelled(name) for name in result.added])
        errors += f', {number(scale.factor * augmented)} {scale.unit} with {more}'
    floor = f'{number(scale.factor * result.noise.sigma)} {scale.unit}'
    mark = '' if result.is_complete else 'incomplete, the search was stopped: '
    return f'{mark}{result.verdict}{found}: held-out error {errors}; noise {floor}'


def summary(
    result: Conclusion, sentence: str, warnings: Sequence[str], next_experiment: str
) -> str:
    """Return the *sentence* of the verdict, the parameters with 95 % intervals, and the errors.

    *warnings* and *next_experiment* are the sentences that follow.
    """
    parts = [
        textwrap.fill(sentence, WIDTH),
        _table(_parameters(result)),
        _table(_errors(result)),
    ]
    if warnings:
        lines = [
            textwrap.fill(w, WIDTH, initial_indent='- ', subsequent_indent='  ') for w in warnings
        ]
        parts.append('\n'.join(['Warnings', *lines]))
    if next_experiment:
        parts.append(textwrap.fill(next_experiment, WIDTH))
    return '\n\n'.join(parts)


def details(result: Conclusion) -> str:
    """Return how the last fits ended, and the effects that were tried, as two tables."""
    fits = [['Fits', 'status', 'iterations', 'simulations', '']]
    for name, stage in zip(_labels(result), result.stages, strict=False):
        log = stage.log
        fits.append([name, str(log.status), str(log.iterations), str(log.simulations), ''])
    tried = [['Effects that were tried', 'score falls by', 'error falls by', '']]
    for one in result.candidates:
        parents = ' with ' + listed([spelled(name) for name in one.parents]) if one.parents else ''
        cells = [number(one.score_fall), percent(one.gain), f'{one.decision}: {one.reason}']
        tried.append([spelled(one.effect) + parents, *cells])
    return '\n\n'.join([_table(fits), _table(tried)])


def _labels(result: Conclusion) -> list[str]:
    """Return the names of the models that differ, the nominal one first."""
    added = listed([spelled(name) for name in result.added])
    return ['nominal', 're-tuned', *([f'with {added}'] if added else [])]


def _parameters(result: Conclusion) -> list[list[str]]:
    """Return a row for each parameter of the last model: name, nominal, value, interval, unit."""
    nominal, last = result.stages[0].parameters, result.stages[-1].parameters
    rows = [['Parameters', 'nominal', 'identified', '95 % interval', '']]
    for name, found in last.items():
        before = number(nominal[name].value) if name in nominal else ABSENT
        rows.append([name, before, number(found.value), _interval(found), found.unit])
    return rows


def _interval(estimate: Estimate) -> str:
    text = interval(estimate.low, estimate.high)
    return f'{text}, at its bound' if estimate.at_bound else text


def _errors(result: Conclusion) -> list[list[str]]:
    """Return a row for each model that differs, and one for the noise."""
    scale = scale_for(result.unit, result.stages[-1].fit_error)
    rows = [['Errors (RMSE)', 'fitted', 'held out', '']]
    for name, stage in zip(_labels(result), result.stages, strict=False):
        rows.append([name, scale.text(stage.fit_error), scale.text(stage.held_error), scale.unit])
    return [*rows, ['noise', scale.text(result.noise.sigma), '', scale.unit]]


def _table(rows: Sequence[Sequence[str]]) -> str:
    """Return *rows* as lines with aligned columns; the first row has the title and the headings.

    The first and the last column begin at the left, the others end at the right.
    """
    first, *others = rows
    rows = [first, *(['  ' + row[0], *row[1:]] for row in others)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    ends = (0, len(widths) - 1)
    lines = [
        '  '.join(
            cell.ljust(width) if k in ends else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        for row in rows
    ]
    return '\n'.join(line.rstrip() for line in lines)
