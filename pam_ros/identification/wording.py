# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers and names as texts for readers: few digits, convenient units, true minus signs."""

import math
from collections.abc import Callable
from dataclasses import dataclass

_SUPERSCRIPT = str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹')
ABSENT = '–'
SHORTEST = 5.0  # s that are shown as the lower end of a time
# Times up to so many s are shown in units of so many s, with this name.
TIMES = ((60.0, 1.0, 's'), (7200.0, 60.0, 'min'), (math.inf, 3600.0, 'h'))


@dataclass(frozen=True)
class Scale:
    """A unit for display: a value in SI times ``factor`` is in ``unit``."""

    factor: float
    unit: str

    def text(self, value: float, digits: int = 3) -> str:
        """Return an SI value in this unit, without the unit."""
        return number(value * self.factor, digits)


def scale_for(unit: str, size: float) -> Scale:
    """Return a convenient unit for values in SI *unit* of about *size*: mm, mrad, kPa."""
    if unit == 'm':
        return Scale(1e6, 'µm') if 0.0 < size < 1e-5 else Scale(1e3, 'mm')
    if unit == 'rad':
        return Scale(1e3, 'mrad')
    if unit == 'Pa':
        return Scale(1e-3, 'kPa') if size >= 1e3 else Scale(1.0, 'Pa')
    return Scale(1.0, unit)


def number(value: float | None, digits: int = 3) -> str:
    """Return *value* with that many significant digits; a dash if there is no value."""
    if value is None or math.isnan(value):
        return ABSENT
    if math.isinf(value):
        return '∞' if value > 0 else '−∞'
    if value == 0.0:
        return '0'
    exponent = math.floor(math.log10(abs(float(f'{value:.{digits - 1}e}'))))
    if -4 < exponent < max(digits, 5):
        return f'{value:.{max(digits - 1 - exponent, 0)}f}'.replace('-', '−')
    mantissa, power = f'{value:.{digits - 1}e}'.split('e')
    if '.' in mantissa:
        mantissa = mantissa.rstrip('0').rstrip('.')
    return f'{mantissa}·10{str(int(power)).translate(_SUPERSCRIPT)}'.replace('-', '−')


def interval(low: float, high: float, digits: int = 3) -> str:
    """Return an interval, both ends with enough digits to distinguish them."""
    width = abs(high - low)
    largest = max(abs(low), abs(high))
    if 0.0 < width < largest < math.inf:
        digits = min(max(digits, 1 + math.ceil(math.log10(largest / width))), 7)
    return f'{number(low, digits)} to {number(high, digits)}'


def time_span(low: float, high: float) -> str:
    """Return a time from *low* to *high* s in few digits: "1 to 4 min", "10 s to 2 min"."""
    if high <= 60.0:
        return 'less than a minute'
    last, unit = _time(high, math.ceil)
    first, smaller = _time(low, math.floor)
    if low < SHORTEST:
        return f'up to {last} {unit}'
    if smaller != unit:
        return f'{first} {smaller} to {last} {unit}'
    return f'about {last} {unit}' if first >= last else f'{first} to {last} {unit}'


def _time(seconds: float, whole: Callable[[float], int]) -> tuple[int, str]:
    """Return a time in s, min or h, rounded to a multiple of 5 if it is above 10, and its unit."""
    size, unit = next((size, unit) for most, size, unit in TIMES if seconds < most)
    value = seconds / size
    return whole(5.0 * round(value / 5.0) if value > 10.0 else round(value, 1)), unit


def probability(p: float) -> str:
    """Return a p value as text; all below 0.0001 give the same text."""
    return '< 0.0001' if p < 1e-4 else number(p, 2)


def percent(share: float, digits: int = 2) -> str:
    """Return a share in percent, with the percent sign."""
    if math.isnan(share):
        return ABSENT
    text = number(100.0 * share, digits)
    return f'{text} %'


def name_in_words(name: str) -> str:
    """Return a name as it is shown to a reader: ``pressure_lag`` as "pressure lag".

    The name of an effect in one of several muscles is "pressure lag of agonist".
    """
    muscle, _, rest = name.rpartition('.')
    words = rest.replace('_', ' ')
    return f'{words} of {muscle}' if muscle else words


def spoken(text: str, names: list[str]) -> str:
    """Return *text* with each of *names* in it replaced by :func:`name_in_words`."""
    for name in names:
        text = text.replace(name, name_in_words(name))
    return text


def listed(names: list[str]) -> str:
    """Return names as a sentence lists them: "a, b and c"."""
    if len(names) < 2:
        return ''.join(names)
    return ', '.join(names[:-1]) + ' and ' + names[-1]
