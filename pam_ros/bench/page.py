# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``bench.html``: the results of a bench on a page that needs no other files."""

from collections.abc import Mapping
from dataclasses import dataclass

from pam_ros.bench.compare import Comparison, compared, standings
from pam_ros.bench.force_plot import force_plot
from pam_ros.bench.outcome import Results, ScoreAbout
from pam_ros.bench.plots import MUSCLES, OUTAGE, TrialPicture, pictures
from pam_ros.bench.table import NOT_RUN, criterion, scale_in
from pam_ros.bench.trial import Trial
from pam_ros.errors import shown
from pam_ros.identification.wording import ABSENT, listed, name_in_words
from pam_ros.report import style
from pam_ros.report.page import environment_of

Trials = Mapping[tuple[str, str], Trial]


@dataclass(frozen=True)
class Cell:
    """The score of a controller as text: median, and worst over several seeds."""

    median: str
    worst: str
    is_best: bool
    failure: str


@dataclass(frozen=True)
class Row:
    """A score of all controllers in a scenario."""

    score: str
    unit: str
    cells: list[Cell]


@dataclass(frozen=True)
class ScenarioPart:
    """What the page shows of a scenario; *mark* is its id in the page."""

    name: str
    mark: str
    text: str
    score: str
    unit: str
    main: list[Cell]
    rows: list[Row]
    failures: list[str]
    pictures: list[TrialPicture]
    forces: str
    muscles: int
    has_changes: bool
    has_outages: bool


def page(results: Results, programs: Mapping[str, str], trials: Trials) -> str:
    """Return the page as HTML, with its styles and plots; it has no script and loads no files.

    *programs* are how the controllers were started, by name, and *trials* those that are drawn,
    by scenario and controller.
    """
    environment = environment_of('bench', 'report')
    environment.filters['words'] = name_in_words
    return environment.get_template('bench.html.j2').render(
        headline=headline(results),
        lead=_lead(results),
        criterion=criterion(results),
        controllers=results.controllers,
        standings=standings(results),
        real_time={run.controller for run in results.outcomes if run.is_real_time},
        programs=programs,
        scenarios=[_part(results, name, f's{k}', trials) for k, name in enumerate(results.about)],
        scores=results.scores,
        seeds=results.seeds,
        first_seed=min(results.seeds),
        source=results.provenance,
        style=style,
        muscle_colours=MUSCLES,
        outage_colour=OUTAGE,
    )


def headline(results: Results) -> str:
    """Return which controller is best most often, as a heading."""
    count = len(results.about)
    what = f'{count} scenarios' if count > 1 else '1 scenario'
    if len(results.controllers) == 1:
        return f'{results.controllers[0]} in {what}'
    ranked = sorted(standings(results), key=lambda one: -one.best)
    if ranked[0].best == ranked[1].best:
        return f'{len(results.controllers)} controllers in {what}'
    return f'{ranked[0].controller} is best in {ranked[0].best} of {what}'


def _lead(results: Results) -> str:
    runs, seeds = len(results.outcomes), len(results.seeds)
    failed = sum(not run.is_completed for run in results.outcomes)
    each = f'with {seeds} seeds of the sensor noise each' if seeds > 1 else 'with one seed'
    end = f'{failed} of them failed.' if failed else 'All of them were completed.'
    if results.not_run:
        end += f' {len(results.not_run)} more {NOT_RUN}.'
    return f'{listed(list(results.controllers))}: {runs} runs, {each}. {end}'


def _part(results: Results, name: str, mark: str, trials: Trials) -> ScenarioPart:
    about = results.about[name]
    runs = [run for run in results.outcomes if run.scenario == name]
    own = {
        controller: trials[name, controller]
        for controller in results.controllers
        if (name, controller) in trials
    }
    rows = [_row(results, name, score) for score in results.scores]
    (main,) = (row.cells for row in rows if row.score == about.main_score)
    first = next(iter(own.values()), None)
    return ScenarioPart(
        name,
        mark,
        about.text,
        about.main_score,
        scale_in(results.unit(name, about.main_score)).unit,
        main,
        [row for row in rows if any(cell.median != ABSENT for cell in row.cells)],
        [
            shown(f'{run.controller} {run.status.words} (seed {run.seed}): {run.reason}')
            for run in runs
            if not run.is_completed
        ]
        + [
            shown(f'{one.controller} {NOT_RUN} (seed {one.seed}): {one.reason}')
            for one in results.not_run
            if one.scenario == name
        ],
        pictures(mark, own),
        force_plot(mark, own),
        0 if first is None else first.pressure.shape[1],
        first is not None and first.changes.size > 0,
        first is not None and first.outages.size > 0,
    )


def _row(results: Results, scenario: str, score: ScoreAbout) -> Row:
    unit = results.unit(scenario, score.name)
    cells = [_cell(one, results, unit) for one in compared(results, scenario, score.name)]
    return Row(score.name, scale_in(unit).unit, cells)


def _cell(one: Comparison, results: Results, unit: str) -> Cell:
    scale = scale_in(unit)
    failed = [r for r in results.runs(one.scenario, one.controller) if not r.is_completed]
    failure = failed[0].status.words if failed and one.median is None else ''
    return Cell(
        ABSENT if one.median is None else scale.text(one.median),
        scale.text(one.worst) if one.worst is not None and one.seeds > 1 else '',
        one.is_best,
        failure,
    )
