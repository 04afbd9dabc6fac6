# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The identification of all rigs of a command line: reports, the table, and what is kept."""

import argparse
import sys
from collections.abc import Sequence
from contextlib import closing
from dataclasses import asdict
from datetime import datetime, timezone
from pathlib import Path

from tqdm import tqdm

from pam_ros.batch.rigs import Rig, key_of, rigs_of
from pam_ros.batch.row import RigRow, failed_row, line, row_from
from pam_ros.batch.table import csv_text, page, summary
from pam_ros.batch.task import RigTask, identify_rig
from pam_ros.errors import PamError, printable, shown
from pam_ros.parallel.journal import Journal, Row
from pam_ros.parallel.tasks import Failure, Pool, run_tasks
from pam_ros.report.write import check_folder, check_parent
from pam_ros.settings.files import write_whole

TABLE, PAGE, JOURNAL = 'rigs.csv', 'index.html', 'rigs.sqlite'
NOT_ALL = 1  # exit code


def identify_each(given: argparse.Namespace, command: str, pool: Pool) -> int:
    """Identify each rig of the command line *given* in *pool*, and return the exit code.

    A line is printed as each of them ends. The folder contains a report for each rig, and the
    table of all. Raises PamError before any work if a report could not be written. If the work is
    ended before, what has ended is kept; a KeyboardInterrupt then has a text that says so.
    """
    rigs = rigs_of(given.recordings, given.values[0])
    out = given.out.resolve()
    check_parent(out / TABLE)
    for rig in rigs:
        check_folder(out / rig.name)
    with closing(Journal(out / JOURNAL, is_resumed=given.resume)) as journal:
        with journal.telling_what_is_kept(len(rigs)):
            rows = _rows(rigs, given, command, pool, journal)
            date = datetime.now(timezone.utc).isoformat(timespec='seconds')
            _write(out / TABLE, csv_text(rows))
            _write(out / PAGE, page(rows, printable(command), date))
        lacking = sum(not row.is_identified for row in rows)
        if not lacking:
            journal.remove()
    print('\n'.join(['', *summary(rows), f'see {given.out / PAGE}']))
    if lacking:
        print(f'{lacking} of {len(rigs)} could not be identified: --resume repeats these')
    return NOT_ALL if lacking else 0


def _rows(
    rigs: Sequence[Rig],
    given: argparse.Namespace,
    command: str,
    pool: Pool,
    journal: Journal,
) -> list[RigRow]:
    """Return the rows of *rigs*, in their order; those that are in the journal are taken."""
    keys = {key_of(rig, given): rig for rig in rigs}
    out = given.out.resolve()
    found: dict[str, RigRow] = {}
    for key, row in journal.rows(keys).items():
        if (out / keys[key].name).is_dir():
            with journal.refusing_damage():
                found[key] = row_from(row.content)
    if found:
        print(f'{len(found)} of {len(rigs)} rigs are taken from {journal.path}')
    rest = [key for key in keys if key not in found]
    options = _options(given)
    tasks = [RigTask(keys[key], options, out / keys[key].name, command) for key in rest]
    with (
        tqdm(total=len(rest), disable=not sys.stderr.isatty(), leave=False, unit='rig') as bar,
        closing(run_tasks(identify_rig, tasks, pool)) as results,
    ):
        for number, result in results:
            key, rig = rest[number], keys[rest[number]]
            if isinstance(result, Failure):
                found[key] = failed_row(rig.name, rig.path, result.reason)
            else:
                found[key] = result
                journal.add(key, Row(asdict(result)))
            bar.write(shown(line(found[key])), file=sys.stdout)
            sys.stdout.flush()
            bar.update()
    return [found[key] for key in keys]


def _options(given: argparse.Namespace) -> argparse.Namespace:
    """Return the options for processes, whose folder may be another one: paths are absolute."""
    options = argparse.Namespace(**vars(given))
    if given.params and Path(given.params).is_file():
        options.params = str(Path(given.params).resolve())
    if given.mapping:
        options.mapping = given.mapping.resolve()
    return options


def _write(path: Path, text: str) -> None:
    try:
        write_whole(path, text)
    except OSError as error:
        raise PamError(f'{path} cannot be written: {error.strerror}') from error
