# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A bench as its command line describes it: all runs, the table, and the file of the results."""

import argparse
import shlex
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path

from tqdm import tqdm

from pam_ros.bench.changes import changes
from pam_ros.bench.controllers import controllers_of
from pam_ros.bench.limits import read_limits, shortfalls
from pam_ros.bench.outcome import Outcome, Results, ScenarioAbout, ScoreAbout
from pam_ros.bench.read import read_results
from pam_ros.bench.runs import Finished, Job, Run, jobs_of, run_all
from pam_ros.bench.save import provenance, save_results
from pam_ros.bench.scenario import Scenario
from pam_ros.bench.scores import SCORES
from pam_ros.bench.table import line, table
from pam_ros.bench.trial import Trial
from pam_ros.errors import PamError, shown
from pam_ros.report.write import check_parent
from pam_ros.settings.files import write_whole

FELL_SHORT = 1
RESULTS, PAGE = 'bench.json', 'bench.html'


def perform(given: argparse.Namespace, scenarios: Sequence[Scenario], seeds: int, run: Run) -> int:
    """Run all controllers in *scenarios* with so many *seeds*, and return the exit code.

    *given* are the arguments of the command line, and *run* performs one run. Lines are printed
    as the runs end, then the table, and the results are written to the folder.
    Raises PamError for what is not valid before anything runs.
    """
    controllers = controllers_of(given.controllers)
    scores = tuple(
        ScoreAbout(**{field.name: getattr(one, field.name) for field in fields(ScoreAbout)})
        for one in SCORES
    )
    names = [one.name for one in scenarios]
    before = read_results(given.compare) if given.compare else None
    limits = read_limits(given.limits, names, [one.name for one in SCORES]) if given.limits else {}
    check_parent(given.out / RESULTS)  # before hours of runs
    source = provenance(shlex.join(sys.orig_argv), {one.name: one.file for one in scenarios})
    jobs = jobs_of(scenarios, controllers, seeds)
    trials: dict[tuple[str, str], Trial] = {}
    ended = run_all(jobs, run, min(given.jobs, len(jobs)), given.domain)
    results = Results(
        {one.name: ScenarioAbout(one.about, one.score) for one in scenarios},
        tuple(one.name for one in controllers),
        scores,
        tuple(_outcomes(jobs, scores, ended, trials)),
        source,
    )
    print(table(results))
    programs = {one.name: one.about for one in controllers}
    _write(given.out, results, programs, trials)
    if before is not None:
        print(f'\nsince {given.compare}:')
        print('\n'.join(changes(before, results)))
    short = shortfalls(results, limits)
    for sentence in short:
        print(shown(sentence))
    return FELL_SHORT if short else 0


def _outcomes(
    jobs: Sequence[Job],
    scores: Sequence[ScoreAbout],
    ended: Iterable[Finished],
    trials: dict[tuple[str, str], Trial],
) -> list[Outcome]:
    """Return the outcomes in the order of *jobs*; each is printed when it has *ended*.

    Trials are added to *trials*, by scenario and controller.
    """
    main = {job.scenario.name: job.scenario.score for job in jobs}
    order = {(job.scenario.name, job.controller.name, job.seed): k for k, job in enumerate(jobs)}
    found: list[Outcome] = []
    is_shown = sys.stderr.isatty()
    with tqdm(total=len(jobs), disable=not is_shown, leave=False, unit='run') as bar:
        for outcome, trial in ended:
            found.append(outcome)
            if trial is not None:
                trials[outcome.scenario, outcome.controller] = trial
            bar.write(line(outcome, scores, main[outcome.scenario]), file=sys.stdout)
            sys.stdout.flush()
            bar.update()
    return sorted(found, key=lambda one: order[one.scenario, one.controller, one.seed])


def _write(
    folder: Path,
    results: Results,
    programs: Mapping[str, str],
    trials: Mapping[tuple[str, str], Trial],
) -> None:
    """Write both files; raises PamError if one cannot be written."""
    from pam_ros.bench.page import page  # imports matplotlib, which nothing else needs

    html = page(results, programs, trials)
    save_results(folder / RESULTS, results)
    try:
        write_whole(folder / PAGE, html)
    except OSError as error:
        raise PamError(f'{folder / PAGE} cannot be written: {error.strerror}') from error
    print(f'\nwrote {folder / RESULTS} and {folder / PAGE}')
