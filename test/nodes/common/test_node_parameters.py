# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Described values as parameters of a real node: what is made of them, and how often."""

import pytest
import rclpy
from rclpy.parameter import Parameter as RosParameter

from pam_ros.errors import ParameterError
from pam_ros.nodes.common.node_parameters import NodeParameters
from pam_ros.parameters import Parameter

pytestmark = [pytest.mark.at_any_pace, pytest.mark.usefixtures('domain')]

TABLE = {
    'mass': (float, 20.0, Parameter('mass', 'kg', 0.0, 100.0, above_low=True)),
    'l0': (float, 0.4, Parameter('length at rest', 'm', 0.0, 10.0)),
}


class Recorder:
    """Makes the sum of the values, and keeps what it was asked for and what was taken."""

    def __init__(self):
        self.built, self.applied = [], []

    def build(self, values):
        self.built.append(dict(values))
        if values['mass'] > 50.0:
            raise ParameterError('too heavy for this rig')
        return values['mass'] + values['l0']


@pytest.fixture
def node():
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node('parameters', context=context)
    yield node
    node.destroy_node()
    rclpy.shutdown(context=context)


def test_a_change_is_built_once_and_a_refused_one_is_not_taken(node):
    recorder = Recorder()
    parameters = NodeParameters(node, TABLE, recorder.build, recorder.applied.append)
    assert (parameters.built, len(recorder.built)) == (20.4, 1)

    def set_to(**values):
        given = [RosParameter(name, value=value) for name, value in values.items()]
        return node.set_parameters_atomically(given)

    assert set_to(mass=10.0).successful
    assert recorder.built[1:] == [{'mass': 10.0, 'l0': 0.4}]
    assert recorder.applied == [10.4]
    refused = set_to(mass=60.0, l0=0.2)
    assert not refused.successful
    assert refused.reason == 'too heavy for this rig'
    assert parameters.values == {'mass': 10.0, 'l0': 0.4}
    # Together with what was refused before, and as a whole number.
    assert set_to(mass=30, l0=0.2).successful
    assert parameters.values == {'mass': 30.0, 'l0': 0.2}
    assert recorder.applied == [10.4, 30.2]
    assert len(recorder.built) == 4


def test_parameters_that_are_set_one_by_one_and_fit_only_together_are_noticed(node):
    recorder = Recorder()
    NodeParameters(node, TABLE, recorder.build, recorder.applied.append)
    given = [RosParameter('l0', value=0.2), RosParameter('mass', value=60.0)]
    taken, refused = node.set_parameters(given)  # as ros2 param load does
    assert (taken.successful, refused.successful) == (True, False)
    assert refused.reason.startswith(
        'too heavy for this rig; of one request l0 took effect and mass did not: '
    )
