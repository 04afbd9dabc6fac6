# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The outcomes of a bench as text for a terminal: a line for each run, and a table at the end."""

import textwrap
from collections.abc import Sequence

from pam_ros.bench.compare import LEVEL, RELEVANT, Comparison, compared, standings
from pam_ros.bench.outcome import NotRun, Outcome, Results, ScoreAbout
from pam_ros.errors import printable, shown
from pam_ros.identification.wording import (
    ABSENT,
    Scale,
    listed,
    name_in_words,
    number,
    percent,
    scale_for,
)

WIDTH = 100  # characters of a line
NAME = 20  # characters of a name in a table
COLUMN = 10  # characters of a line of a heading
GAP = '  '
INDENT = '    '  # of what belongs to the line before
# A score of each kind has a column in addition to the main one: the first that has a value.
KINDS = (
    ('rms_error', 'error_at_rest', 'worst_error'),
    ('settling_time', 'force_response', 'recovery', 'overshoot'),
    ('chatter', 'pressure_variation', 'filling'),
    ('computing_time', 'computing_time_worst'),
)
UNITS = {'percent': '%', 'um/N': 'µm/N'}
NOT_RUN = 'could not be run'


def value_text(value: float | None, unit: str, digits: int = 3) -> str:
    """Return *value* with its unit: positions in mm or mrad; a dash if there is no value."""
    if value is None:
        return ABSENT
    scale = scale_in(unit)
    return f'{scale.text(value, digits)} {scale.unit}'


def scale_in(unit: str) -> Scale:
    """Return the unit in which scores in *unit* are shown, the same for all sizes."""
    return scale_for(unit, 1.0) if unit in ('m', 'rad') else Scale(1.0, UNITS.get(unit, unit))


def line(outcome: Outcome, scores: Sequence[ScoreAbout], main_score: str) -> str:
    """Return a run in one line, with its main score; of a run that failed, the reason.

    The second score is left out if there is no space for it, and a long reason is continued in
    the next lines.
    """
    head = _head(outcome)
    if not outcome.is_completed:
        return _filled(GAP.join([*head, _ended(outcome.status.words, outcome.reason)]))
    about = {score.name: score for score in scores}
    names = [name for name in (main_score, *KINDS[0]) if name in about]
    texts = [
        f'{name_in_words(name)} {value_text(outcome.scores.get(name), unit)}'
        for name in dict.fromkeys(names)
        for unit in [about[name].unit_for(revolute=outcome.is_revolute)]
    ]
    pace = _pace(outcome)
    both = GAP.join([*head, *texts[:2], *pace])
    return both if len(both) <= WIDTH else GAP.join([*head, texts[0], *pace])


def line_of_not_run(one: NotRun) -> str:
    """Return a run that could not be performed, with the reason, as the lines of the others."""
    return _filled(GAP.join([*_head(one), _ended(NOT_RUN, one.reason)]))


def _head(run: Outcome | NotRun) -> list[str]:
    """Return which run it is, in columns."""
    return [
        f'{_clipped(run.scenario):<16}',
        f'{_clipped(run.controller):<12}',
        f'seed {run.seed}',
    ]


def table(results: Results) -> str:
    """Return a table for each scenario, and the standing of each controller over all of them."""
    scenarios = [_scenario(results, name) for name in results.about]
    legend = '\n'.join(_filled(sentence) for sentence in _legend(results))
    return '\n\n'.join([*scenarios, _standings(results), legend])


def _pace(outcome: Outcome) -> list[str]:
    """Return how fast the run was, if that is known."""
    if outcome.is_real_time:
        return ['in real time']
    if not (outcome.simulated > 0.0 and outcome.seconds > 0.0):
        return []
    return [f'{number(outcome.simulated / outcome.seconds, 2)}x real time']


def _scenario(results: Results, scenario: str) -> str:
    """Return the table of *scenario*: a row for each controller, the main score first."""
    about = results.about[scenario]
    names = [about.main_score, *_others(results, scenario)]
    columns = [compared(results, scenario, name) for name in names]
    rows: dict[str, list[str]] = {}
    for k, controller in enumerate(results.controllers):
        if any(run.is_completed for run in results.runs(scenario, controller)):
            rows[controller] = _cells([column[k] for column in columns], results)
    headings = _headings(results, scenario, names)
    parts = zip(headings, *rows.values(), strict=True)
    widths = [max(len(text) for text in (*heading, *cells)) for heading, *cells in parts]
    height = max(map(len, headings))
    padded = [[''] * (height - len(heading)) + heading for heading in headings]
    title = f'{scenario}: {about.text}' if about.text else scenario
    lines = [_filled(title)]
    lines += [
        _row('controller' * (k == height - 1), [h[k] for h in padded], widths)
        for k in range(height)
    ]
    for controller in results.controllers:
        failures = _failures(results, scenario, controller)
        if controller in rows:
            lines.append(_row(controller, rows[controller], widths))
        elif failures:
            failures[0] = f'{GAP}{_clipped(controller):<{NAME}}{GAP}{failures[0]}'
            lines.append(_filled(failures.pop(0)))
        lines += [_filled(INDENT + text) for text in failures]
    return '\n'.join(lines)


def _others(results: Results, scenario: str) -> list[str]:
    """Return the scores that are shown in addition to the main one."""
    present = {
        name
        for run in results.outcomes
        if run.scenario == scenario and run.is_completed
        for name, value in run.scores.items()
        if value is not None
    }
    present &= {score.name for score in results.scores}
    present -= {results.about[scenario].main_score}
    firsts = [next((name for name in kind if name in present), '') for kind in KINDS]
    return [name for name in firsts if name]


def _headings(results: Results, scenario: str, names: list[str]) -> list[list[str]]:
    """Return the lines of each heading: the main score has a second column, its worst value."""
    units = [scale_in(results.unit(scenario, name)).unit for name in names]
    texts = [f'{name_in_words(name)}, {unit}' for name, unit in zip(names, units, strict=True)]
    texts.insert(1, f'its worst, {units[0]}')
    return [textwrap.wrap(text, COLUMN) for text in texts]


def _cells(scores: list[Comparison], results: Results) -> list[str]:
    """Return the numbers of a row; there is a space where others have an asterisk."""
    cells = []
    for one in scores:
        scale = scale_in(results.unit(one.scenario, one.score))
        median, worst = (
            ABSENT if value is None else scale.text(value) for value in (one.median, one.worst)
        )
        cells.append(median + ('*' if one.is_best else ' '))
        if one is scores[0]:
            cells.append(worst + ' ')
    return cells


def _row(name: str, cells: Sequence[str], widths: Sequence[int]) -> str:
    ends = [cell.rjust(width) for cell, width in zip(cells, widths, strict=True)]
    return f'{GAP}{_clipped(name):<{NAME}}{GAP}{GAP.join(ends)}'.rstrip()


def _failures(results: Results, scenario: str, controller: str) -> list[str]:
    """Return a text for each way in which runs failed, with the reason of the first of them."""
    runs = results.runs(scenario, controller)
    failed = [run for run in runs if not run.is_completed]
    texts = []
    for status in dict.fromkeys(run.status for run in failed):
        same = [run for run in failed if run.status is status]
        share = f' with {len(same)} of {len(runs)} seeds' if len(runs) > 1 else ''
        texts.append(_ended(status.words + share, same[0].reason))
    lacking = results.lacking(scenario, controller)
    return texts + [_ended(f'{NOT_RUN} with seed {one.seed}', one.reason) for one in lacking]


def _ended(what: str, reason: str) -> str:
    return f'{what}: {reason}' if reason else what


def _standings(results: Results) -> str:
    """Return in how many scenarios each controller is best, is not worse, and failed."""
    count = len(results.about)
    title = f'{count} scenarios, by their main scores' if count > 1 else '1 scenario'
    headings = ['best', 'not worse', 'failed']
    widths = [max(len(heading), len(str(count))) for heading in headings]
    lines = [title, _row('controller', headings, widths)]
    for one in standings(results):
        lines.append(
            _row(one.controller, list(map(str, (one.best, one.not_worse, one.failed))), widths)
        )
    return '\n'.join(lines)


def criterion(results: Results) -> list[str]:
    """Return the sentences on how controllers are compared."""
    several = len(results.seeds) > 1
    values = f'medians of {len(results.seeds)} seeds' if several else 'of one seed'
    spread = (
        f'by more than the spread over the seeds (paired t test, p < {LEVEL:g})'
        if several
        else 'a single seed has no spread'
    )
    sentences = [
        f'Values are {values}; lower is better.',
        f'best: lower than each other controller by at least {percent(RELEVANT, 1)}'
        f'{" and " if several else "; "}{spread}.',
        'not worse: no other controller is lower by so much.',
    ]
    if any(not run.is_completed for run in results.outcomes):
        sentences.append(
            'A controller that failed with a seed counts as worse than one that completed all.'
        )
    return sentences


def _legend(results: Results) -> list[str]:
    """Return the sentences that explain the tables."""
    sentences = criterion(results)
    sentences[1] = f'* {sentences[1]}'
    late = {run.controller for run in results.outcomes if run.is_real_time}
    if late:
        names = listed([_clipped(name) for name in results.controllers if name in late])
        sentences.append(f'Without simulated time, thus in real time: {names}.')
    return sentences


def _clipped(name: str) -> str:
    """Return *name* with at most NAME characters, both ends of a longer one."""
    plain = printable(name)
    half = (NAME - 1) // 2
    return plain if len(plain) <= NAME else f'{plain[: NAME - 1 - half]}…{plain[-half:]}'


def _filled(text: str) -> str:
    """Return *text* in lines of at most WIDTH characters, all but the first indented.

    Spaces at its start and between its columns are kept.
    """
    return textwrap.fill(
        shown(text), WIDTH, subsequent_indent=INDENT + GAP, break_on_hyphens=False
    )
