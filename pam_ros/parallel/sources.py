# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which version of this package a process runs, down to each line of it."""

import hashlib
from functools import lru_cache
from pathlib import Path

DIGITS = 12


@lru_cache(maxsize=1)
def digest_of_sources() -> str:
    """Return a digest of all Python files of this package, as they are at the first call."""
    folder = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for path in sorted(folder.rglob('*.py')):
        digest.update(path.relative_to(folder).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:DIGITS]
