# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The rigs of a command line, each with a name, and what the result of each depends on."""

import argparse
import hashlib
import json
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pam_ros.errors import PamError
from pam_ros.parallel.sources import digest_of_sources
from pam_ros.recording.digest import digest_of_files
from pam_ros.settings.files import find
from pam_ros.settings.recording_list import RecordingFile, recording_files

# Options of the command line on which the result of a rig depends.
OPTIONS = (
    *('set', 'uncertain', 'column', 'columns', 'sheet', 'variable', 'kind', 'namespace'),
    'time',
)


@dataclass(frozen=True)
class Rig:
    """A recording or a list of recordings, at an absolute *path*, under a *name*.

    ``values`` are the numbers of ``--set`` that are its own.
    """

    name: str
    path: str
    values: Mapping[str, str]


def rigs_of(paths: Sequence[str], values: Sequence[Mapping[str, str]]) -> list[Rig]:
    """Return the rigs with these *paths*; the names are those of the files, as far as needed.

    Raises PamError if a path is given twice.
    """
    whole = [Path(path).resolve() for path in paths]
    twice = [path for path, count in Counter(whole).items() if count > 1]
    if twice:
        raise PamError(f'{twice[0]} is given twice')
    names = [path.stem for path in whole]
    if len(set(names)) < len(names):
        # Files of one name in several folders, or with several suffixes.
        top = os.path.commonpath(whole)
        names = ['_'.join(path.relative_to(top).parts) for path in whole]
    return [
        Rig(name, str(path), own) for name, path, own in zip(names, whole, values, strict=True)
    ]


def key_of(rig: Rig, given: argparse.Namespace) -> str:
    """Return a key that changes with all on which the result of *rig* depends."""
    files, params = [RecordingFile(Path(rig.path))], None
    try:
        files, params = recording_files(Path(rig.path))
        muscle = [find(params or given.params or '')]
    except PamError:  # its result will be the same error
        muscle = []
    paths = [Path(rig.path), *(file.path for file in files), *muscle]
    paths += [given.mapping] if given.mapping else []
    parts: list[Any] = [rig.name, dict(rig.values), params or given.params]
    parts += [getattr(given, option) for option in OPTIONS]
    parts += [digest_of_sources(), *map(_digest, paths)]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def _digest(path: Path) -> str:
    """Return the SHA-256 of a file, or of all files in a folder; of nothing if it is absent."""
    files = sorted(path.rglob('*')) if path.is_dir() else [path]
    return digest_of_files(file for file in files if file.is_file())
