# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Trajectories read from bytes, against the library that serialises them message by message."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pam_ros.control.reference.points import Point, Points
from pam_ros.control.reference.serialised import MOST_POINTS, read_trajectory
from pam_ros.errors import RangeError
from support.bags import STORE, TYPES

KIND = 'trajectory_msgs/msg/JointTrajectory'
FLOATS = st.floats(allow_nan=False)
BEHIND = 1_000_000  # m: positions of the other joints


def point(nanoseconds, *values):
    """Return a point of the message; *values* are lists: positions, velocities and so on."""
    time = TYPES['builtin_interfaces/msg/Duration'](*divmod(nanoseconds, 10**9))
    lists = [np.array(one, dtype=float) for one in (*values, *[()] * (4 - len(values)))]
    return TYPES['trajectory_msgs/msg/JointTrajectoryPoint'](*lists, time)


def serialised(points, names=('pam',), stamp=0, frame='', **more):
    time = TYPES['builtin_interfaces/msg/Time'](*divmod(stamp, 10**9))
    header = TYPES['std_msgs/msg/Header'](time, frame)
    message = TYPES[KIND](header, list(names), points)
    return bytes(STORE.serialize_cdr(message, KIND, **more))


@given(
    rows=st.lists(
        st.tuples(st.integers(-(10**9), 2**31 * 10**9 - 1), *[FLOATS] * 4, *[st.booleans()] * 3),
        max_size=8,
    ),
    is_alike=st.booleans(),
    names=st.permutations(['pam', 'elbow', 'π']).flatmap(
        lambda names: st.integers(names.index('pam') + 1, 3).map(lambda n: names[:n])
    ),
    frame=st.text('abcdefgh_/', max_size=9),
    stamp=st.integers(0, 2**31 * 10**9 - 1),
    little=st.booleans(),
)
def test_all_points_are_read_whatever_they_have(rows, is_alike, names, frame, stamp, little):
    i = names.index('pam')

    def values(x, is_there=True):
        return [x if k == i else BEHIND for k in range(len(names))] if is_there else []

    points, expected = [], []
    for time, y, v, a, effort, *there in rows:
        has_v, has_a, has_effort = rows[0][5:] if is_alike else there
        lists = values(y), values(v, has_v), values(a, has_a), values(effort, has_effort)
        points.append(point(time, *lists))
        seconds, rest = divmod(time, 10**9)
        expected.append(Point(seconds + rest / 1e9, y, v if has_v else None, a if has_a else None))
    data = serialised(points, names, stamp, frame, little_endian=little)
    found = read_trajectory(data, 'pam')
    assert found.begin == stamp
    for name, column in vars(Points.of(expected)).items():
        np.testing.assert_array_equal(vars(found.points)[name], column)


def test_what_is_behind_the_last_point_is_not_read():
    data = serialised([point(10**9, [0.05]), point(2 * 10**9, [0.06])])
    found = read_trajectory(data + bytes(40), 'pam').points
    assert found.positions.tolist() == [0.05, 0.06]


def test_without_points_no_joint_need_be_named():
    assert read_trajectory(serialised([], ()), 'pam').points.count == 0


MANY = [point(k, [0.05], [0.0]) for k in range(5)]


@pytest.mark.parametrize('points', [MANY[:1], MANY[:2], MANY, [*MANY[:3], point(9, [1.0])]])
def test_a_message_that_is_cut_off_is_refused(points):
    data = serialised(points, frame='rig')
    for size in range(4, len(data)):
        with pytest.raises(RangeError, match='cut off'):
            read_trajectory(data[:size], 'pam')


@pytest.mark.parametrize(
    ('data', 'words'),
    [
        (
            serialised(MANY, ('elbow', 'knee')),
            'is not for joint pam (joint_name), but elbow, knee',
        ),
        (serialised(MANY, ()), 'no joint at all'),
        (serialised([*MANY, point(9)]), 'point 5 of the trajectory has 0 positions for 1 joints'),
        (serialised([point(1, [1.0], [1.0, 2.0])]), 'point 0 of the trajectory has 2 velocities'),
        (serialised([MANY[0], point(1, [1.0], (), [1.0, 2.0])]), 'has 2 accelerations for 1'),
        (b'\0\7\0\0' + bytes(40), 'an encoding that is not known: 0007'),
        (b'', 'an encoding that is not known'),
        (serialised([MANY[0]] * (MOST_POINTS + 1)), 'has 100001 points: at most 100000 are taken'),
        (b'\0\1\0\0' + b'\xff' * 40, 'cut off'),
    ],
)
def test_what_cannot_be_used_is_refused_with_a_sentence(data, words):
    with pytest.raises(RangeError) as caught:
        read_trajectory(data, 'pam')
    assert words in str(caught.value)
