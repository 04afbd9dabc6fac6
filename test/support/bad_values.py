# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Values that users give by mistake, for parameters as they are configured, and what fits them."""

import math
from array import array

from hypothesis import strategies as st

# What YAML takes for something else than it looks like, or what looks like a number to a reader.
YAML_TRAPS = (
    *('yes', 'no', 'on', 'off', 'True', 'null', '~', '', ' ', '1_000', '0x1F', '0o17', '1:30'),
    *('1e3', '1.e+5', '.5', '-.inf', '.nan', '.NaN', '2026-11-22', '1,5', '5 %', '"', "'", '{}'),
    *(
        '[]',
        '[1, 2]',
        '{a: 1}',
        '!!int 3',
        '&a 1',
        '*a',
        '- 1',
        'a: b',
        '# 1',
        '|',
        '>',
        '%',
        '\t',
    ),
)
TEXTS = (
    *YAML_TRAPS,
    'ä',
    '\u202e',
    '\0',
    'x' * 10_000,
    '\x1b[2J',
    '٣',
    '½',
    'load',
    'pid',
    '/',
    '..',
)
NUMBERS = (
    *(math.nan, math.inf, -math.inf, -0.0, 5e-324, 1e-300, 1e300, -1e300, 1.7976931348623157e308),
    *(0, 1, -1, 2**31, 2**63 - 1, -(2**63), 10**400, True, False),
)
LISTS = ((), ('a',), ('a', 'a'), ('a', 'b', 'c'), ('',), [1, 2], [1.0], [True], [b'\1'])
OTHERS = (None, b'', array('d', [1.0]), array('q'), {'a': 1})
ANY = st.sampled_from((*TEXTS, *NUMBERS, *OTHERS)) | st.sampled_from(LISTS)


def values(kind, about):
    """Return the strategy of values for a parameter: many near its bounds, many of any type."""
    near = [
        beside
        for bound in (about.low, about.high)
        if bound is not None
        for beside in (bound, math.nextafter(bound, -math.inf), math.nextafter(bound, math.inf))
    ]
    inside = list(about.choices)
    if kind is float:
        low = -1e6 if about.low is None else about.low
        high = 1e6 if about.high is None else about.high
        return ANY | st.floats(low, high) | st.sampled_from([*near, 0.0])
    if kind is int:
        near += [math.floor(bound) for bound in near]
    return ANY | st.sampled_from([*near, *inside, True, False, 'a', 1.5])


def fits(value, kind, about):
    """Say whether a parameter that is configured as *about* may have this value."""
    if kind is bool:
        return isinstance(value, bool)
    if kind is str:
        return isinstance(value, str) and (not about.choices or value in about.choices)
    if kind is tuple:
        return isinstance(value, tuple) and all(isinstance(one, str) for one in value)
    if isinstance(value, bool) or not isinstance(value, kind) or not math.isfinite(value):
        return False
    is_low = about.low is not None and (
        value <= about.low if about.above_low else value < about.low
    )
    return not is_low and (about.high is None or value <= about.high)
