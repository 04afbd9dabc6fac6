# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The warnings on several recordings: one that many of them have appears once."""

from collections.abc import Iterable

from pam_ros.recording.recording import Recording

NAMED = 2  # recordings whose names are listed if more have the same warning
ALL_NAMED = 3  # up to this number all of them are listed


def warning_list(recordings: Iterable[Recording]) -> list[tuple[str, str]]:
    """Return each warning once, as (names of the recordings that have it, the warning).

    They are in the order of the recordings. If many recordings have the same warning, the names
    are those of the first ones and the number of the others.
    """
    names: dict[str, list[str]] = {}
    for recording in recordings:
        for warning in dict.fromkeys(recording.warnings):
            names.setdefault(warning, []).append(recording.name)
    return [(_listed(having), warning) for warning, having in names.items()]


def _listed(names: list[str]) -> str:
    if len(names) <= ALL_NAMED:
        return ', '.join(names)
    return f'{", ".join(names[:NAMED])} and {len(names) - NAMED} more'
