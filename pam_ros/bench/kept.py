# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of a bench in a journal, so that a bench that was interrupted can go on.

The key of a run changes with all on which its result depends, apart from the programs of users.
"""

import hashlib
import io
import json
from collections.abc import Iterator, Mapping
from dataclasses import fields
from zipfile import BadZipFile

import numpy as np

from pam_ros.bench.read import read_outcome
from pam_ros.bench.runs import Finished, Job
from pam_ros.bench.save import digest_of, outcome_table
from pam_ros.bench.trial import Trial
from pam_ros.parallel.journal import Journal, Row
from pam_ros.parallel.sources import digest_of_sources
from pam_ros.settings.files import find


def key_of(job: Job) -> str:
    """Return the key of a run; raises PamError if a file of it cannot be read."""
    scenario, controller = job.scenario, job.controller
    muscle = scenario.declared.get('muscle')
    files = [scenario.file, *([find(muscle)] if isinstance(muscle, str) else [])]
    files += [controller.file] if controller.file else []
    parts = [
        scenario.name,
        controller.name,
        controller.about,
        job.seed,
        digest_of_sources(),
        *map(digest_of, files),
    ]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def keep(journal: Journal, key: str, run: Finished) -> None:
    """Store a run; raises PamError if it cannot be written."""
    data = None if run.trial is None else _bytes(run.trial)
    journal.add(key, Row(outcome_table(run.outcome), data))


def kept(journal: Journal, jobs: Mapping[str, Job]) -> Iterator[tuple[Job, Finished]]:
    """Yield those of *jobs*, which are given by their keys, whose runs are stored, with these.

    Raises PamError if the file is damaged.
    """
    for key, row in journal.rows(jobs).items():
        with journal.refusing_damage():
            trial = None if row.data is None else _trial(row.data)
            found = Finished(read_outcome(row.content), trial)
        yield jobs[key], found


def _bytes(trial: Trial) -> bytes:
    """Return *trial* as the bytes of a file of numpy."""
    file = io.BytesIO()
    np.savez_compressed(file, **{one.name: getattr(trial, one.name) for one in fields(trial)})
    return file.getvalue()


def _trial(data: bytes) -> Trial:
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as file:
            values = {one.name: file[one.name] for one in fields(Trial)}
    except (BadZipFile, EOFError, KeyError) as error:
        raise ValueError(str(error)) from error
    return Trial(**{**values, 'is_revolute': bool(values['is_revolute'])})
