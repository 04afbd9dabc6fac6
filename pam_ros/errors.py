# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The errors that a user sees: one base class, with the whole message as the text."""

import re
from contextlib import suppress

LONGEST_WORD = 200  # characters of a word that is shown whole: a path may be this long
LONGEST_TEXT = 2000
_CUT = ' [...] '


def printable(text: str) -> str:
    """Return the whole *text* in one line; what cannot be printed or encoded is escaped.

    In file names that are not UTF-8, or not ASCII in the locale C, Python replaces each such byte
    by a surrogate. Bytes that are valid UTF-8 are decoded to their characters.
    """
    with suppress(UnicodeEncodeError):  # surrogates that do not represent a byte
        text = text.encode('utf-8', 'surrogateescape').decode('utf-8', 'surrogateescape')
    return ''.join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def shown(text: str) -> str:
    """Return *text* in a form for a log or a terminal: one line, printable, not too long.

    Names in files can contain line breaks, escape sequences and a million characters.
    """
    plain = re.sub(
        rf'\S{{{LONGEST_WORD + 1},}}',
        lambda word: f'{word[0][:150]}...{word[0][-40:]}',
        printable(text),
    )
    if len(plain) > LONGEST_TEXT:
        plain = plain[: LONGEST_TEXT - 500] + _CUT + plain[-400:]
    return plain


class PamError(Exception):
    """An invalid input of the user; the text is the message to show, the exit code 2."""

    def __init__(self, sentence: str) -> None:
        super().__init__(shown(sentence))


class ParameterError(PamError):
    """A parameter that is not valid, or a combination of parameters that is not."""


class RangeError(PamError):
    """A desired force, position or pressure that the model cannot reach."""


class RecordingError(PamError):
    """A recording that cannot be used as it is."""
