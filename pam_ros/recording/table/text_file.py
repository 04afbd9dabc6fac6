# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The lines of a text file: its encoding, its comments, and the end that may be cut off."""

import codecs
from dataclasses import dataclass
from pathlib import Path

from pam_ros.errors import RecordingError

_COMMENTS = ('#', '%', '//')
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
_SWAPPED_BREAK = '\u0a00'  # a line break whose two bytes are swapped; no character otherwise


@dataclass(frozen=True, eq=False)
class TextLines:
    """The lines of a file with their numbers, without line breaks, and notes on the file.

    ``lines`` have content, and ``comments`` begin with #, % or //, which are left out there.
    ``spaced`` tells whether cells may have white space around them.
    """

    lines: list[tuple[int, str]]
    comments: list[tuple[int, str]]
    notes: list[str]
    spaced: bool


def read_lines(path: Path) -> TextLines:
    """Return the lines of the file at *path*; raises RecordingError if it is not a text file.

    A last line without a line break is left out with a note.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise RecordingError(f'{path} cannot be read: {error.strerror}') from error
    text, notes = _decode(path, data)
    split = text.splitlines()
    numbered = [(number, line) for number, line in enumerate(split, 1) if line.strip()]
    comments = [one for one in numbered if one[1].lstrip().startswith(_COMMENTS)]
    if comments:
        left_out = {number for number, _ in comments}
        numbered = [one for one in numbered if one[0] not in left_out]
    if not numbered:
        raise RecordingError(f'{path.name} is empty')
    last = numbered[-1][0]
    if len(numbered) > 1 and last == len(split) and text.endswith(split[-1]):
        # A number that was cut off may still look valid: 13.4 may have been 13.46.
        notes.append(
            f'the last line ({last}) does not end with a line break: its last number may be cut '
            'off, and the line is left out'
        )
        numbered.pop()
    spaced = not text.isascii() or ' ' in text or '\t' in text
    return TextLines(numbered, comments, notes, spaced)


def _decode(path: Path, data: bytes) -> tuple[str, list[str]]:
    """Return the text of a file and notes; raise RecordingError if it is not a text file."""
    try:
        text = data.decode('utf-16' if data.startswith(_UTF_16) else 'utf-8-sig')
    except UnicodeDecodeError as error:
        if error.encoding == 'utf-8':
            text = data.decode('latin-1')
        else:
            raise RecordingError(
                f'{path.name} begins with the byte order mark of UTF-16, but is not UTF-16 '
                f'({error.reason} at byte {error.start} of {len(data)}): save it as UTF-8'
            ) from None
    notes = []
    filled = text.rstrip('\0')
    if filled and len(filled) < len(text):
        # A logger that loses its power leaves the rest of the last block of its card empty.
        notes.append(f'the file ends with {len(text) - len(filled)} NUL bytes, which are left out')
        text = filled
    if '\0' in text:
        raise RecordingError(f'{path.name} is not a text file: give a CSV file or a rosbag2')
    if _SWAPPED_BREAK in text:
        raise RecordingError(
            f'{path.name} begins with a byte order mark of UTF-16, and has the other byte order: '
            'save it as UTF-8'
        )
    return text, notes
