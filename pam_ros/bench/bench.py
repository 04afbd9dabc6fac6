# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A bench as its command line describes it: all runs, the table, and the file of the results."""

import argparse
import shlex
import sys
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import fields
from pathlib import Path

from tqdm import tqdm

from pam_ros.bench.changes import changes
from pam_ros.bench.controllers import controllers_of
from pam_ros.bench.kept import keep, kept, key_of
from pam_ros.bench.limits import read_limits, shortfalls
from pam_ros.bench.outcome import NotRun, Outcome, Results, ScenarioAbout, ScoreAbout
from pam_ros.bench.read import read_results
from pam_ros.bench.runs import Finished, Job, Run, jobs_of, run_all
from pam_ros.bench.save import provenance, save_results
from pam_ros.bench.scenario import Scenario
from pam_ros.bench.scores import SCORES
from pam_ros.bench.table import NOT_RUN, line, line_of_not_run, table
from pam_ros.bench.trial import Trial
from pam_ros.errors import PamError, shown
from pam_ros.parallel.journal import Journal
from pam_ros.parallel.tasks import Failure, Pool
from pam_ros.report.write import check_parent
from pam_ros.settings.files import write_whole

FELL_SHORT = 1
RESULTS, PAGE, JOURNAL = 'bench.json', 'bench.html', 'runs.sqlite'


def perform(
    given: argparse.Namespace, scenarios: Sequence[Scenario], seeds: int, run: Run, pool: Pool
) -> int:
    """Run all controllers in *scenarios* with so many *seeds*, and return the exit code.

    *given* are the arguments of the command line, and *run* performs one run, in a process of
    *pool*. Lines are printed as the runs end, then the table, and the results are written to the
    folder. Raises PamError for what is not valid before anything runs. If the bench is ended
    before, the runs that have ended are kept; a KeyboardInterrupt then has a text that says so.
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
    with closing(Journal(given.out / JOURNAL, is_resumed=given.resume)) as journal:
        with journal.telling_what_is_kept(len(jobs)):
            runs = _Runs(jobs, scores)
            runs.perform(run, pool, given.domain, journal)
            results = Results(
                {one.name: ScenarioAbout(one.about, one.score) for one in scenarios},
                tuple(one.name for one in controllers),
                scores,
                runs.outcomes,
                source,
                runs.not_run,
            )
            if not results.outcomes:
                first = results.not_run[0]
                raise PamError(f'no run could be performed; the first of them: {first.reason}')
            print(table(results))
            programs = {one.name: one.about for one in controllers}
            _write(given.out, results, programs, runs.trials)
        if not results.not_run:
            journal.remove()
    if before is not None:
        print(f'\nsince {given.compare}:')
        print('\n'.join(changes(before, results)))
    short = shortfalls(results, limits)
    for sentence in short:
        print(shown(sentence))
    if results.not_run:
        print(f'{len(results.not_run)} of {len(jobs)} runs {NOT_RUN}: --resume repeats these')
    return FELL_SHORT if short or results.not_run else 0


class _Runs:
    """The runs of a bench, and what they gave."""

    def __init__(self, jobs: Sequence[Job], scores: Sequence[ScoreAbout]) -> None:
        self._jobs, self._scores = jobs, scores
        self._found: dict[Job, Outcome | NotRun] = {}
        self.trials: dict[tuple[str, str], Trial] = {}  # by scenario and controller

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes in the order of the jobs."""
        return tuple(one for one in self._ordered if isinstance(one, Outcome))

    @property
    def not_run(self) -> tuple[NotRun, ...]:
        """The runs that could not be performed, in the order of the jobs."""
        return tuple(one for one in self._ordered if isinstance(one, NotRun))

    @property
    def _ordered(self) -> list[Outcome | NotRun]:
        return [self._found[job] for job in self._jobs]

    def perform(self, run: Run, pool: Pool, domain: int | None, journal: Journal) -> None:
        """Perform what is not in the journal, store it there, and print a line for each run."""
        keys = {key_of(job): job for job in self._jobs}
        for job, finished in kept(journal, keys):
            self._take(job, finished)
        if self._found:
            print(f'{len(self._found)} of {len(keys)} runs are taken from {journal.path}')
        rest = {job: key for key, job in keys.items() if job not in self._found}
        is_shown = sys.stderr.isatty()
        with (
            tqdm(total=len(rest), disable=not is_shown, leave=False, unit='run') as bar,
            closing(run_all(list(rest), run, pool, domain)) as ended,
        ):
            for job, found in ended:
                if isinstance(found, Finished):
                    keep(journal, rest[job], found)
                bar.write(self._take(job, found), file=sys.stdout)
                sys.stdout.flush()
                bar.update()

    def _take(self, job: Job, found: Finished | Failure) -> str:
        """Take over what a job gave, and return it as a line."""
        scenario, controller = job.scenario.name, job.controller.name
        if isinstance(found, Failure):
            lacking = NotRun(scenario, controller, job.seed, found.reason)
            self._found[job] = lacking
            return line_of_not_run(lacking)
        self._found[job] = found.outcome
        if found.trial is not None:
            self.trials[scenario, controller] = found.trial
        return line(found.outcome, self._scores, job.scenario.score)


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
