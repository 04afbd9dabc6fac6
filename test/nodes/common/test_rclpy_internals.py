# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the nodes use of rclpy outside its public interface exists, and only in one file."""

import re
import time
from pathlib import Path

import pytest
import rclpy
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64

import pam_ros
from pam_ros.nodes.common.rclpy_internals import (
    EventsExecutor,
    declare_texts,
    messages_of,
    overrides_of,
)

PATIENCE = 30.0  # s
HOME = Path(pam_ros.__file__).parent
# Private names of rclpy's objects, its experimental parts, and the handles of its objects.
PRIVATE = re.compile(
    r'\b(?!self\b|cls\b)\w+\._(?!_)\w+\(|_parameter_overrides|rclpy\.experimental'
    r'|rclpy\.impl|_rclpy|\.handle\b|take_message'
)


@pytest.fixture
def node(domain):
    """Return a node that was started with parameters, of a context of its own."""
    context = Context()
    rclpy.init(
        args=['--ros-args', '-p', 'share:=0.5', '-p', 'names:=[a, b]', '-p', 'none:=[]'],
        context=context,
        domain_id=domain,
    )
    node = Node('internals', context=context)
    yield node
    node.destroy_node()
    rclpy.try_shutdown(context=context)


def test_overrides_are_seen_before_they_are_declared(node):
    found = overrides_of(node)
    assert {name: found[name] for name in ('share', 'names', 'none')} == {
        'share': 0.5,
        'names': ['a', 'b'],
        'none': [],
    }
    assert not node.has_parameter('share')


@pytest.mark.parametrize('texts', [(), ('a',), ('a', 'b')])
def test_an_array_of_strings_is_declared_even_if_it_is_empty(node, texts):
    declare_texts(node, 'texts', texts, ParameterDescriptor(description='some'))
    parameter = node.get_parameter('texts')
    assert parameter.type_ == Parameter.Type.STRING_ARRAY
    assert list(parameter.value) == list(texts)
    descriptor = node.describe_parameter('texts')
    assert (descriptor.description, descriptor.type) == (
        'some',
        Parameter.Type.STRING_ARRAY.value,
    )
    results = node.set_parameters([Parameter('texts', Parameter.Type.STRING_ARRAY, ['c'])])
    assert results[0].successful
    assert list(node.get_parameter('texts').value) == ['c']


def test_messages_are_taken_with_their_numbers_and_stamps(node):
    quality = QoSProfile(depth=10)
    subscription = node.create_subscription(Float64, 'numbers', lambda message: None, quality)
    raw = node.create_subscription(Float64, 'numbers', lambda message: None, quality, raw=True)
    publisher = node.create_publisher(Float64, 'numbers', quality)
    assert [*messages_of(subscription)] == []
    began = time.monotonic()
    while publisher.get_subscription_count() < 2:
        assert time.monotonic() < began + PATIENCE
        time.sleep(0.01)
    sent = time.time_ns()
    for value in (1.0, 2.0, 3.0):
        publisher.publish(Float64(data=value))
    taken, serialized = [], []
    while len(taken) < 3 or len(serialized) < 3:
        assert time.monotonic() < began + PATIENCE
        taken += messages_of(subscription)
        serialized += messages_of(raw)
        time.sleep(0.01)
    assert [message.data for message, _ in taken] == [1.0, 2.0, 3.0]
    assert all(isinstance(message, bytes) for message, _ in serialized)
    for some in (taken, serialized):
        numbers = [info['publication_sequence_number'] for _, info in some]
        assert [n - numbers[0] for n in numbers] == [0, 1, 2]
        for _, info in some:
            assert sent <= info['source_timestamp'] <= info['received_timestamp']
            assert info['received_timestamp'] <= time.time_ns()


def test_the_executor_serves_a_node(node):
    executor = EventsExecutor(context=node.context)
    executor.add_node(node)
    received = []
    node.create_timer(0.01, lambda: received.append(time.monotonic()))
    began = time.monotonic()
    while len(received) < 3:
        assert time.monotonic() < began + PATIENCE
        executor.spin_once(timeout_sec=0.1)
    executor.shutdown()


@pytest.mark.parametrize(
    'path',
    sorted(path for path in (HOME / 'nodes').rglob('*.py')),
    ids=lambda path: str(path.relative_to(HOME)),
)
def test_no_other_file_uses_such_parts(path):
    found = PRIVATE.findall(path.read_text())
    if path.name == 'rclpy_internals.py':
        assert len(found) >= 4
    else:
        assert found == []
