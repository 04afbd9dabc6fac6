# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The errors that a user sees: one family, each carrying the whole sentence."""

import re
from contextlib import suppress

LONGEST_WORD = 200  # characters that a terminal gets: a path may have as many
LONGEST = 2000
_CUT = ' [...] '


def printable(text: str) -> str:
    """Return *text* whole in one line, with escapes for what cannot be printed or encoded.

    Names of files that are not UTF-8, and in the locale C all that are not ASCII, come from the
    system with a surrogate for each byte. Where these bytes are UTF-8, they are its letters.
    """
    with suppress(UnicodeEncodeError):  # surrogates that stand for no byte
        text = text.encode('utf-8', 'surrogateescape').decode('utf-8', 'surrogateescape')
    return ''.join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def shown(text: str) -> str:
    """Return *text* as a log or a terminal may have it: one line, printable, not too long.

    Names in files can hold line breaks, escape sequences and a million letters.
    """
    plain = re.sub(
        rf'\S{{{LONGEST_WORD + 1},}}',
        lambda word: f'{word[0][:150]}...{word[0][-40:]}',
        printable(text),
    )
    if len(plain) > LONGEST:
        plain = plain[: LONGEST - 500] + _CUT + plain[-400:]
    return plain


class PamError(Exception):
    """A mistake in what the user gave; the text is the sentence to show, exit code 2."""

    def __init__(self, sentence: str) -> None:
        super().__init__(shown(sentence))


class ParameterError(PamError):
    """A parameter or a set of parameters that makes no model."""


class RangeError(PamError):
    """A wanted force, position or pressure that the model cannot reach."""


class RecordingError(PamError):
    """A recording that cannot be used as it is."""
