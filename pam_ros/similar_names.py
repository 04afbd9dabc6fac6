# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Names that are not known: which known ones they probably stand for."""

from collections.abc import Iterable
from difflib import get_close_matches

from pam_ros.errors import ParameterError

ALIKE = 0.8  # similarity from which an unknown name is assumed to be mistyped
NEAR = 0.6  # similarity from which a known name is worth mentioning
SHOWN = 3


def similar(name: str, known: Iterable[str]) -> str:
    """Return the name among *known* that *name* probably stands for, '' if there is none."""
    return next(iter(get_close_matches(name, known, n=1, cutoff=ALIKE)), '')


def near(name: str, known: Iterable[str]) -> list[str]:
    """Return up to three names among *known* that contain *name*, or else that resemble it."""
    names, word = list(known), name.lower()
    containing = [one for one in names if len(word) > 2 and word in one.lower()]
    resembling = get_close_matches(name, names, n=SHOWN, cutoff=NEAR)
    return (containing or resembling)[:SHOWN]


def not_known(what: str, name: str, known: Iterable[str]) -> ParameterError:
    """Return the error that *what*, whose last part is *name*, is none of the *known* names.

    It contains those that are near, or else all of them.
    """
    names = list(known)
    if found := near(name, names):
        return ParameterError(f'{what} is not known: was {" or ".join(found)} meant?')
    return ParameterError(f'{what} is not known: give one of {", ".join(names)}')
