# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values of ``--set`` that apply to the files behind them: ``--set mass=10 a --set mass=20 b``."""

import argparse
from collections.abc import Callable, Sequence

from pam_ros.errors import PamError, shown

OPTION = '--set'
SHORTEST = len('--se')  # argparse allows shorter forms of an option that no other option has

Files = tuple[int, int]  # numbers of recordings and of test recordings


def values_of_files(
    arguments: Sequence[str], parser: Callable[..., argparse.ArgumentParser]
) -> tuple[list[dict[str, str]], list[dict[str, str]]]:
    """Return the values that belong to each recording, and to each test recording, by name.

    *arguments* are those of a valid command line; parser(is_part=True) returns the parser of the
    first few of them. A name that is set once, or without a file between its values, applies to
    all: it is left out. Any other value applies to the files from there to the next one.

    Raises PamError for a file before the first value of a name that files have.
    """
    count = _files_in(arguments, parser)
    stated: dict[str, list[tuple[Files, str]]] = {}
    for k, text in _options(arguments):
        name, _, value = (part.strip() for part in text.partition('='))
        stated.setdefault(name, []).append((_files_in(arguments[:k], parser), value))
    found: list[list[dict[str, str]]] = [[{} for _ in range(n)] for n in count]
    for name, values in stated.items():
        if len({before for before, _ in values}) == 1:
            continue
        first, value = values[0]
        if first != (0, 0):
            raise PamError(
                f'{OPTION} {shown(name)}={shown(value)} stands behind a file, and {shown(name)} '
                'is set again: give each value before the files to which it applies'
            )
        for before, value in values:
            for files, begin in zip(found, before, strict=True):
                for one in files[begin:]:
                    one[name] = value
    return found[0], found[1]


def _options(arguments: Sequence[str]) -> list[tuple[int, str]]:
    """Return the place of each ``--set`` among the *arguments*, and its value."""
    found = []
    for k, argument in enumerate(arguments):
        head, equals, value = argument.partition('=')
        if len(head) < SHORTEST or not OPTION.startswith(head):
            continue
        found.append((k, value if equals else arguments[k + 1]))
    return found


def _files_in(
    arguments: Sequence[str], parser: Callable[..., argparse.ArgumentParser]
) -> tuple[int, int]:
    """Return how many recordings and test recordings are among the first *arguments*."""
    given = parser(is_part=True).parse_intermixed_args(arguments)
    return len(given.recordings), len(given.test)
