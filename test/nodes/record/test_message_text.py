# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The text of message types, against a library that brings its own."""

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from pam_ros.nodes.record.message_text import message_text

STORE = get_typestore(Stores.ROS2_JAZZY)


@pytest.mark.parametrize(
    'kind',
    [
        'std_msgs/msg/Float64',
        'std_msgs/msg/String',
        'sensor_msgs/msg/JointState',
        'sensor_msgs/msg/FluidPressure',
        'geometry_msgs/msg/WrenchStamped',
        'diagnostic_msgs/msg/DiagnosticArray',
        'trajectory_msgs/msg/JointTrajectory',
    ],
)
def test_the_text_makes_the_type(kind):
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(message_text(kind), kind))
    assert store.hash_rihs01(kind) == STORE.hash_rihs01(kind)


def test_a_type_that_is_not_installed_has_no_text():
    assert message_text('lab_msgs/msg/Valve') == ''
