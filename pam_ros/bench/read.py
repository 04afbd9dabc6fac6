# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Read the results of a bench from its ``bench.json``."""

import json
import math
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NoReturn

from pam_ros.bench.outcome import (
    NotRun,
    Outcome,
    Provenance,
    Results,
    ScenarioAbout,
    ScoreAbout,
    Status,
)
from pam_ros.bench.save import PROGRAM, SCHEMA_VERSION
from pam_ros.errors import PamError


def read_results(path: Path) -> Results:
    """Return the results that ``save_results`` has written to *path*.

    What follows from the outcomes, such as medians, is not read. Raises PamError if the file
    cannot be read, is damaged, or is of another program or of a version that is not known.
    """
    data = _loaded(path)
    if not isinstance(data, dict) or data.get('program') != PROGRAM:
        raise PamError(f'{path} has no results of {PROGRAM}')
    version = data.get('schema_version')
    known = SCHEMA_VERSION.partition('.')[0]
    if not isinstance(version, str) or version.partition('.')[0] != known:
        raise PamError(
            f'{path} has the schema version {version}, which is not known: it must be {known}.x'
        )
    try:
        results = _results(_Node(data))
        _refuse_contradictions(results)
    except _DamagedError as error:
        raise PamError(f'{path} is damaged: {error}') from None
    return results


def read_outcome(data: Any) -> Outcome:
    """Return the outcome in *data*, a table of ``bench.json``.

    Raises ValueError if it is not as it was written.
    """
    try:
        return _outcome(_Node(data))
    except _DamagedError as error:
        raise ValueError(str(error)) from None


class _DamagedError(Exception):
    """A part of a file that is not as it was written; the text names it."""


class _Node:
    """A value in a file, with the place where it is."""

    def __init__(self, value: Any, place: str = '') -> None:
        self.value, self.place = value, place

    def __getitem__(self, key: str) -> '_Node':
        table = self.table()
        if key not in table:
            inside = f' in {self.place}' if self.place else ''
            raise _DamagedError(f'there is no {key}{inside}')
        return table[key]

    def table(self) -> dict[str, '_Node']:
        if not isinstance(self.value, dict):
            self.refuse('a table')
        return {key: _Node(value, self._inner(key)) for key, value in self.value.items()}

    def items(self) -> list['_Node']:
        if not isinstance(self.value, list):
            self.refuse('a list')
        return [_Node(value, f'{self.place}[{k}]') for k, value in enumerate(self.value)]

    def text(self) -> str:
        if not isinstance(self.value, str):
            self.refuse('a text')
        return str(self.value)

    def texts(self) -> dict[str, str]:
        return {key: node.text() for key, node in self.table().items()}

    def flag(self) -> bool:
        if not isinstance(self.value, bool):
            self.refuse('true or false')
        return bool(self.value)

    def whole(self) -> int:
        if not isinstance(self.value, int) or isinstance(self.value, bool) or self.value < 0:
            self.refuse('a whole number that is not negative')
        return int(self.value)

    def number(self) -> float:
        number = math.nan
        if isinstance(self.value, (int, float)) and not isinstance(self.value, bool):
            try:
                number = float(self.value)
            except OverflowError:  # a whole number with hundreds of digits
                number = math.inf
        if not (math.isfinite(number) and number >= 0.0):
            self.refuse('a finite number that is not negative')
        return number

    def refuse(self, what: str) -> NoReturn:
        raise _DamagedError(f'{self.place or "it"} must be {what}, not {self.value!r}')

    def _inner(self, key: str) -> str:
        return f'{self.place}.{key}' if self.place else key


def _loaded(path: Path) -> Any:
    try:
        if path.exists() and not path.is_file():
            # A device may have no end, and a pipe may have no writer.
            raise PamError(f'{path} cannot be read: it is not a file')
        data = path.read_bytes()
    except OSError as error:
        raise PamError(f'{path} cannot be read: {error.strerror}') from error
    try:
        return json.loads(data.decode('utf-8-sig'), object_pairs_hook=_unique)
    except (ValueError, RecursionError) as error:  # not UTF-8, not JSON, nested without end
        raise PamError(f'{path} is damaged: {error}') from error


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        raise ValueError(f'{_repeated(key for key, _ in pairs)} is in a table twice')
    return table


def _results(data: _Node) -> Results:
    return Results(
        {
            one['name'].text(): ScenarioAbout(one['text'].text(), one['main_score'].text())
            for one in data['scenarios'].items()
        },
        tuple(one.text() for one in data['controllers'].items()),
        tuple(
            ScoreAbout(
                one['name'].text(),
                one['unit'].text(),
                one['text'].text(),
                one['source'].text(),
                one['is_of_machine'].flag(),
            )
            for one in data['scores'].items()
        ),
        tuple(map(_outcome, data['outcomes'].items())),
        _provenance(data['provenance']),
        # Before the schema version 1.1 there were none.
        tuple(map(_not_run, data['not_run'].items())) if 'not_run' in data.table() else (),
    )


def _outcome(data: _Node) -> Outcome:
    known = {str(status): status for status in Status}
    status = known.get(data['status'].text())
    if status is None:
        data['status'].refuse(f'one of {", ".join(known)}')
    return Outcome(
        data['scenario'].text(),
        data['controller'].text(),
        data['seed'].whole(),
        status,
        data['reason'].text(),
        {
            name: None if node.value is None else node.number()
            for name, node in data['scores'].table().items()
        },
        data['is_revolute'].flag(),
        data['is_real_time'].flag(),
        data['seconds'].number(),
        data['simulated'].number(),
    )


def _not_run(data: _Node) -> NotRun:
    return NotRun(
        data['scenario'].text(),
        data['controller'].text(),
        data['seed'].whole(),
        data['reason'].text(),
    )


def _provenance(data: _Node) -> Provenance:
    return Provenance(
        data['command'].text(),
        data['date'].text(),
        data['versions'].texts(),
        data['files'].texts(),
    )


def _refuse_contradictions(results: Results) -> None:
    """Raise _DamagedError if names are repeated, or outcomes are of names that are not listed."""
    scores = [score.name for score in results.scores]
    present: list[Outcome | NotRun] = [*results.outcomes, *results.not_run]
    runs = [(run.scenario, run.controller, run.seed) for run in present]
    for what, names in (
        ('score', scores),
        ('controller', results.controllers),
        ('outcome', [f'{s} of {c} with seed {seed}' for s, c, seed in runs]),
    ):
        if twice := _repeated(names):
            raise _DamagedError(f'the {what} {twice} is there twice')
    listed = {'scenario': set(results.about), 'controller': set(results.controllers)}
    listed['score'] = set(scores)
    used = [('score', about.main_score) for about in results.about.values()]
    for run in present:
        used += [('scenario', run.scenario), ('controller', run.controller)]
    used += [('score', name) for run in results.outcomes for name in run.scores]
    for what, name in used:
        if name not in listed[what]:
            raise _DamagedError(f'the {what} {name} is used, but not described')


def _repeated(names: Iterable[str]) -> str:
    """Return the first of *names* that is there twice, '' if there is none."""
    return next((name for name, count in Counter(names).items() if count > 1), '')
