# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Times that are written as dates and clock times, as seconds since the first of them.

Fractions of a second keep their nanoseconds. The order of day and month is that with which the
dates of a recording follow each other most closely: within one day it makes no difference.
"""

import datetime
import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pam_ros.recording.table.number_format import UnreadableCellError

Array = NDArray[np.float64]
Whole = NDArray[np.int64]
BOTH, CLOCK, DATE = 'date and clock time', 'clock time', 'date'
_DATE = r'(\d{4}|\d{1,2})([-/.]|[ ](?=[A-Za-z]|\d{4}))(\d{1,2}|[A-Za-z]{3})\2(\d{4}|\d{1,2})'
_CLOCK = (
    r'(?:(\d{1,2}):)?(\d{1,2}):(\d{2})(?:[.,:](\d{1,9})\d*)?'  # hours, minutes, seconds, fraction
    r'(?:\s*([AaPp])\.?[Mm]\.?)?(?:\s*(Z|UTC|GMT|[+-]\d{2}(?::?\d{2})?))?'
)
_KINDS = {
    kind: re.compile(f'^{pattern}$', re.MULTILINE)
    for kind, pattern in ((BOTH, f'{_DATE}[T ,_]+{_CLOCK}'), (CLOCK, _CLOCK), (DATE, _DATE))
}
_MONTHS = ('jan', 'feb', 'mar', 'apr', 'may', 'jun', 'jul', 'aug', 'sep', 'oct', 'nov', 'dec')
# Where year, month and day are among the three numbers of a date.
_ORDERS = ((0, 1, 2), (2, 1, 0), (2, 0, 1))
_EPOCH = datetime.date(2000, 1, 1)
_MOST_YEARS = 200  # from then on, so that a number of 64 bits has the ns
_SECOND, _DAY = 10**9, 86400 * 10**9  # ns


def kind_of(cell: str) -> str | None:
    """Return whether *cell* is a DATE, a CLOCK time, or BOTH; None if it is neither."""
    return next((kind for kind, one in _KINDS.items() if one.match(cell)), None)


def seconds(column: str, cells: Sequence[str]) -> Array:
    """Return the times *cells* (n,) in s since the first one, NaN for an empty cell.

    All are of the kind of the first one that is not empty. Clock times without a date may pass
    midnight. Raises UnreadableCellError, with the row, for another cell.
    """
    filled = [i for i, cell in enumerate(cells) if cell]
    texts = [cells[i] for i in filled]
    kind = CLOCK if kind_of(texts[0]) == CLOCK else BOTH
    found = _KINDS[kind].findall('\n'.join(texts))
    if len(found) < len(texts):
        wrong = next(i for i, text in enumerate(texts) if not _KINDS[kind].match(text))
        raise UnreadableCellError(filled[wrong], column, texts[wrong], f'a {kind}')
    try:
        clock = _clock([one[-6:] for one in found], kind)
        if kind == CLOCK:
            # Minutes alone, as a spreadsheet shows times with fractions, begin again each hour.
            period = _DAY if found[0][0] else _DAY // 24
            turns = np.diff(clock, prepend=clock[:1]) < -period // 2
            clock = clock + np.cumsum(turns) * period
        else:
            clock = clock + _days([(one[0], one[2], one[3]) for one in found], clock) * _DAY
    except _WrongError as error:
        row, what = error.args
        raise UnreadableCellError(filled[row], column, texts[row], what) from None
    t = np.full(len(cells), np.nan)
    t[filled] = (clock - clock[0]) / _SECOND
    return t


class _WrongError(Exception):
    """The time of a row (the first argument) is not what the second argument says."""


def _clock(times: Sequence[tuple[str, ...]], kind: str) -> Whole:
    """Return clock times in ns, those with an offset in UTC."""
    hours, minutes, whole, fractions, halves, zones = zip(*times, strict=True)
    are_minutes = kind == CLOCK and not hours[0] and bool(fractions[0])
    _require(
        [bool(hour) != are_minutes for hour in hours],
        'a time with hours, minutes and seconds (in a spreadsheet, the format of such cells is '
        'yyyy-mm-dd hh:mm:ss.000)',
    )
    h, m, s = (np.array([int(text or 0) for text in one]) for one in (hours, minutes, whole))
    half = np.array(halves)
    _require((half == '') == (half[0] == ''), 'a time that has, like the first one, AM or PM')
    if halves[0]:
        _require((h >= 1) & (h <= 12), 'a time with AM or PM')
        h = h % 12 + 12 * (np.char.lower(half) == 'p')
    _require((m < 60) & (s <= 60) & ((h < 24) | (kind == CLOCK)), 'a time of a day')
    offsets = {zone: _offset(zone) for zone in set(zones)}
    _require([bool(zone) == bool(zones[0]) for zone in zones], 'a time with an offset, as others')
    ns = np.array([int(text.ljust(9, '0')) if text else 0 for text in fractions])
    away = np.array([offsets[zone] for zone in zones])
    clock: Whole = (h * 3600 + m * 60 + s - away) * _SECOND + ns
    return clock


def _offset(zone: str) -> int:
    """Return the s by which local time is ahead of UTC."""
    digits = zone.lstrip('ZUTCGM+-').replace(':', '')
    size = int(digits[:2] or 0) * 3600 + int(digits[2:] or 0) * 60
    return -size if zone.startswith('-') else size


def _days(dates: Sequence[tuple[str, ...]], clock: Whole) -> Whole:
    """Return the numbers of the days *dates*, whose times *clock* are in ns."""
    numbers = {date: i for i, date in enumerate(dict.fromkeys(dates))}
    of_row = np.array([numbers[date] for date in dates])
    firsts = [int(np.argmax(of_row == i)) for i in range(len(numbers))]
    found: list[tuple[bool, int, Whole]] = []
    wrong = 0
    for order in _ORDERS:
        days = [_day(date, order) for date in numbers]
        if None in days:
            wrong = max(wrong, firsts[days.index(None)])
            continue
        day = np.array(days, dtype=np.int64)[of_row]
        t = day * _DAY + clock
        found.append((bool((np.diff(t) < 0).any()), int(np.ptp(t)), day))
    if not found:
        raise _WrongError(wrong, 'a date in the order of the others')
    return min(found, key=lambda one: one[:2])[2]


def _day(date: tuple[str, ...], order: tuple[int, int, int]) -> int | None:
    """Return the number of the day, None if the *date* is not valid in this *order*."""
    year, month, day = (date[i] for i in order)
    if len(day) > 2 or len(month) == 4 or (len(year) != 4 and 4 in map(len, date)):
        return None
    number = _MONTHS.index(month.lower()) + 1 if month.lower() in _MONTHS else month
    try:
        whole = int(year) if len(year) == 4 else 2000 + int(year)
        one = datetime.date(whole, int(number), int(day))
    except ValueError:
        return None
    return (one - _EPOCH).days if abs(one.year - _EPOCH.year) < _MOST_YEARS else None


def _require(rows: Sequence[bool] | NDArray[np.bool_], what: str) -> None:
    """Raise _WrongError with the first row for which *rows* is false."""
    if not np.all(rows):
        raise _WrongError(int(np.argmin(rows)), what)
