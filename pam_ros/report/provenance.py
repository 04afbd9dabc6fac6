# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The origin of a report: files with their digests, the nominal model, and versions."""

import platform
import shlex
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from importlib import metadata
from typing import Any

from pam_ros.errors import printable
from pam_ros.identification.identification import Identification
from pam_ros.recording.digest import digest_of_files
from pam_ros.recording.recording import Recording
from pam_ros.settings.files import find
from pam_ros.settings.inputs import Inputs
from pam_ros.settings.nominal import NominalJoint, nominal_of
from pam_ros.version import __version__

LIBRARIES = ('numpy', 'scipy', 'numba')


@dataclass(frozen=True, eq=False)
class Provenance:
    """The inputs of an identification.

    ``command`` is the command line. ``parameters`` is the file or preset as it was named, with its
    SHA-256 ``digest``, empty if there is no file, and the ``overrides``. ``configuration`` has
    the resulting flat values of the ``nominal`` joint. ``date`` is in UTC, ISO 8601.
    ``recordings`` were fitted, ``test`` was not.
    """

    command: str
    parameters: str
    digest: str
    overrides: tuple[str, ...]
    configuration: Mapping[str, Any]
    recordings: tuple[Recording, ...]
    test: tuple[Recording, ...]
    date: str
    versions: Mapping[str, str]
    nominal: NominalJoint


def provenance(inputs: Inputs, overrides: Sequence[str], command: str) -> Provenance:
    """Return the provenance of an identification that this process performs now."""
    return Provenance(
        printable(command),
        printable(inputs.params),
        digest_of_files([find(inputs.params)]),
        tuple(map(printable, overrides)),
        inputs.nominal.flat(),
        tuple(inputs.recordings),
        tuple(inputs.test),
        datetime.now(timezone.utc).isoformat(timespec='seconds'),
        versions(),
        inputs.nominal,
    )


def provenance_of_program(result: Identification) -> Provenance:
    """Return the provenance of an identification whose nominal joint a program created."""
    nominal = nominal_of(result.stages[0].model, result.recordings[0].muscles)
    return Provenance(
        printable(shlex.join(sys.orig_argv)),
        'a Python program',
        '',
        (),
        nominal.flat(),
        result.recordings,
        result.test_recordings,
        datetime.now(timezone.utc).isoformat(timespec='seconds'),
        versions(),
        nominal,
    )


def versions() -> dict[str, str]:
    """Return the versions of this package, of Python and of the numerical libraries."""
    found = {'pam_ros': __version__, 'python': platform.python_version()}
    for library in LIBRARIES:
        try:
            found[library] = metadata.version(library)
        except metadata.PackageNotFoundError:
            found[library] = 'absent'
    return found
