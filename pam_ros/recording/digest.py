# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Which content files have."""

import hashlib
from collections.abc import Iterable
from pathlib import Path


def digest_of_files(files: Iterable[Path]) -> str:
    """Return the SHA-256 of the files' contents, one after the other; raises OSError."""
    digest = hashlib.sha256()
    for file in files:
        with file.open('rb') as stream:
            for block in iter(lambda: stream.read(1 << 20), b''):
                digest.update(block)
    return digest.hexdigest()
