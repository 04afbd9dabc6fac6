# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``bench.json``: the outcomes of a bench, described in ``docs/bench.schema.json``."""

from collections.abc import Mapping
from dataclasses import asdict
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from pam_ros.bench.compare import compare, standings
from pam_ros.bench.outcome import Outcome, Provenance, Results
from pam_ros.errors import PamError, printable
from pam_ros.recording.digest import digest_of_files
from pam_ros.report.numbers import to_json
from pam_ros.report.provenance import versions
from pam_ros.settings.files import write_whole

PROGRAM = 'pam_bench'
# The first number increases when a key is removed or changes its meaning, the second when a key
# is added.
SCHEMA_VERSION = '1.1'


def provenance(command: str, files: Mapping[str, Path]) -> Provenance:
    """Return the provenance of a bench that this process performs now.

    *files* are the scenario files by the names of their scenarios. Raises PamError if one cannot
    be read.
    """
    return Provenance(
        printable(command),
        datetime.now(timezone.utc).isoformat(timespec='seconds'),
        versions(),
        {name: digest_of(path) for name, path in files.items()},
    )


def save_results(path: Path, results: Results) -> None:
    """Write *results* as the file *path*, completely or not at all; it replaces a former file.

    Folders that do not exist are made. Raises PamError if *path* is something else than a file,
    or cannot be written.
    """
    try:
        if path.exists() and not path.is_file():
            what = 'is a folder' if path.is_dir() else 'is not a file'
            raise PamError(f'{path} {what}: give the path of a file for the results')
        # Python replaces bytes of names that are not UTF-8 by surrogates; JSON can escape these.
        text = to_json(content(results)).encode('utf-8', 'backslashreplace').decode('utf-8')
        write_whole(path, text)
    except (FileExistsError, NotADirectoryError):
        raise PamError(f'{path} cannot be written: {path.parent} is not a folder') from None
    except OSError as error:
        raise PamError(f'{path} cannot be written: {error.strerror}') from error


def content(results: Results) -> dict[str, Any]:
    """Return the content of ``bench.json``."""
    return {
        'program': PROGRAM,
        'schema_version': SCHEMA_VERSION,
        'controllers': list(results.controllers),
        'scenarios': [{'name': name, **asdict(about)} for name, about in results.about.items()],
        'seeds': results.seeds,
        'scores': [asdict(score) for score in results.scores],
        'outcomes': [outcome_table(outcome) for outcome in results.outcomes],
        'not_run': [asdict(one) for one in results.not_run],
        'comparison': [
            {**asdict(one), 'unit': results.unit(one.scenario, one.score)}
            for one in compare(results)
        ],
        'standings': [asdict(one) for one in standings(results)],
        'provenance': asdict(results.provenance),
    }


def outcome_table(outcome: Outcome) -> dict[str, Any]:
    """Return the table of *outcome* in ``bench.json``."""
    return {**asdict(outcome), 'status': str(outcome.status)}


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file; raises PamError if it cannot be read."""
    try:
        return digest_of_files([path])
    except OSError as error:
        raise PamError(f'{path} cannot be read: {error.strerror}') from error
