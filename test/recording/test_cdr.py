# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of many messages at once, against the library that decodes them one by one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pam_ros.recording.cdr import read_alike
from support import bags

FLOATS = st.floats(allow_nan=False)
STAMPS = st.integers(0, 2**31 * 10**9 - 1)


def serialised(kind, messages):
    return [bytes(bags.STORE.serialize_cdr(message, kind)) for message in messages]


@given(st.lists(FLOATS, min_size=1, max_size=20))
def test_floats(values):
    data = serialised(bags.FLOAT, [bags.number(value) for value in values])
    found = read_alike(bags.FLOAT, ['data'], data)
    assert found.stamps is None
    np.testing.assert_array_equal(found.columns['data'], values)


@settings(deadline=None)
@given(
    rows=st.lists(st.tuples(STAMPS, FLOATS, FLOATS, FLOATS), min_size=1, max_size=10),
    frame=st.text('abcdefgh_/', max_size=9),
    names=st.lists(st.text('abcd', max_size=5), max_size=2),
    filled=st.tuples(st.booleans(), st.booleans(), st.booleans()),
)
def test_joint_states_of_one_joint(rows, frame, names, filled):
    messages = []
    for stamp, *values in rows:
        lists = [[x] if fill else [] for x, fill in zip(values, filled, strict=True)]
        message = bags.joint(stamp, *lists, names=names)
        message.header.frame_id = frame
        messages.append(message)
    fields = ['position', 'velocity', 'effort']
    found = read_alike(bags.JOINT, fields, serialised(bags.JOINT, messages))
    assert found.stamps.tolist() == [row[0] for row in rows]
    for k, field in enumerate(fields):
        expected = [row[k + 1] if filled[k] else np.nan for row in rows]
        np.testing.assert_array_equal(found.columns[field], expected)


@given(
    rows=st.lists(st.tuples(STAMPS, FLOATS, FLOATS), min_size=1, max_size=10),
    frame=st.text('abcdefgh', max_size=9),
)
def test_fluid_pressures(rows, frame):
    messages = []
    for stamp, pressure, variance in rows:
        message = bags.fluid(stamp, pressure)
        message.variance, message.header.frame_id = variance, frame
        messages.append(message)
    found = read_alike(bags.FLUID, ['fluid_pressure'], serialised(bags.FLUID, messages))
    assert found.stamps.tolist() == [row[0] for row in rows]
    np.testing.assert_array_equal(found.columns['fluid_pressure'], [row[1] for row in rows])


def cut(kind, message, count):
    return serialised(kind, [message])[0][:-count]


def big_endian():
    message = bags.number(1.0)
    return [bytes(bags.STORE.serialize_cdr(message, bags.FLOAT, little_endian=False))]


@pytest.mark.parametrize(
    ('kind', 'field', 'data'),
    [
        (bags.FLOAT, 'data', []),
        (bags.FLOAT, 'data', big_endian()),
        (bags.FLOAT, 'level', serialised(bags.FLOAT, [bags.number(1.0)])),
        (bags.WRENCH, 'wrench.force.z', serialised(bags.WRENCH, [bags.wrench(1, 2.0)])),
        (bags.JOINT, 'position', serialised(bags.JOINT, [bags.joint(1, [1, 2])])),
        (bags.JOINT, 'position[0]', serialised(bags.JOINT, [bags.joint(1, [1])])),
        (
            bags.JOINT,
            'position',
            serialised(bags.JOINT, [bags.joint(1, [1], names=[name]) for name in ('a', 'b')]),
        ),
        (
            bags.JOINT,
            'position',
            serialised(bags.JOINT, [bags.joint(1, [1]), bags.joint(1, [1], [2])]),
        ),
        (
            bags.JOINT,
            'position',
            serialised(bags.JOINT, [bags.joint(1, [1], [2]), bags.joint(1, [1], [], [2])]),
        ),
        (bags.JOINT, 'position', [b'\0\1\0\0' + bytes(10)]),
        (bags.JOINT, 'position', [b'\0\1\0\0' + b'\xff' * 40]),
        (bags.FLOAT, 'data', [b'\0\1\0\0']),
        (bags.FLOAT, 'data', [cut(bags.FLOAT, bags.number(1.0), 3)]),
        (bags.FLUID, 'fluid_pressure', [cut(bags.FLUID, bags.fluid(1, 2.0), 3)]),
        (bags.JOINT, 'position', [cut(bags.JOINT, bags.joint(1, [1], [2], [3]), 3)]),
    ],
)
def test_what_must_be_decoded_singly(kind, field, data):
    assert read_alike(kind, [field], data) is None
